"""Plane mirrors of a scene: its planes of symmetry, and walls that are one."""

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from psph.case import Case, CaseError
from psph.case.keys import AXES
from psph.case.motion import motion_of
from psph.case.shapes import Shape
from psph.composition.reflections import ABOVE, BELOW, Plane
from psph.physics.motion import is_rigid, moments
from psph.physics.walls.conditions import MIRROR
from psph.scene.forms.joined import Less
from psph.scene.forms.make import form_of
from psph.scene.forms.plain import Boxed
from psph.scene.forms.shell import Coat
from psph.scene.lattice import TOLERANCE
from psph.scene.shapes import Corner

LOOKS = 50
"""Moments at which it is looked where a mirror goes."""


def planes_of(case: Case, parts: Iterable[Any]) -> tuple[Plane, ...]:
    """The mirrors of a case of these ``parts``: those of its domain, then those of its walls.

    Raises CaseError where one stands between two planes of the lattice, where one axis has two on one side,
    or where a wall has no flat face that the fluid is before.
    """
    found = [(f"space.symmetry: {side}", plane) for side, plane in _of_domain(case)]
    for name, wall in case.walls.items():
        if wall.condition == MIRROR:
            before = {".".join(entry.loc) for entry in case.movers if entry.of.finds}
            held = around([part.room for part in parts if part.key in before])
            found += [(f"walls.{name}", plane) for plane in _of_wall(case, name, wall, held)]
    seen: dict[tuple[int, int], str] = {}
    for key, plane in found:
        _refuse_between_sites(case, key, plane)
        if AXES[plane.axis] in case.space.periodic:
            raise CaseError(
                [f"{case.file}: {key}: the axis {AXES[plane.axis]} is periodic; remove one of the two"]
            )
        first = seen.setdefault((plane.axis, plane.side), key)
        if first != key:
            raise CaseError([f"{case.file}: {key}: {first} mirrors the same side; remove one of the two"])
    return tuple(plane for _, plane in found)


def distances(planes: tuple[Plane, ...]) -> dict[int, tuple[float, float]]:
    """The places, m, of the two mirrors across each axis that has two."""
    pairs = {(one.axis, one.at, other.at) for one in planes for other in planes if one.axis == other.axis}
    return {axis: (low, high) for axis, low, high in sorted(pairs) if low < high}


def clipped(box: tuple[Corner, Corner], planes: tuple[Plane, ...]) -> tuple[Corner, Corner]:
    """The corners of a box, m, without what lies behind mirrors."""
    lower, upper = map(list, box)
    for plane in planes:
        d = plane.axis
        lower[d], upper[d] = (
            (max(lower[d], plane.at), upper[d])
            if plane.side == BELOW
            else (lower[d], min(upper[d], plane.at))
        )
    return tuple(lower), tuple(upper)


def around(boxes: Sequence[tuple[Corner, Corner]]) -> tuple[Corner, Corner]:
    """The corners, m, of the smallest box that holds all boxes."""
    lower, upper = zip(*boxes)
    return tuple(map(min, zip(*lower))), tuple(map(max, zip(*upper)))


def _of_domain(case: Case):
    for side in case.space.symmetry:
        axis, end = AXES.index(side[0]), side[2:]
        corner = case.space.lower if end == "lower" else case.space.upper
        yield side, Plane(axis, BELOW if end == "lower" else ABOVE, corner[axis])


