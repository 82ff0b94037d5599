"""Walls, bodies and frames that move: how far and how fast, in words, and what they run into."""

import math
from collections.abc import Iterator
from functools import cache
from itertools import product
from typing import Any, NamedTuple

import numpy as np

from psph.case.errors import dotted
from psph.case.keys import AXES, Table
from psph.case.motion import BUILT_IN, RADIANS
from psph.physics.motion import Immersed, is_free, is_rigid
from psph.physics.rigid.bodies import Body
from psph.physics.rigid.motion import Part, Rigid
from psph.physics.rigid.pose import PLACE, maps

FARTHEST = 2e9
"""Spacings from 0 at most: farther out a coordinate does not tell a small part of one."""

MOMENTS = 1000
"""Times of a run at which a motion is looked at."""

LOOKS, LOOKED_AT = 100, 4000
"""Times at which walls that meet are looked for, and sites of a wall that are looked at."""

QUICK = 0.1
"""Part of the speed of sound above which a wall is said to be fast: it compresses the fluid by a tenth."""

FAR_OFF = 0.25
"""Part of a column's range that a spline may go beyond two rows; a sine in four rows a period goes 0.21."""


class Sweep(NamedTuple):
    """What a motion does until the end of a run, as far as can be seen at some moments.

    ``lower``, ``upper`` of the box that it sweeps, the longest ``way`` of a point from where it was, m; the
    largest ``speed``, m/s, and ``acceleration``, m/s²; the largest ``jump`` of a velocity at the start, m/s.
    """

    lower: np.ndarray
    upper: np.ndarray
    way: float
    speed: float
    acceleration: float
    jump: float


def moments(end: float, count: int) -> np.ndarray:
    """Times from 0 to ``end`` that no period divides: the golden section's multiples."""
    return np.array([0.0, *(end * ((k * 0.6180339887498949) % 1.0) for k in range(1, count)), end])


@cache
def sweep(motion, lower: tuple[float, ...], upper: tuple[float, ...], end: float) -> Sweep:
    """Of all points in a box that move by ``motion``."""
    corners = list(product(*zip(lower, upper)))
    found = np.stack([maps(motion.pose(t), len(lower)) for t in moments(end, MOMENTS)])
    points = np.array(corners)
    x, v, a = (found[:, which, :, :1] + found[:, which, :, 1:] @ points.T for which in range(3))
    longest = (float(np.sqrt((z**2).sum(axis=1)).max()) for z in (x - points.T, v, a, v[:1]))
    way, speed, acceleration, jump = longest
    return Sweep(x.min(axis=(0, 2)), x.max(axis=(0, 2)), way, speed, acceleration, jump)


def moving_parts(scene) -> Iterator[tuple[int, str, Sweep]]:
    """Each wall and body that moves rigidly as it is told: its number among the species, its key and what
    it does."""
    for number, one in enumerate(scene.species_in_motion):
        told = one.motion if isinstance(one, Body) else one
        if is_rigid(told):
            low, high = (tuple(end.tolist()) for end in _box(scene, number))
            yield number, scene.key_of(number), sweep(told, low, high, scene.case.time.end)


def _box(scene, number: int) -> tuple[np.ndarray, np.ndarray]:
    """The corners of the box around the cells of a part at the start, m."""
    half = 0.5 * scene.spacing
    return scene.census.lowest[number] - half, scene.census.highest[number] + half


def frame_sweep(scene) -> Sweep | None:
    """What a moving frame does to the box around the scene."""
    if scene.frame is None:
        return None
    return sweep(scene.frame, tuple(scene.lower), tuple(scene.upper), scene.case.time.end)


def largest_speed(scene) -> float:
    """Of walls and bodies that move as they are told, and of bodies that start with a spin, m/s."""
    told = (found.speed for _, _, found in moving_parts(scene))
    return max((*told, *_spinning_speeds(scene)), default=0.0)


def _spinning_speeds(scene) -> Iterator[float]:
    """|V| + |ω| r of each body at the start, m/s, with its corner at r farthest from what it turns about."""
    d = scene.dimensions
    for number, one in enumerate(scene.rigid_bodies, scene.layout.first_body):
        far = np.abs(np.array(_box(scene, number)) - one.reference[:d]).max(axis=0)
        yield math.hypot(*one.velocity) + math.hypot(*one.spin) * math.hypot(*far)


