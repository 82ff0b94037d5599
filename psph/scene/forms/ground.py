"""All below a ground whose heights stand over a grid."""

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from psph.case.height_map import Heights
from psph.scene.forms.form import Faces, Form, Grid, Room, Triangles
from psph.scene.forms.polygon import Polygonal


class Ground(Form):
    """All below ``heights``, straight between their points, down to ``bottom``, m."""

    def __init__(self, heights: Heights, bottom: float):
        self.heights, self.bottom = heights, bottom
        self.dimensions = len(heights.sides) + 1

    def holds(self, grid: Grid, by: np.ndarray, slack: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        *across, z = (x + d for x, d in zip(grid, by))
        held = (z >= self.bottom) & (z < self.height(across))
        for x, side in zip(across, self.heights.sides):
            held = held & ((x >= side[0]) & (x < side[-1]))
        return held

    def height(self, across: Sequence[np.ndarray]) -> np.ndarray:
        """Of the ground at horizontal coordinates, m; bilinear, beyond the border that of the border."""
        whole, first, share = 0.0, [], []
        for x, side in zip(across, self.heights.sides):
            k = np.clip(np.searchsorted(side, x, "right") - 1, 0, len(side) - 2)
            first.append(k)
            share.append(np.clip((x - side[k]) / (side[k + 1] - side[k]), 0.0, 1.0))
        for corner in np.ndindex(*(2,) * len(first)):
            weight = 1.0
            for step, part in zip(corner, share):
                weight = weight * (part if step else 1.0 - part)
            whole = whole + weight * self.heights.level[tuple(k + step for k, step in zip(first, corner))]
        return whole

    def support(self, way: np.ndarray) -> float:
        """As psph.scene.forms.form says."""
        *across, up = way
        level = np.maximum(self.heights.level, self.bottom) if up > 0.0 else np.full(1, self.bottom)
        if not any(across):
            return float((up * level).max())
        axes = np.meshgrid(*self.heights.sides, indexing="ij")
        return float((sum(w * x for w, x in zip(across, axes)) + up * level).max())

    def faces(self, points: np.ndarray, room: Room | None = None) -> Faces:
        """As psph.scene.forms.form says; of four triangles in each cell of the grid."""
        return self._outer.faces(points, room)

    def corners(self, apart: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        return self._outer.corners(apart)

    def straight(self, apart: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        return self._outer.straight(apart)

    def surface(self, spacing: float, lines: Sequence[np.ndarray]) -> Triangles:
        """As psph.scene.forms.form says, in pieces of its grid."""
        return self._outer.surface(spacing, lines)

    def outline(self, spacing: float) -> list[np.ndarray]:
        """As psph.scene.forms.form says."""
        return self._outer.outline(spacing)

    @cached_property
    def _outer(self) -> Form:
        """Its border: a polygon, or a closed surface."""
        level = np.maximum(self.heights.level, self.bottom)
        if self.dimensions == 3:
            from psph.scene.forms.of_mesh import OfSurface  # takes a while

            return OfSurface(*_body(*self.heights.sides, level, self.bottom))
        [side] = self.heights.sides
        ends = [(side[-1], self.bottom), (side[0], self.bottom)]
        points = [*zip(side.tolist(), level.tolist()), *ends]
        return Polygonal([one for one, before in zip(points, [points[-1], *points]) if one != before])


def _body(x: np.ndarray, y: np.ndarray, level: np.ndarray, bottom: float) -> tuple[np.ndarray, np.ndarray]:
    """Corners (n, 3) and triangles (m, 3) of the closed body below heights (x, y)."""
    shape, count = level.shape, level.size
    top = np.stack([*np.meshgrid(x, y, indexing="ij"), level], axis=-1)
    middle = 0.25 * (top[:-1, :-1] + top[1:, :-1] + top[:-1, 1:] + top[1:, 1:])
    node = np.arange(count).reshape(shape)
    centre = count + np.arange(middle[..., 0].size).reshape(middle.shape[:2])
    ring = [node[:-1, :-1], node[1:, :-1], node[1:, 1:], node[:-1, 1:]]
    upper = [(one, two, centre) for one, two in zip(ring, [*ring[1:], ring[0]])]
    around = np.concatenate([node[:-1, 0], node[-1, :-1], node[:0:-1, -1], node[0, :0:-1]])
    below = count + centre.size + np.arange(len(around))
    lowest = below[-1] + 1
    ahead, under = np.roll(around, -1), np.roll(below, -1)
    nodes = top.reshape(-1, 3)
    floor = np.concatenate([nodes[around], nodes.mean(axis=0)[None]])
    floor[:, 2] = bottom
    vertices = np.concatenate([nodes, middle.reshape(-1, 3), floor])
    low = np.full(len(around), lowest)
    faces = [*upper, (around, under, ahead), (around, below, under), (below, low, under)]
    return vertices, np.concatenate([np.stack(one, axis=-1).reshape(-1, 3) for one in faces])
