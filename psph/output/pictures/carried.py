"""Walls and bodies in 3D: the surface that each has at the start, carried to where its particles are."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from pydantic import ValidationError

from psph.case.shapes import Shape
from psph.fields import WALL
from psph.output.pictures.groups import first_wall, first_whole, standing_of
from psph.output.pictures.view import box_around
from psph.output.pictures.walls import Triangles, encloses, inwards, surface
from psph.output.pictures.water import fluid_surface

BENT = 0.2
"""Spacings by which particles may miss a motion without deformation."""


class Carried:
    """A wall of ``group``, or what is moved as a ``whole``: its ``faces`` (n, 3, 3), m, in the frame
    ``start``; ``around`` the fluid?"""

    def __init__(self, group: int, faces: Triangles, around: bool, whole: bool, start: dict, spacing: float):
        self.whole = whole
        self.group, self.faces, self.around, self.spacing = group, faces, around, spacing
        self._ids, self._rest = self._particles(start)

    def at(self, frame: dict) -> Triangles:
        """Its surface in ``frame``, (n, 3, 3).

        Moved and turned as its particles were; where they were bent, or came and went, a surface around them.
        """
        ids, places = self._particles(frame)
        if np.array_equal(ids, self._ids):
            if not len(ids) or np.abs(places - self._rest).max() < 1e-9 * self.spacing:
                return self.faces
            turn, shift = rigid(self._rest, places)
            if np.abs(self._rest @ turn.T + shift - places).max() < BENT * self.spacing:
                return self.faces @ turn.T + shift
        return hull(places, self.spacing)

    def _particles(self, frame: dict) -> tuple[np.ndarray, np.ndarray]:
        mine = frame["group"] == self.group
        order = np.argsort(frame["id"][mine])
        return frame["id"][mine][order], frame["position"][mine][order]


def rigid(before: np.ndarray, after: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The rotation R (dim, dim) and shift s (dim,) that bring points (n, dim) nearest to others: x → R x + s.

    Kabsch (1976), Acta Cryst. A 32, 922.
    """
    from_here, to_there = before.mean(axis=0), after.mean(axis=0)
    left, _, right = np.linalg.svd((after - to_there).T @ (before - from_here))
    flip = np.diag([*np.ones(len(left) - 1), np.sign(np.linalg.det(left @ right))])
    turn = left @ flip @ right
    return turn, to_there - turn @ from_here


def hull(places: np.ndarray, spacing: float) -> Triangles:
    """A surface (n, 3, 3) around particles at ``places`` (n, 3), m."""
    around = fluid_surface(places, spacing)
    return np.empty((0, 3, 3)) if around is None else around.points[around.regular_faces].astype(float)


def carried_parts(case: dict, start: dict, spacing: float, folder: Path) -> Iterator[Carried]:
    """All that is not fluid in ``case`` (3D), whose first frame is ``start``; its files are in ``folder``.

    What has no shape in the case, or one whose file is gone, gets a surface around its particles.
    """
    space = case["space"]
    lower, upper = (
        np.array(space.get(end, [far] * 3)) for end, far in (("lower", -np.inf), ("upper", np.inf))
    )
    wet = start["kind"] != WALL
    inner = box_around(start["position"][wet])
    held = [_shape(one["shape"], folder) for one in standing_of(case)]
    known = {group: shape for group, shape in enumerate(held, first_wall(case)) if shape}
    for group in sorted(known.keys() | set(start["group"][~wet].tolist())):
        if shape := known.get(group):
            faces, around = surface(shape, spacing, lower, upper), encloses(shape, *inner)
            faces = inwards(faces, shape) if around else faces
        else:
            faces, around = hull(start["position"][start["group"] == group], spacing), False
        yield Carried(group, faces, around, group >= first_whole(case), start, spacing)


def _shape(table: dict, folder: Path) -> Shape | None:
    """A shape of the case; None where the file that draws it is no longer there."""
    try:
        return Shape.model_validate(table, context=folder)
    except ValidationError:
        return None