def fastest_corner(scene, part: int) -> float:
    """Largest speed at a corner of the box around what starts with a gradient."""
    body = scene.parts[part]
    if not body.velocity_gradient:
        return 0.0
    ends = np.array([scene.census.lowest[part], scene.census.highest[part]])
    corners = np.array(list(product(*ends.T)))
    velocity = body.sheared(corners) + np.array(scene.velocities[part])
    return float(np.sqrt((velocity**2).sum(axis=1)).max())


def falling_speed(scene) -> float:
    """√(2gH), free fall over the height H of all that moves freely, m/s: g without what pulls along a
    periodic axis, and with the largest acceleration of a moving frame.

    A body falls as far as its lowest particle is above the lowest of all, on a pivot as far as its highest.
    """
    framed, movers = frame_sweep(scene), slice(scene.layout.movers)
    pull = math.hypot(*scene.height_gravity) + (framed.acceleration if framed else 0.0)
    tops, bottoms = scene.census.top[movers].tolist(), scene.census.bottom[movers].tolist()
    for number, one in enumerate(scene.rigid_bodies, scene.layout.first_body):
        lowest, highest = float(scene.census.bottom[number]), float(scene.census.top[number])
        if any(slides and g for slides, g in zip(one.slides, scene.height_gravity)):
            tops.append(lowest - scene.spacing)
            bottoms.append(lowest)
        elif one.pivot is not None and any(one.turns):
            tops.append(highest)
            bottoms.append(lowest)
    height = max(tops) - min(bottoms) + scene.spacing
    return math.sqrt(2.0 * pull * max(height, 0.0))


def motion_faults(scene) -> Iterator[str]:
    """Motions that leave what numbers can tell."""
    for _, key, found in moving_parts(scene):
        far = max(np.abs(found.lower).max(), np.abs(found.upper).max())
        if not far <= FARTHEST * scene.spacing:
            yield (
                f"{key}.motion: goes {far:.3g} m from 0, {far / scene.spacing:.2g} spacings, too far "
                "for double precision; correct its numbers, or give it an end"
            )


def motion_lines(scene) -> Iterator[str]:
    """What moves, in words, for `explain`."""
    tables: dict[str, Any] = {
        key: (found, scene.species_in_motion[n]) for n, key, found in moving_parts(scene)
    }
    if framed := frame_sweep(scene):
        tables["frame"] = (framed, scene.frame)
    told = {".".join(loc): parts for loc, parts in scene.case.motions.items()}
    for key, (found, moved) in tables.items():
        parts = [_part_in_words(part) for part in told[f"{key}.motion"]]
        yield f"  motion      {key}: {'; then '.join(parts)}"
        yield (
            f"              at most {found.way:.3g} m from its start, {found.speed:.3g} m/s "
            f"({found.speed / scene.sound_speed:.2g} c), {found.acceleration:.3g} m/s2"
        )
        motion = getattr(moved, "motion", moved)  # of a body or clamp that one
        yield from (f"              {line}" for line in _turns_in_words(motion, scene.case.time.end))
        if found.jump > 0.0:
            yield f"              it begins at once with {found.jump:.3g} m/s"


def _turns_in_words(motion, end: float) -> Iterator[str]:
    """How far and how fast each part of a motion turns that does."""
    parts = motion.parts if isinstance(motion, Rigid) else ()
    for part in (one for one in parts if isinstance(one, Part)):
        told = [part.law.ways(part.schedule, t) for t in moments(end, MOMENTS)]
        angle, rate = (max(abs(one[k][3]) for one in told) for k in (0, 1))
        if angle or rate:
            yield (
                f"turns by at most {angle:.3g} rad ({math.degrees(angle):.3g} degrees), at {rate:.3g} rad/s "
                f"({math.degrees(rate):.3g} degrees/s)"
            )


def _part_in_words(part) -> str:
    if part.way not in BUILT_IN:
        return part.way
    told = (
        f"{name} {_plain(value)}"
        for name, value in getattr(part, part.way)
        if value is not None and (name, value) not in (("phase", 0.0), ("angle_unit", RADIANS))
        if not isinstance(value, Table)  # of which other lines tell
    )
    when = [f"from {part.start:g} s"] if part.start else []
    when += [f"to {part.end:g} s"] if part.end is not None else []
    when += [f"ramp {part.ramp:g} s"] if part.ramp else []
    return " ".join([part.way, ", ".join([*told, *when])])


def _plain(value) -> str:
    if isinstance(value, tuple):
        return f"[{', '.join(map(_plain, value))}]"
    return f"{value:g}" if isinstance(value, float) else str(value)


