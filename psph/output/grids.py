"""Fields of the fluid at the points of a grid or a plane, by sums over particles that are right for straight
fields."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from psph.errors import Refused
from psph.fields import BUFFER, FLUID, GAS
from psph.output.interpolation import folded
from psph.output.sizes import LENGTH

IN_FLUID = 0.5
"""Share of what walls leave of the kernel in the fluid from which on a point counts as within it, as for a
level (psph.output.gauges.level)."""

BESIDE = 0.05
"""Supports of the kernel by which a wall may be nearer to a point than the fluid: on a face both are as
far."""

LEAST_LEFT = 1.0 / 16.0
"""Share of the kernel that walls leave at least."""

STRAIGHT = 1e-4
"""Least over largest singular value of the moments from which on particles tell a slope."""

ENTRIES = 4096
"""Of the table of the kernel's weights."""

AT_ONCE = 1 << 13
"""Points that are processed together."""

MOST = 50_000_000
"""Points of a grid."""


class GridPoints(NamedTuple):
    """The points of a grid along the axes, ``step`` m apart from ``origin`` (3,) on, ``counts`` (3,) of them;
    a plane has one along an axis, in 2D and 1D the axes that are missing do."""

    origin: tuple[float, ...]
    step: float
    counts: tuple[int, ...]

    @classmethod
    def over(cls, lower, upper, step: float, plane: tuple[int, float] | None) -> "GridPoints":
        """Those from the corner ``lower`` to ``upper`` (dim,), m, or of them those on a ``plane``: an axis
        and the place there, m.  Refused where there are none, or too many."""
        pairs = [(a, b) for a, b in zip(lower, upper)]
        if plane is not None:
            pairs[plane[0]] = (plane[1], plane[1])
        if not step > 0.0 or any(b < a for a, b in pairs):
            raise Refused(f"measure --grid: no points from {lower} to {upper} m {step:g} m apart")
        counts = [1 + int((b - a) / step * (1.0 + 1e-12) + 1e-9) for a, b in pairs]
        more = 3 - len(pairs)
        found = cls((*(a for a, _ in pairs), *[0.0] * more), step, (*counts, *[1] * more))
        if np.prod(found.counts, dtype=float) > MOST:
            raise Refused(f"measure --grid: {np.prod(counts, dtype=float):,.0f} points; give a larger --step")
        return found

    def axes(self, dimensions: int) -> list[np.ndarray]:
        """Coordinates along each axis, m."""
        starts = zip(self.origin[:dimensions], self.counts)
        return [start + self.step * np.arange(count) for start, count in starts]

    def places(self, dimensions: int) -> np.ndarray:
        """All points (n, dim), m, the last axis fastest."""
        grid = np.meshgrid(*self.axes(dimensions), indexing="ij")
        return np.column_stack([x.ravel() for x in grid])


class Cloud(NamedTuple):
    """Particles: places (n, dim), m, volumes V (n,), and how many times as ``wide`` as the kernel each is
    spread, (n,) where sizes differ."""

    position: np.ndarray
    volume: np.ndarray
    wide: np.ndarray | float = 1.0


class Weighing(NamedTuple):
    """Where particles are: a ``kernel``, and a domain's ``lower`` corner, m, and ``periods``, m or None."""

    kernel: Any
    lower: Sequence[float]
    periods: Sequence[float | None]


def at_points(
    fluid: Cloud, walls: Cloud, around: Weighing, values: Mapping[str, np.ndarray], places: np.ndarray
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Fields at ``places`` (n, dim), m, of their ``values`` at particles of the ``fluid``, and its
    share S of what the ``walls``, all that does not flow, leave of the kernel.

    At each place a + G·(x − x₀) is fitted to the particles with the weights V W, W by the size of each: the
    kernel's sums with their first moments corrected (Shepard 1968; Belytschko and others 1996, Comput.
    Methods Appl. Mech. Eng. 139, 3): a constant and a straight field come out as they are, up to walls and
    the surface too.  Where
    particles tell no slope it is their mean, Σ V W f/Σ V W.  S = Σ V W/(1 − Σ_w V_w W); where it is less than
    ½ a place is beyond the surface, and where a wall is nearer than the fluid it is in the wall: there is
    NaN.
    """
    lengths = np.array([period or 0.0 for period in around.periods])
    kernel, start = around.kernel, np.array(around.lower)
    radius = kernel.support / kernel.inverse_h
    r = np.linspace(0.0, radius, ENTRIES)
    table = r, np.array([kernel.w(one) for one in r.tolist()])
    bands = [_Bands(one, folded(one.position - start, lengths), lengths, radius) for one in (fluid, walls)]
    share = np.zeros(len(places))
    found = {name: np.full((len(places), *rows.shape[1:]), np.nan) for name, rows in values.items()}
    rows = {name: one.reshape(len(one), int(np.prod(one.shape[1:]))) for name, one in values.items()}
    for first in range(0, len(places), AT_ONCE):
        some = slice(first, first + AT_ONCE)
        at = folded(places[some] - start, lengths)
        near, beside = (_Near(one, at, table) for one in bands)
        left = np.maximum(1.0 - beside.moments[:, 0, 0], LEAST_LEFT)
        share[some] = near.moments[:, 0, 0] / left
        within = (share[some] >= IN_FLUID) & (near.nearest <= beside.nearest + BESIDE * radius)
        for name, one in rows.items():
            fitted = near.fitted(one)
            fitted[~within] = np.nan
            found[name][some] = fitted.reshape(found[name][some].shape)
    return found, share


class _Bands:
    """The particles of a ``cloud`` at ``position`` by size, one band twice as wide as the one before: each is
    searched as far as its widest reach, ``radius`` times how wide they are."""

    def __init__(self, cloud: Cloud, position: np.ndarray, lengths: np.ndarray, radius: float):
        self.position, self.volume, self.lengths, self.radius = position, cloud.volume, lengths, radius
        self.wide = np.broadcast_to(np.asarray(cloud.wide, float), len(position))
        level = np.floor(np.log2(self.wide))
        self._rows = [np.flatnonzero(level == one) for one in np.unique(level)]
        self._trees = [cKDTree(position[rows], boxsize=lengths) for rows in self._rows]

    def pairs(self, places: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The numbers of places (n, dim) and of particles that reach them, and the distances, m."""
        asking, found = cKDTree(places, boxsize=self.lengths), []
        for rows, tree in zip(self._rows, self._trees):
            reach = self.radius * self.wide[rows]
            near = asking.sparse_distance_matrix(tree, float(reach.max()), output_type="ndarray")
            near = near[near["v"] <= reach[near["j"]]]
            found.append((near["i"], rows[near["j"]], near["v"]))
        if not found:
            return np.zeros(0, np.intp), np.zeros(0, np.intp), np.zeros(0)
        place, particle, distance = map(np.concatenate, zip(*found))
        return place, particle, distance