def _of_wall(case: Case, name: str, wall, held: tuple[Corner, Corner]):
    """The faces of a wall that the fluids, which ``held`` encloses, are before."""
    faces = list(faces_before(wall.shape, held, TOLERANCE * case.space.spacing))
    if not faces:
        raise CaseError(
            [
                f"{case.file}: walls.{name}.condition: a mirror is flat and infinite: give a box along a "
                "whole side of the fluids, or a box around them with a box taken out (difference)"
            ]
        )
    still = (0.0,) * case.space.dimensions
    if any(wall.velocity or ()) and not wall.no_slip:
        raise CaseError(
            [
                f"{case.file}: walls.{name}.velocity: without no_slip a mirror drags nothing along; set "
                "no_slip = true, or leave the velocity out"
            ]
        )
    for axis, side, at in faces:
        if (wall.velocity or still)[axis]:
            raise CaseError(
                [
                    f"{case.file}: walls.{name}.velocity: {wall.velocity[axis]:g} m/s across its face "
                    f"{AXES[axis]} = {at:g} m: a mirror moves along its face alone; give each face a wall "
                    "of its own"
                ]
            )
        motion = motion_of(wall.motion)
        if motion is not None and not _goes_along(motion, axis, case.time.end):
            raise CaseError(
                [
                    f"{case.file}: walls.{name}.motion: a mirror moves along its normal alone, here "
                    f"{AXES[axis]}, and turns nowhere; give each face a wall of its own"
                ]
            )
        yield Plane(axis, side, at, wall.no_slip, wall.velocity or still, motion)


def _goes_along(motion, axis: int, end: float) -> bool:
    """Whether a motion is one along an axis alone, till the ``end``, s."""
    if not is_rigid(motion):
        return False
    poses = [motion.pose(t) for t in moments(end, LOOKS)]
    across = [pose.velocity[d] for pose in poses for d in range(len(AXES)) if d != axis]
    return not any(across) and not any(any(pose.angular_velocity) for pose in poses)


def faces_before(
    shape: Shape, held: tuple[Corner, Corner], tolerance: float
) -> Iterator[tuple[int, int, float]]:
    """Axis, side (BELOW, ABOVE) and place, m, of each face of a mirror that what is ``held`` is before."""
    low, high = held
    match form_of(shape):
        case Boxed(lower=lower, upper=upper):
            beside = [
                (d, side, at)
                for d in range(len(lower))
                for side, at, away in (
                    (BELOW, upper[d], low[d] - upper[d]),
                    (ABOVE, lower[d], lower[d] - high[d]),
                )
                if away >= -tolerance
            ]
            if len(beside) == 1:
                [(axis, *_)] = beside
                others = [d for d in range(len(lower)) if d != axis]
                if all(lower[d] <= low[d] + tolerance and upper[d] >= high[d] - tolerance for d in others):
                    yield from beside
        case Less(base=Boxed(bounds=outer), minus=(Boxed() as room,)):
            yield from _faces_around(room, outer, held, tolerance)
        case Coat(of=Boxed() as room, inside=False, bounds=outer):
            yield from _faces_around(room, outer, held, tolerance)


def _faces_around(
    room: Boxed, outer: tuple[Corner, Corner], held: tuple[Corner, Corner], tolerance: float
) -> Iterator[tuple[int, int, float]]:
    """Those of a room in which all is that is ``held``, where the wall reaches beyond it."""
    (low, high), (lower, upper) = held, outer
    inside = all(a <= b + tolerance for a, b in zip(room.lower, low)) and all(
        a >= b - tolerance for a, b in zip(room.upper, high)
    )
    for d in range(len(low) if inside else 0):
        if lower[d] < room.lower[d] - tolerance:
            yield d, BELOW, room.lower[d]
        if upper[d] > room.upper[d] + tolerance:
            yield d, ABOVE, room.upper[d]


def _refuse_between_sites(case: Case, key: str, plane: Plane) -> None:
    dx, axis = case.space.spacing, AXES[plane.axis]
    origin = case.space.origin[plane.axis]
    spacings = (plane.at - origin) / dx
    if abs(spacings - round(spacings)) > TOLERANCE * max(1.0, abs(spacings)):
        raise CaseError(
            [
                f"{case.file}: {key}: the mirror at {axis} = {plane.at:g} m is not between two planes of "
                f"the lattice, at {origin:g} m + k {dx:g} m; choose a space.spacing that divides the "
                "distance, or another space.origin"
            ]
        )
