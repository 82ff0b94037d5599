"""Boxes, discs, balls and half-spaces."""

import math
from collections.abc import Iterator, Sequence
from itertools import product

import numpy as np

from psph.scene.forms.form import BESIDE, Faces, Form, Grid, Room, Triangles, along, between, radial
from psph.scene.forms.looks import across, cells, turn

AXES_OF_SPACE = 3


class Boxed(Form):
    """An interval, rectangle or block along the axes."""

    def __init__(self, lower: Sequence[float], upper: Sequence[float]):
        self.lower, self.upper = tuple(map(float, lower)), tuple(map(float, upper))
        self.dimensions = len(self.lower)

    def holds(self, grid: Grid, by: np.ndarray, slack: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        held = True
        for x, low, up, d in zip(grid, self.lower, self.upper, by):
            held = held & ((x >= low - d) & (x < up - d))
        return held

    def support(self, way: np.ndarray) -> float:
        """As psph.scene.forms.form says."""
        return along(way, self.lower, self.upper)

    def faces(self, points: np.ndarray, room: Room | None = None) -> Faces:
        """As psph.scene.forms.form says."""
        lower, upper = np.array(self.lower), np.array(self.upper)
        if room is not None:
            lower, upper = np.where(lower < room[0], -np.inf, lower), np.where(upper > room[1], np.inf, upper)
        below, above = lower - points, points - upper
        beyond, row = np.maximum(below, above), np.arange(len(points))
        sign, nearest = np.where(below > above, -1.0, 1.0), beyond.argmax(axis=1)
        flat = np.zeros_like(points)
        flat[row, nearest] = sign[row, nearest]
        outer = np.maximum(beyond, 0.0)
        aslant = np.count_nonzero(outer, axis=1) > 1
        away, normal = radial(sign * outer)
        return Faces(
            np.where(aslant, away, beyond[row, nearest]),
            np.where(aslant[:, None], normal, flat),
        )

    def away(self, points: np.ndarray) -> np.ndarray:
        """As psph.scene.forms.form says."""
        beyond = [np.maximum(low - x, x - up) for x, low, up in zip(points.T, self.lower, self.upper)]
        nearest = np.maximum.reduce(beyond)
        outer2 = sum(np.maximum(one, 0.0) ** 2 for one in beyond)
        return np.where(nearest > 0.0, np.sqrt(outer2), nearest)

    def corners(self, apart: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        ends = np.array([*product(*zip(self.lower, self.upper))])
        return ends if self.dimensions < AXES_OF_SPACE else self._with_edges(ends, apart)

    def straight(self, apart: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        return self._with_edges(self.corners(apart), apart)

    def _with_edges(self, ends: np.ndarray, apart: float) -> np.ndarray:
        pairs = (np.flatnonzero(np.count_nonzero(ends != one, axis=1) == 1) for one in ends)
        sides = [(n, m) for n, others in enumerate(pairs) for m in others if n < m]
        return np.concatenate([ends, *(between(ends[n], ends[m], apart) for n, m in sides)])

    def endless(self, lower: np.ndarray, upper: np.ndarray, periods: Sequence[float | None]) -> Form:
        """As psph.scene.forms.form says."""
        first, last, low, up = map(np.array, (lower, upper, self.lower, self.upper))
        most = float((last - first).max())
        fills = (low < first + BESIDE * most) & (up > last - BESIDE * most)
        more = most * (fills & [period is not None for period in periods])
        return Boxed(low - more, up + more)

    def surface(self, spacing: float, lines: Sequence[np.ndarray]) -> Triangles:
        """As psph.scene.forms.form says."""
        return np.concatenate(list(self._sides(lines)))

    def _sides(self, lines: Sequence[np.ndarray]) -> Iterator[Triangles]:
        cuts = [x[(x >= low) & (x <= up)] for x, low, up in zip(lines, self.lower, self.upper)]
        for axis in range(AXES_OF_SPACE):
            for place in (self.lower[axis], self.upper[axis]):
                grid = list(np.meshgrid(*cuts[:axis], *cuts[axis + 1 :], indexing="ij"))
                grid.insert(axis, np.full_like(grid[0], place))
                yield cells(*grid)

    def outline(self, spacing: float) -> list[np.ndarray]:
        """As psph.scene.forms.form says."""
        (left, down), (right, up) = self.lower, self.upper
        return [across(np.array([(left, down), (right, down), (right, up), (left, up)]), spacing)]


class Round(Form):
    """A disc or a ball."""

    def __init__(self, center: Sequence[float], radius: float):
        self.center, self.radius = tuple(map(float, center)), float(radius)
        self.dimensions = len(self.center)

    def holds(self, grid: Grid, by: np.ndarray, slack: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        return sum((x - c) ** 2 for x, c in zip(grid, self.center)) < (self.radius - slack) ** 2

    def support(self, way: np.ndarray) -> float:
        """As psph.scene.forms.form says."""
        return along(way, self.center, self.center) + self.radius * math.hypot(*way)

    def faces(self, points: np.ndarray, room: Room | None = None) -> Faces:
        """As psph.scene.forms.form says."""
        away, normal = radial(points - np.array(self.center))
        return Faces(away - self.radius, normal)

    def surface(self, spacing: float, lines: Sequence[np.ndarray]) -> Triangles:
        """As psph.scene.forms.form says."""
        angle = turn(self.radius, spacing)
        polar = angle[: len(angle) // 2 + 1, None]
        ring = np.sin(polar)
        grid = [ring * np.cos(angle), ring * np.sin(angle), np.cos(polar) + 0 * angle]
        return cells(*(c + self.radius * x for c, x in zip(self.center, grid)))

    def outline(self, spacing: float) -> list[np.ndarray]:
        """As psph.scene.forms.form says."""
        angle = turn(self.radius, spacing)
        return [np.array(self.center) + self.radius * np.column_stack([np.cos(angle), np.sin(angle)])]


class BehindPlane(Form):
    """All behind a plane through ``at`` with the unit ``normal`` out of it, (dim,) each."""

    def __init__(self, at: Sequence[float], normal: Sequence[float]):
        self.at, self.normal = np.array(at), np.array(normal) / math.hypot(*normal)
        self.dimensions = len(self.at)

    def holds(self, grid: Grid, by: np.ndarray, slack: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        used = [(x + d - a, n) for x, d, a, n in zip(grid, by, self.at, self.normal) if n]
        shape = np.broadcast_shapes(*(np.shape(x) for x in grid))
        return np.broadcast_to(sum(x * n for x, n in used) < 0.0, shape)

    def support(self, way: np.ndarray) -> float:
        """As psph.scene.forms.form says."""
        ahead = float(way @ self.normal)
        parallel = ahead > 0.0 and np.allclose(way, ahead * self.normal, rtol=0.0, atol=SAME * ahead)
        return float(self.at @ way) if parallel else math.inf

    def faces(self, points: np.ndarray, room: Room | None = None) -> Faces:
        """As psph.scene.forms.form says."""
        return Faces((points - self.at) @ self.normal, np.tile(self.normal, (len(points), 1)))

    def surface(self, spacing: float, lines: Sequence[np.ndarray]) -> Triangles:
        """As psph.scene.forms.form says: as far as the lines reach."""
        low, up = (np.array([x[end] for x in lines]) for end in (0, -1))
        middle = 0.5 * (low + up)
        middle -= ((middle - self.at) @ self.normal) * self.normal
        one = np.eye(AXES_OF_SPACE)[int(np.abs(self.normal).argmin())]
        one = np.cross(self.normal, one)
        one /= np.linalg.norm(one)
        other, reach = np.cross(self.normal, one), float(np.linalg.norm(up - low))
        step = np.arange(-reach, reach + spacing, spacing)
        grid = middle + step[:, None, None] * one + step[:, None] * other
        return cells(*np.moveaxis(grid, 2, 0))

    def outline(self, spacing: float) -> list[np.ndarray]:
        """As psph.scene.forms.form says: it has no end."""
        return []


SAME = 1e-12
"""Of a direction, by rounding."""
