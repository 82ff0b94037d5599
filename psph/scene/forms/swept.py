"""Flat forms that are drawn out along an axis, or turned about one."""

from collections.abc import Iterator, Sequence

import numpy as np

from psph.scene.forms.form import Faces, Form, Grid, Room, Triangles, between, meeting, radial
from psph.scene.forms.joined import Together
from psph.scene.forms.looks import cells, filled, turn
from psph.scene.forms.plain import Boxed

NEAR = 1e-9
"""Of the size of a profile: nearer to the axis it has no face, but goes on beyond."""


class DrawnOut(Form):
    """A flat ``profile`` drawn out along the axis number ``along`` over a ``range``, an interval."""

    dimensions = 3

    def __init__(self, profile: Form, along: int, range: Boxed):
        self.profile, self.along, self.range = profile, along, range
        self.others = [d for d in (0, 1, 2) if d != along]

    def holds(self, grid: Grid, by: np.ndarray, slack: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        flat = self.profile.holds([grid[d] for d in self.others], by[self.others], slack)
        return flat & self.range.holds([grid[self.along]], by[[self.along]], slack)

    def support(self, way: np.ndarray) -> float:
        """As psph.scene.forms.form says."""
        return self.profile.support(way[self.others]) + self.range.support(way[[self.along]])

    def faces(self, points: np.ndarray, room: Room | None = None) -> Faces:
        """As psph.scene.forms.form says."""
        found = []
        for of, axes in ((self.profile, self.others), (self.range, [self.along])):
            part = of.faces(points[:, axes], None if room is None else (room[0][axes], room[1][axes]))
            normal = np.zeros_like(points)
            normal[:, axes] = part.normal
            found.append(Faces(part.away, normal))
        return meeting(*found)

    def corners(self, apart: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        ends = np.array([self.range.lower, self.range.upper])
        levels = np.concatenate([ends, between(*ends, apart)])[:, 0]
        rails = [self._at(self.profile.corners(apart), level) for level in levels]
        return np.concatenate([*rails, *(self._at(self.profile.straight(apart), end) for end in ends[:, 0])])

    def _at(self, flat: np.ndarray, level: float) -> np.ndarray:
        """Points (n, 2) at a place along the axis, (n, 3)."""
        return np.insert(flat, self.along, level, axis=1)

    def endless(self, lower: np.ndarray, upper: np.ndarray, periods: Sequence[float | None]) -> Form:
        """As psph.scene.forms.form says."""
        flat, far = (
            [lower[axes], upper[axes], [periods[d] for d in axes]] for axes in (self.others, [self.along])
        )
        return DrawnOut(self.profile.endless(*flat), self.along, self.range.endless(*far))

    def pieces(self) -> Iterator[Form]:
        """As psph.scene.forms.form says."""
        return (drawn_out(one, self.along, self.range) for one in self.profile.pieces())

    def surface(self, spacing: float, lines: Sequence[np.ndarray]) -> Triangles:
        """As psph.scene.forms.form says."""
        [low], [up] = self.range.lower, self.range.upper
        cuts = np.linspace(low, up, max(1, round((up - low) / spacing)) + 1)
        found = [np.empty((0, 3, 3))]
        for ring in self.profile.outline(spacing):
            grid = [np.repeat(x[:, None], len(cuts), axis=1) for x in ring.T]
            grid.insert(self.along, np.repeat(cuts[None], len(ring), axis=0))
            found.append(cells(*grid))
            flat = filled(ring, self._in_profile, spacing).reshape(-1, 2)
            found += [self._at(flat, level).reshape(-1, 3, 3) for level in (low, up)]
        return np.concatenate(found)

    def _in_profile(self, points: np.ndarray) -> np.ndarray:
        return self.profile.holds([*points.T], np.zeros(2), 0.0)


def drawn_out(profile: Form, along: int, range: Boxed) -> Form:
    """A prism; of boxes boxes, of what is made of parts the same of their prisms."""
    match profile:
        case Boxed():
            ends = (
                np.insert(of, along, end[0])
                for of, end in zip((profile.lower, profile.upper), (range.lower, range.upper))
            )
            return Boxed(*ends)
        case Together():
            return profile.each(lambda one: drawn_out(one, along, range))
    return DrawnOut(profile, along, range)


class Revolved(Form):
    """A flat ``profile`` over the distance r from the axis z and the height on it, turned about z."""

    dimensions = 3

    def __init__(self, profile: Form):
        self.profile = profile

    def holds(self, grid: Grid, by: np.ndarray, slack: float) -> np.ndarray:
        """As psph.scene.forms.form says: what is round keeps no point on its outside."""
        x, y, z = grid
        return self.profile.holds([np.sqrt(x * x + y * y), z], np.array([slack, by[2]]), slack)

    def support(self, way: np.ndarray) -> float:
        """As psph.scene.forms.form says."""
        return self.profile.support(np.array([np.hypot(way[0], way[1]), way[2]]))

    def faces(self, points: np.ndarray, room: Room | None = None) -> Faces:
        """As psph.scene.forms.form says."""
        length, out = radial(points[:, :2])
        size = NEAR * max(up - low for low, up in zip(*self.profile.bounds))
        lower, upper = np.array([size, -np.inf]), np.array([np.inf, np.inf])
        if room is not None:
            lower[1], upper[1] = room[0][2], room[1][2]
        found = self.profile.faces(np.column_stack([length, points[:, 2]]), (lower, upper))
        return Faces(found.away, np.column_stack([found.normal[:, :1] * out, found.normal[:, 1]]))

    def pieces(self) -> Iterator[Form]:
        """As psph.scene.forms.form says."""
        return (Revolved(one) for one in self.profile.pieces())

    def surface(self, spacing: float, lines: Sequence[np.ndarray]) -> Triangles:
        """As psph.scene.forms.form says."""
        angle = turn(self.profile.support(np.array([1.0, 0.0])), spacing)
        rings = [np.maximum(ring, [0.0, -np.inf]) for ring in self.profile.outline(spacing)]
        found = [
            cells(r * np.cos(angle), r * np.sin(angle), z + 0.0 * angle)
            for r, z in (ring.T[:, :, None] for ring in rings)
        ]
        return np.concatenate([np.empty((0, 3, 3)), *found])
