"""Rows of lattice sites behind an open end under a surface, one upon the other: a level that moves fills and
empties them."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from psph.case.courses import Course
from psph.case.ends import OpenEnd
from psph.case.keys import AXES
from psph.scene.lattice import TOLERANCE, sites_between
from psph.scene.layout import Layout

HIGHER = 1.0
"""Times the height of the domain at the start up to which there are rows above it."""


@dataclass(frozen=True, eq=False)
class SurfaceRows:
    """The rows behind an end, from the lowest up.

    ``sites`` has for each row the places (n, dim), m, of its sites right behind the plane; ``back`` m is the
    step along ``axis`` from there to those behind them.  ``heights`` (rows,) m are along ``up`` (dim,), as
    levels are.  The lowest ``wet`` rows hold fluid at the start; what is born later is of the buffer
    ``group``.
    """

    sites: tuple[np.ndarray, ...]
    heights: np.ndarray
    wet: int
    group: int
    axis: int
    back: float
    up: np.ndarray

    @cached_property
    def counts(self) -> np.ndarray:
        """How many sites each has (rows,)."""
        return np.array([len(row) for row in self.sites])

    @property
    def level(self) -> float:
        """That of the fluid at the start, m."""
        return self.level_of(float(self.counts[: self.wet].sum()))

    def level_of(self, count: float) -> float:
        """The level up to which ``count`` sites are full, m."""
        return float(np.interp(count, *self._edges))

    @cached_property
    def _edges(self) -> tuple[np.ndarray, np.ndarray]:
        """How many sites are full up to the lower edge of each row and the upper one of the last, and where
        these are, m."""
        half = 0.5 * abs(self.back)
        edges = np.append(self.heights - half, self.heights[-1] + half)
        return np.concatenate([[0.0], np.cumsum(self.counts)]), edges

    def behind(self, plane: float, sites: np.ndarray, begins: np.ndarray, lacking: np.ndarray) -> np.ndarray:
        """Places (n, dim), m, of as many as are ``lacking`` behind each of some ``sites`` (m, dim), from the
        depth ``begins`` (m,) m behind the ``plane`` on, a spacing apart."""
        places = np.repeat(sites, lacking, axis=0)
        place = np.arange(len(places)) - np.repeat(np.cumsum(lacking) - lacking, lacking)
        depth = np.repeat(begins, lacking) + abs(self.back) * place
        places[:, self.axis] = plane + np.sign(self.back) * depth
        return places


def rows_behind(
    layout: Layout, end: OpenEnd, groups: tuple[int, ...], lower: np.ndarray, upper: np.ndarray
) -> SurfaceRows | None:
    """The rows behind an end whose buffers are in a box from ``lower`` to ``upper`` (dim,), m;
    None where gravity does not pull across it, or nothing can stand behind it."""
    up = across_up(layout, end)
    if not up.any():
        return None
    rising = int(np.abs(up).argmax())
    places = sites_behind(layout, end, lower, upper, rising)
    if up[rising] < 0.0:
        places = places[::-1]
    held = layout.held([*np.moveaxis(places, -1, 0)], places.shape[:-1])
    own = np.isin(held, groups)
    free = own | ~layout.stands(held)
    free = _joined(own if own.any() else free, free)
    rows = np.flatnonzero(free.reshape(len(free), -1).any(axis=1))
    if not len(rows):
        return None
    free, own, held, places = free[rows], own[rows], held[rows], places[rows]
    wet = int(np.flatnonzero(own.reshape(len(own), -1).any(axis=1)).max(initial=-1)) + 1
    at_plane = places.copy()
    at_plane[..., end.axis] = end.at
    heights = at_plane @ np.array(layout.up)
    return SurfaceRows(
        sites=tuple(row[one] for row, one in zip(places, free)),
        heights=np.array([row[one].mean() for row, one in zip(heights, free)]),
        wet=wet,
        group=int(held[wet - 1][own[wet - 1]][0]) if wet else groups[first_fluid(layout, end)],
        axis=end.axis,
        back=-end.sign * layout.spacing,
        up=np.array(layout.up),
    )


def raised(
    layout: Layout, end: OpenEnd, lower: np.ndarray, upper: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The box from ``lower`` to ``upper`` (dim,), m, behind an end, as far up as its level may rise."""
    up, low, high = across_up(layout, end), lower.copy(), upper.copy()
    rising = int(np.abs(up).argmax())
    if getattr(end.span, AXES[rising]) is None:
        given = end.level.largest if isinstance(end.level, Course) else end.level
        by = HIGHER * (upper - lower)[rising] + (abs(given) if isinstance(given, float) else 0.0)
        high[rising] += by * (up[rising] > 0.0)
        low[rising] -= by * (up[rising] < 0.0)
    return low, high


def across_up(layout: Layout, end: OpenEnd) -> np.ndarray:
    """The unit vector against gravity (dim,), but for what is along the end."""
    up = np.array(layout.up)
    up[end.axis] = 0.0
    return up


def first_fluid(layout: Layout, end: OpenEnd) -> int:
    """The number of the fluid that comes in first where none stands in front of an end."""
    return [*layout.case.fluids].index(end.filled) if end.filled is not None else 0


def sites_behind(
    layout: Layout, end: OpenEnd, lower: np.ndarray, upper: np.ndarray, rising: int
) -> np.ndarray:
    """The lattice sites (rows, ..., dim) right behind the plane, by rows along the axis ``rising``, m."""
    dx, axes = layout.spacing, []
    for d, origin in enumerate(layout.lattice.origin):
        if d == end.axis:
            plane = (end.at - origin) / dx - 0.5
            sites = np.floor([plane + TOLERANCE]) if end.sign > 0 else np.ceil([plane - TOLERANCE])
        else:
            sites = np.arange(*sites_between(lower[d], upper[d], origin, dx))
        axes.append(origin + dx * (sites + 0.5))
    return np.moveaxis(np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1), rising, 0)


def _joined(seeds: np.ndarray, free: np.ndarray) -> np.ndarray:
    """The sites that are ``free`` and reached from the ``seeds`` through such sites, from neighbour to
    neighbour along axes."""
    found, count = seeds & free, -1
    while count != (count := int(np.count_nonzero(found))):
        for axis in range(found.ndim):
            one, other = np.moveaxis(found, axis, 0), np.moveaxis(free, axis, 0)
            for row in range(1, len(one)):
                one[row] |= one[row - 1] & other[row]
            for row in range(len(one) - 2, -1, -1):
                one[row] |= one[row + 1] & other[row]
    return found
