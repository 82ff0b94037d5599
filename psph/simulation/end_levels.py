"""Rows behind an open end that a level fills and empties as it rises and falls."""

from dataclasses import dataclass

import numpy as np

from psph.engine.jit import elementwise
from psph.engine.settled import settled
from psph.formula import helper
from psph.physics.open_ends import follow
from psph.scene.end_rows import SurfaceRows
from psph.scene.ends import EndFace

HOLDS = 0.25
"""Spacings that a level has to be past the middle of a row before that fills or empties."""

TURNS = 0.01
"""Part of the speed of waves at which flow that has turned counts as such."""

APART = 0.7
"""Spacings from a strip across a face within which there is no room for another."""

ABOVE = 0.75
"""Spacings above the middle of the highest row from which a particle is of none."""

FEWEST_ROWS = 4.0
"""Rows over whose height a level is smoothed at least."""


@dataclass
class EndLevel:
    """The level behind an end: how many of its rows are ``full``, how many sites the fluid in front fills,
    smoothed over time, None before there is any; whether fluid ``comes_in``; whether rows are still to be
    filled or emptied, and all anew since the flow has ``turned``."""

    full: int
    count: float | None = None
    comes_in: bool = True
    unfilled: bool = False
    turned: bool = False

    def level(self, rows: SurfaceRows) -> float:
        """Of the fluid in front, else that of the rows, m."""
        full = float(rows.counts[: self.full].sum())
        return rows.level_of(full if self.count is None else self.count)

    def see(self, face: EndFace, count: float, speed: float, sound_speed: float, dt: float) -> None:
        """``count`` sites in front of the plane are full now, and fluid comes in at a mean ``speed``, m/s."""
        lag = 2.0 * max(face.height, FEWEST_ROWS * face.spacing) / sound_speed
        if count:
            self.count = count if self.count is None else follow(self.count, count, dt, lag)
        if not self.comes_in and speed > TURNS * face.wave_speed:
            self.comes_in = self.unfilled = self.turned = True
        elif self.comes_in and speed < -TURNS * face.wave_speed:
            self.comes_in = self.turned = False

    def settle(self, rows: SurfaceRows, level: float, dx: float) -> None:
        """Rows that a ``level`` in m fills, or that of the fluid in front where it is no number."""
        full = rows_full(rows, self.full, level if level == level else self.level(rows), dx)
        self.unfilled |= full != self.full
        self.full = full


def rows_full(rows: SurfaceRows, full: int, level: float, dx: float) -> int:
    """How many rows a ``level`` in m fills where ``full`` were full before."""
    while full < len(rows.heights) and level > rows.heights[full] + HOLDS * dx:
        full += 1
    while full and level < rows.heights[full - 1] - HOLDS * dx:
        full -= 1
    return full


def fit_rows(
    face: EndFace,
    place: float,
    full: int,
    depth: np.ndarray,
    across: np.ndarray,
    periods: np.ndarray,
    standing: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Who is too many behind a face at a ``place``, m, of which ``full`` rows are to be full (n,), and the
    places (m, dim), m, at which someone lacks, row by row.

    Particles are at a ``depth`` (n,) m behind the plane and ``across`` (axes, n) m, with ``periods`` there, 0
    where it does not repeat; those ``standing`` (n,) count.
    """
    rows, dx = face.surface, face.spacing
    assert rows is not None
    axes = [d for d in range(len(rows.up)) if d != face.axis]
    height = across.T @ rows.up[axes] + face.at * rows.up[face.axis]
    above = standing & (height > (rows.heights[full - 1] + ABOVE * dx if full else -np.inf))
    sites = np.concatenate([*rows.sites[:full], np.zeros((0, len(rows.up)))])
    surplus, begins = np.zeros(len(depth), np.bool_), np.full(len(sites), np.nan)
    places, counted = np.ascontiguousarray(sites[:, axes]), standing & ~above
    strips = places, depth, across, periods, dx, face.layers, counted
    lacking = settled(fit_strips)(*strips, surplus, begins)
    return above | surplus, rows.behind(place, sites, begins, lacking)


@elementwise
def fit_strips(sites, depth, across, periods, dx, layers, standing, surplus, begins):
    """How many particles lack in the strip of each site (m, axes) across a face, (m,).

    The deepest beyond ``layers`` are in ``surplus`` (n,); those that lack stand at depths from ``begins``
    (m,) m on.  There is no room for a strip beside one that is nearer than APART.
    """
    lacking = np.zeros(len(sites), np.int64)
    for s in range(len(sites)):
        count, near, deepest = 0, False, 0.0
        for j in range(len(depth)):
            off = _off(sites, s, across, periods, j)
            near = near or (standing[j] and off < APART * dx)
            if standing[j] and off <= 0.5 * dx and not surplus[j]:
                count += 1
                deepest = max(deepest, depth[j])
        while count > layers:
            last = -1
            for j in range(len(depth)):
                inside = standing[j] and _off(sites, s, across, periods, j) <= 0.5 * dx
                if inside and not surplus[j] and (last < 0 or depth[j] > depth[last]):
                    last = j
            surplus[last] = True
            count -= 1
        if count or not near:
            lacking[s] = layers - count
            begins[s] = deepest + dx if count else 0.5 * dx
    return lacking


@helper
def _off(sites, s, across, periods, j):
    """How far j is from a site, m, along the axis where it is farthest."""
    off = 0.0
    for d in range(across.shape[0]):
        t = across[d, j] - sites[s, d]
        if periods[d] > 0.0:
            t -= periods[d] * np.rint(t / periods[d])
        off = max(off, abs(t))
    return off
