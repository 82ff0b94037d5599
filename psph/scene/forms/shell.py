"""Shells: what is nearer to the surface of a form than a thickness, on one side of it."""

import math
from collections.abc import Sequence

import numpy as np

from psph.scene.forms.form import Faces, Form, Grid, Room, Triangles

AT_ONCE = 1 << 16
"""Points whose distances are found together: bounds the memory."""


class Coat(Form):
    """The surroundings of a form ``of`` so many m ``thickness``, or what is ``inside`` of its surface."""

    def __init__(self, of: Form, thickness: float, inside: bool):
        self.of, self.thickness, self.inside = of, thickness, inside
        self.dimensions = of.dimensions

    def holds(self, grid: Grid, by: np.ndarray, slack: float) -> np.ndarray:
        """As psph.scene.forms.form says: it shares no point with what it goes round, and leaves none out."""
        shape = np.broadcast_shapes(*(np.shape(x) for x in grid))
        own = np.broadcast_to(self.of.holds(grid, by, slack), shape)
        held = own if self.inside else ~own
        for x, low, up in zip(grid, *self.bounds):
            held = held & ((x >= low - slack) & (x <= up + slack))
        rows = np.flatnonzero(held)
        points = np.stack([np.broadcast_to(x + d, shape).ravel()[rows] for x, d in zip(grid, by)], axis=1)
        near = np.zeros(held.size, bool)
        for k in range(0, len(rows), AT_ONCE):
            away = self.of.faces(points[k : k + AT_ONCE]).away
            near[rows[k : k + AT_ONCE]] = away >= -self.thickness if self.inside else away < self.thickness
        return near.reshape(shape)

    def support(self, way: np.ndarray) -> float:
        """As psph.scene.forms.form says."""
        return self.of.support(way) + (0.0 if self.inside else self.thickness * math.hypot(*way))

    def faces(self, points: np.ndarray, room: Room | None = None) -> Faces:
        """As psph.scene.forms.form says."""
        return hollow(self.of.faces(points, room), self.thickness, self.inside)

    def corners(self, apart: float) -> np.ndarray:
        """As psph.scene.forms.form says: those of what it goes round."""
        return self.of.corners(apart)

    def straight(self, apart: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        return self.of.straight(apart)

    def endless(self, lower: np.ndarray, upper: np.ndarray, periods: Sequence[float | None]) -> Form:
        """As psph.scene.forms.form says."""
        return Coat(self.of.endless(lower, upper, periods), self.thickness, self.inside)

    def surface(self, spacing: float, lines: Sequence[np.ndarray]) -> Triangles:
        """As psph.scene.forms.form says: that of what it goes round, which hides the other."""
        return np.concatenate([one.surface(spacing, lines) for one in self.of.pieces()])

    def outline(self, spacing: float) -> list[np.ndarray]:
        """As psph.scene.forms.form says: that of what it goes round."""
        return [line for one in self.of.pieces() for line in one.outline(spacing)]


def hollow(found: Faces, thickness: float, inside: bool) -> Faces:
    """Those of a shell, by the faces of what it is the shell of."""
    middle = 0.5 * thickness * (-1.0 if inside else 1.0)
    side = np.where(found.away < middle, -1.0, 1.0)
    return Faces(side * (found.away - middle) - 0.5 * thickness, side[:, None] * found.normal)