class _Near:
    """The particles near some places, with their weights and moments."""

    def __init__(self, bands: _Bands, places: np.ndarray, table):
        self.count, d = places.shape
        lengths, radius = bands.lengths, bands.radius
        self.place, self.particle, distance = bands.pairs(places)
        away = bands.position[self.particle] - places[self.place]
        away -= lengths * np.rint(away / np.where(lengths > 0.0, lengths, 1.0))
        self.nearest = np.full(self.count, np.inf)
        np.minimum.at(self.nearest, self.place, distance)
        wide = bands.wide[self.particle]
        self.weight = bands.volume[self.particle] * (np.interp(distance / wide, *table) / wide**d)
        total = self._sums(np.ones(len(wide)))
        scale = radius * self._sums(wide) / np.where(total > 0.0, total, 1.0)
        self.basis = np.column_stack([np.ones(len(away)), away / scale[self.place, None]])
        self.moments = np.empty((self.count, 1 + d, 1 + d))
        for a in range(1 + d):
            for b in range(a, 1 + d):
                sums = self._sums(self.basis[:, a] * self.basis[:, b])
                self.moments[:, a, b] = self.moments[:, b, a] = sums
        sizes = np.linalg.svd(self.moments, compute_uv=False)
        self.straight = sizes[:, -1] > STRAIGHT * np.maximum(sizes[:, 0], np.finfo(float).tiny)

    def fitted(self, rows: np.ndarray) -> np.ndarray:
        """The values (places, k) of those (n, k) of the particles; those without any are zero."""
        right = np.empty((self.count, self.basis.shape[1], rows.shape[1]))
        # Differences from one of the particles: a large constant would cost digits.
        base = rows.mean(axis=0) if len(rows) else np.zeros(rows.shape[1])
        near = rows[self.particle] - base
        for a in range(right.shape[1]):
            for k in range(right.shape[2]):
                right[:, a, k] = self._sums(self.basis[:, a] * near[:, k])
        total = self.moments[:, 0, 0, None]
        found = right[:, 0] / np.where(total > 0.0, total, 1.0)
        if self.straight.any():
            found[self.straight] = np.linalg.solve(self.moments[self.straight], right[self.straight])[:, 0]
        return found + base

    def _sums(self, terms: np.ndarray) -> np.ndarray:
        return np.bincount(self.place, self.weight * terms, self.count)


def clouds(
    frame: Mapping[str, np.ndarray], materials, counting: np.ndarray, smoothing_length: float
) -> tuple[Cloud, Cloud, np.ndarray]:
    """The particles of a frame that flow, of the groups that are ``counting`` (groups,), and those that do
    not flow; and the rows of the first.  Of a gas each has its own size, ``smoothing_length`` is that of the
    kernel, m; of finer regions each has that of its level, and walls, which are there once for each level,
    count once, as the coarsest."""
    mass = frame["mass"] if "mass" in frame else materials.values("mass")[frame["group"]]
    volume = mass / frame["density"]
    flows = np.isin(frame["kind"], (FLUID, BUFFER, GAS))
    rows = np.flatnonzero(counting[frame["group"]] & (frame["kind"] != BUFFER) & flows)
    level = np.array([one.level for one in materials.species])[frame["group"]]
    still = ~flows & (level == 0)
    wide = frame[LENGTH][rows] / smoothing_length if LENGTH in frame else 0.5 ** level[rows]
    fluid = Cloud(frame["position"][rows], volume[rows], wide)
    return fluid, Cloud(frame["position"][still], volume[still]), rows
