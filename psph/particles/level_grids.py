"""Grids of cells, one for each level of sizes, each twice as coarse as the one before."""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import elementwise
from psph.particles.cell_order import in_cells
from psph.particles.lanes import LANES
from psph.particles.level_ranges import AXES, BITS, FARTHEST, WIDER

CELLS_A_REACH = {1: 1.0, 2: 0.75, 3: 1.25}
"""By dimension, how many cells are as wide as the particles of a level reach at the most: of 0.5, 0.75, 1,
1.25 and 1.5 the quickest."""


class Slab(NamedTuple):
    """The slab of a rank along ``axis``: its ``lower`` and ``upper`` edge, m; ``low`` ghosts, ``owned``
    particles and ``high`` ghosts in its columns; the ``periods`` in m, None for an open axis; the lower
    corner of the domain, ``origin`` (dim,), and the largest reach of all particles, ``cutoff``, m."""

    axis: int
    lower: float
    upper: float
    low: int
    owned: int
    high: int
    periods: tuple
    origin: tuple
    cutoff: float


class Grids(NamedTuple):
    """The grids of all levels, one after the other.

    ``columns`` (n,) are those of the particles by level, cell and column; ``seen`` (3, n) where they are seen
    from the slab, m, ``position`` the components of where they are, m, and ``within2`` (n,) the squares of
    how far they reach, m².  ``keys`` (cells,) are the cells that hold particles, ``starts`` (cells + 1,) the
    first of each, and ``base`` (levels + 1,) the first cells of levels.  ``inverse`` (levels, 3) is how many
    cells a metre has from the ``origin`` (3,) on; ``counts`` (levels, 3) after how many cells an axis goes
    round, 0 where it does not.  ``box`` (levels, 2, 3) are the lowest and the highest cells of each level
    along each axis, ``first`` (levels,) and ``begun`` their numbers and the particles before each
    (psph.particles.cell_order), ``reach`` (levels,) the largest in each, m; ``periods`` in m or None.
    Behind the last of ``columns``, ``position`` and ``within2`` there is a register to be read.
    """

    columns: np.ndarray
    seen: np.ndarray
    position: tuple
    within2: np.ndarray
    keys: np.ndarray
    starts: np.ndarray
    base: np.ndarray
    inverse: np.ndarray
    origin: np.ndarray
    counts: np.ndarray
    box: np.ndarray
    first: np.ndarray
    begun: np.ndarray
    reach: np.ndarray
    periods: tuple


def grids_of(position: list[np.ndarray], reach: np.ndarray, slab: Slab) -> Grids:
    """The levels of particles at these places."""
    first = AXES - len(position)
    levels, of = _levels_of(reach, slab.cutoff)
    counts, inverse = np.zeros((len(levels), AXES), np.int64), np.zeros((len(levels), AXES))
    origin, nobody, moved = np.zeros(AXES), np.zeros(len(reach), np.int64), None
    key = np.full(len(reach), sum(FARTHEST << BITS * (AXES - 1 - a) for a in range(first)), np.int64)
    for d, (x, period) in enumerate(zip(position, slab.periods)):
        a, wide, beyond = first + d, slab.cutoff * 0.5**levels / CELLS_A_REACH[len(position)], nobody
        origin[a] = slab.origin[d]
        if period:
            counts[:, a] = np.ceil(period / wide)  # narrower: no two images of one are candidates
        inverse[:, a] = counts[:, a] / period if period else 1.0 / wide
        if period and d == slab.axis:
            beyond = _beyond(x, period, slab)
            moved = beyond * period
        add_cells(x, of, origin[a], inverse[:, a], counts[:, a], beyond, BITS * (AXES - 1 - a), key)
        if moved is not None and d == slab.axis:
            counts[:, a] = 0  # ghosts stand where they are seen: it does not go round
    cells = in_cells(key, of, len(levels))
    placed, within = [_taken(x, cells.columns) for x in position], _taken(reach, cells.columns)
    seen = np.zeros((AXES, len(reach)))
    seen[first:] = [x[: len(reach)] for x in placed]
    if moved is not None:
        seen[first + slab.axis] += moved[cells.columns]
    columns = _taken(np.arange(len(reach), dtype=np.uint32), cells.columns)
    farthest = np.maximum.reduceat(within, cells.starts[cells.base[:-1]])
    held = cells.keys, cells.starts, cells.base, inverse, origin, counts
    told = cells.box, cells.first, cells.begun, farthest, tuple(slab.periods)
    return Grids(columns, seen, tuple(placed), within**2, *held, *told)


def _levels_of(reach: np.ndarray, cutoff: float) -> tuple[np.ndarray, np.ndarray]:
    """How often the ``cutoff`` can be halved so that no particle of a level reaches farther, for all levels
    that there are, and the number of each particle's level among these (n,)."""
    level = np.frexp(cutoff * WIDER / reach)[1].astype(np.int64) - 1
    lowest = level.min()
    there = np.bincount(level - lowest) > 0
    return lowest + np.flatnonzero(there), (np.cumsum(there) - 1)[level - lowest]


@elementwise
def add_cells(x, of, origin, inverse, counts, beyond, shift, key):
    """Add to the ``key`` of particles at ``x`` the number of the cell that each is in along an axis, by so
    many bits; it goes round after ``counts`` (levels,), and who is seen ``beyond`` a period stands beyond."""
    for k in range(len(x)):
        place, count = (x[k] - origin) * inverse[of[k]], counts[of[k]]
        # Comparisons that no NaN passes: it must become the number of some cell.
        place = place if place > -FARTHEST else float(-FARTHEST)
        cell = np.int64(np.floor(place if place < FARTHEST else float(FARTHEST)))
        cell = min(max(cell, 0), count - 1) + beyond[k] * count if count > 0 else cell
        key[k] |= (min(max(cell, -FARTHEST), FARTHEST) + FARTHEST) << shift


def _beyond(x: np.ndarray, period: float, slab: Slab) -> np.ndarray:
    """By how many periods each column is seen beyond its place: 0 but for ghosts."""
    found = np.zeros(len(x), np.int64)
    sides = (slice(0, slab.low), slab.lower), (slice(len(x) - slab.high, len(x)), slab.upper)
    for ghosts, edge in sides:
        found[ghosts] = -np.rint((x[ghosts] - edge) / period)
    return found


def _taken(values: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """The values of these columns, and as many zeros as a register reads behind the last."""
    found = np.zeros(len(columns) + LANES, values.dtype)
    np.take(values, columns, out=found[: len(columns)], mode="clip")  # without a copy between, as "raise" has
    return found