def motion_warnings(scene) -> Iterator[str]:
    """What of the motions of walls and bodies may not be meant so."""
    for number, part, found in moving_parts(scene):
        key = f"{part}.motion"
        share = found.speed / scene.sound_speed
        if share > QUICK and (scene.case.fluids or not scene.case.solids):
            yield (
                f"{key}: {found.speed:.3g} m/s is {share:.2g} of the speed of sound, which compresses the "
                f"fluid before it; give physics.sound_speed = {10.0 * found.speed:.3g} or more"
            )
        yield from _leaving(scene, key, found)
        if met := None if goes_free(scene.species_in_motion[number]) else _first_met(scene, number):
            time, other, place = met
            yield (
                f"{key}: at {time:.3g} s it is in {other}, near "
                f"({', '.join(f'{x:.3g}' for x in place)}): they run through each other"
            )


def overshoots(scene) -> Iterator[str]:
    """Series whose rows are too few where they bend for a smooth curve to stay near them."""
    for loc, parts in scene.case.motions.items():
        for series in (part.series for part in parts if part.series):
            share, first, last = series.law().overshoot()
            if share > FAR_OFF:
                yield (
                    f"{dotted(loc)}.series: between its rows at {first:g} and {last:g} s the smooth curve "
                    f"through {series.file} goes beyond both by {share:.2g} of the whole way of that column; "
                    "give more rows there"
                )


def _leaving(scene, key: str, found: Sweep) -> Iterator[str]:
    """Where a wall leaves the domain that the case gives, along an axis that does not repeat."""
    for end, given, reached in (
        ("lower", scene.case.space.lower, found.lower),
        ("upper", scene.case.space.upper, found.upper),
    ):
        for d in (d for d, period in enumerate(scene.periods) if given and period is None):
            beyond = reached[d] - given[d] if end == "upper" else given[d] - reached[d]
            if beyond > 1e-6 * scene.spacing:
                yield (
                    f"{key}: it comes to {AXES[d]} = {reached[d]:.3g} m, beyond space.{end}; this works, but "
                    "lists take longer than with a larger domain"
                )


def _first_met(scene, number: int) -> tuple[float, str, np.ndarray] | None:
    """The first time looked at when a part is within another one whose place is known, the key of that,
    and where."""
    sites = _sites(scene, number)
    motions, dimensions = scene.species_in_motion, scene.dimensions
    known = (n for n in range(scene.layout.fluids, len(motions)) if not goes_free(motions[n]))
    others = [n for n in known if motions[n] != motions[number]]
    for time in np.sort(moments(scene.case.time.end, LOOKS)):
        places = moved_on(motions[number], sites, time, dimensions)
        for rest in {id(motions[n]): motions[n] for n in others}.values():
            back = taken_back(rest, places, time, dimensions) if is_rigid(rest) else places
            grid = [scene.folded(d, x) for d, x in enumerate(back.T)]
            held = scene.layout.held(grid, grid[0].shape)
            for n in (n for n in others if motions[n] is rest or motions[n] == rest):
                if (within := held == n).any():
                    return float(time), scene.key_of(n), places[np.argmax(within)]
    return None


def goes_free(motion) -> bool:
    """Whether forces say where a part goes, at least along an axis."""
    if isinstance(motion, Body):
        return any((*motion.slides, *motion.turns))
    return is_free(motion) or isinstance(motion, Immersed)


def _sites(scene, number: int) -> np.ndarray:
    """Places of some of a wall's particles at the start (n, dim)."""
    found = []
    for first, last in scene.lattice.chunks():
        held = scene.layout.materials(first, last) == number
        grid = scene.lattice.grid(first, last)
        found.append(np.stack([np.broadcast_to(x, held.shape)[held] for x in grid], axis=1))
    sites = np.concatenate(found)
    return sites[:: max(1, len(sites) // LOOKED_AT)]


def moved_on(motion, points: np.ndarray, time: float, dimensions: int) -> np.ndarray:
    """Where ``points`` (n, dim), m, of something rigid have come at ``time``."""
    place = maps(motion.pose(time), dimensions)[PLACE]
    return place[:, 0] + points @ place[:, 1:].T


def taken_back(motion, points: np.ndarray, time: float, dimensions: int) -> np.ndarray:
    """Where ``points`` (n, dim), m, of something rigid at ``time`` were before it moved."""
    place = maps(motion.pose(time), dimensions)[PLACE]
    return (points - place[:, 0]) @ place[:, 1:]
