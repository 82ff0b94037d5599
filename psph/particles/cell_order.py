"""Particles in the order of the cells that they are in, by the keys of these."""

import numpy as np

from psph.engine.jit import compiled
from psph.particles.level_ranges import ALL, AXES, BITS

MOST = 4
"""Cells a particle, of the box around them all, up to which cells are counted; else keys are sorted."""


def by_key(key: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Columns, which rise, by their ``key``, and those of one key in their order."""
    own = key[columns]
    ends = cell_ends(own)
    sides = ends[1] - ends[0] + 1
    if np.prod(sides.astype(float)) <= MOST * len(own):
        found = np.empty(len(own), np.int64)
        count_cells(own, ends[0], sides, np.zeros(int(sides.prod()) + 1, np.int64), found)
        return columns[found]
    # What keeps the order of equals takes five times as long; there are few in a cell.
    found = np.argsort(own)
    order_equals(own[found], found)
    return columns[found]


@compiled
def cell_ends(key):
    """The lowest and the highest number of a cell along each axis (2, 3)."""
    found = np.zeros((2, AXES), np.int64)
    found[0] = ALL
    for k in range(len(key)):
        for a in range(AXES):
            cell = key[k] >> BITS * (AXES - 1 - a) & ALL
            found[0, a], found[1, a] = min(found[0, a], cell), max(found[1, a], cell)
    return found


@compiled
def cell_in_box(key, low, sides):
    """The number of a cell in a box of cells with so many along its ``sides`` (3,), from ``low`` (3,) on."""
    found = 0
    for a in range(AXES):
        found = found * sides[a] + (key >> BITS * (AXES - 1 - a) & ALL) - low[a]
    return found


@compiled
def count_cells(key, low, sides, starts, found):
    """Write to ``found`` the order of entries by their ``key``, equals as they come; ``starts`` (cells + 1,)
    has zeros."""
    for k in range(len(key)):
        starts[cell_in_box(key[k], low, sides) + 1] += 1
    for cell in range(1, len(starts)):
        starts[cell] += starts[cell - 1]
    for k in range(len(key)):
        cell = cell_in_box(key[k], low, sides)
        found[starts[cell]] = k
        starts[cell] += 1


@compiled
def order_equals(key, found):
    """Let the entries of ``found`` rise where their ``key``, in order, is the same."""
    for k in range(1, len(key)):
        own, m = found[k], k
        while m > 0 and key[m - 1] == key[k] and found[m - 1] > own:
            found[m] = found[m - 1]
            m -= 1
        found[m] = own
