"""Rows behind an open end that a level fills and empties as it rises and falls."""

from dataclasses import dataclass

import numpy as np

from psph.engine.jit import elementwise
from psph.engine.settled import settled
from psph.physics.open_ends import follow
from psph.scene.end_rows import Rows
from psph.scene.ends import EndFace

HOLDS = 0.25
"""Spacings that a level has to be past the middle of a row before that fills or empties."""

APART = 0.7
"""Spacings between strips across a face, below which there is no room for another between them."""

ABOVE = 0.75
"""Spacings above the middle of the highest row from which a particle is of none."""

FEWEST_ROWS = 4.0
"""Rows over whose height a level is smoothed at least."""


@dataclass
class Surface:
    """The level behind an end: how many of its rows are ``full``, how many sites the fluid in front fills,
    smoothed over time, None before there is any; whether fluid ``comes_in``; whether rows are still to be
    filled or emptied."""

    full: int
    count: float | None = None
    comes_in: bool = False
    unfilled: bool = False

    def level(self, rows: Rows) -> float:
        """Of the fluid in front, else that of the rows, m."""
        full = float(rows.counts[: self.full].sum())
        return rows.level_of(full if self.count is None else self.count)

    def see(self, face: EndFace, count: float, comes_in: bool, sound_speed: float, dt: float) -> None:
        """``count`` sites in front of the plane are full now, and fluid comes in or not."""
        lag = 2.0 * max(face.height, FEWEST_ROWS * face.spacing) / sound_speed
        if count:
            self.count = count if self.count is None else follow(self.count, count, dt, lag)
        self.unfilled |= comes_in and not self.comes_in
        self.comes_in = comes_in

    def settle(self, rows: Rows, level: float, dx: float) -> None:
        """Rows that a ``level`` in m fills, or that of the fluid in front where it is no number."""
        full = rows_full(rows, self.full, level if level == level else self.level(rows), dx)
        self.unfilled |= full != self.full
        self.full = full


def rows_full(rows: Rows, full: int, level: float, dx: float) -> int:
    """How many rows a ``level`` in m fills where ``full`` were full before."""
    while full < len(rows.heights) and level > rows.heights[full] + HOLDS * dx:
        full += 1
    while full and level < rows.heights[full - 1] - HOLDS * dx:
        full -= 1
    return full


def fit_rows(
    face: EndFace, full: int, across: np.ndarray, periods: np.ndarray, standing: np.ndarray, up: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Who is above the rows behind a face of which ``full`` are to be full (n,), and the places (m, dim), m,
    that are empty in them, row by row.

    Particles are ``across`` (axes, n) m, with ``periods`` there, 0 where it does not repeat; ``standing``
    (n,) behind the plane or not; ``up`` (dim,) is the direction of levels.
    """
    rows, dx = face.surface, face.spacing
    assert rows is not None
    axes = [d for d in range(len(up)) if d != face.axis]
    height = across.T @ up[axes] + face.at * up[face.axis]
    above = standing & (height > (rows.heights[full - 1] + ABOVE * dx if full else -np.inf))
    sites = np.concatenate([*rows.sites[:full], np.zeros((0, len(up)))])
    empty = np.zeros(len(sites), np.bool_)
    among = np.ascontiguousarray(across[:, standing & ~above])
    settled(find_empty)(np.ascontiguousarray(sites[:, axes]), among, periods, APART * dx, empty)
    return above, rows.behind(sites[empty])


@elementwise
def find_empty(sites, across, periods, near, empty):
    """True in ``empty`` (m,) where no particle ``across`` (axes, n) is ``near``, m, a site (m, axes) along
    each axis."""
    for s in range(len(sites)):
        empty[s] = True
        for j in range(across.shape[1]):
            far = False
            for d in range(across.shape[0]):
                t = across[d, j] - sites[s, d]
                if periods[d] > 0.0:
                    t -= periods[d] * np.rint(t / periods[d])
                far = far or abs(t) >= near
            if not far:
                empty[s] = False
                break
