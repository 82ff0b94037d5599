"""Particles in the order of levels and of the cells that they are in, by the keys of these."""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import compiled
from psph.particles.level_ranges import ALL, AXES, BITS, FARTHEST

MOST = 4
"""Cells a particle, of the box around a level, up to which they are counted; else their keys are sorted."""


class Ordered(NamedTuple):
    """Particles by level, cell and column: their ``columns`` (n,); the ``keys`` (cells,) of cells that hold
    any, ``starts`` (cells + 1,) the first of each; ``base`` (levels + 1,) the first cells of levels, and
    ``box`` (levels, 2, 3) their lowest and highest numbers along each axis.

    Where cells of a level were counted they are numbered from ``first`` (levels,) on in its box, one line
    behind another, and ``begun`` tells how many particles are before each; else ``first`` is −1.
    """

    columns: np.ndarray
    keys: np.ndarray
    starts: np.ndarray
    base: np.ndarray
    box: np.ndarray
    first: np.ndarray
    begun: np.ndarray


def in_cells(key: np.ndarray, of: np.ndarray, levels: int) -> Ordered:
    """All columns, whose cells have such a ``key`` (n,), and which are ``of`` one (n,) of so many levels."""
    ends = np.zeros((levels, 2, AXES), np.int64)
    ends[:, 0] = ALL
    find_ends(key, of, ends)
    sides = ends[:, 1] - ends[:, 0] + 1
    rooms, number = sides.prod(axis=1, dtype=float), np.empty(len(key), np.int64)
    sparse = rooms > MOST * np.bincount(of, minlength=levels)
    for level in np.flatnonzero(sparse):
        those = np.flatnonzero(of == level)
        cells, number[those] = np.unique(key[those], return_inverse=True)
        rooms[level] = len(cells)
    first = np.append(0, np.cumsum(rooms.astype(np.int64)))
    number_in_boxes(key, of, ends[:, 0], sides, sparse, first, number)
    begun, columns = np.zeros(first[-1] + 2, np.int64), np.empty(len(key), np.int64)
    count_cells(number, begun[1:], columns)
    begun = begun[:-1]
    held = np.flatnonzero(np.diff(begun))
    starts = np.append(begun[held], len(key))
    keys, base = key[columns[starts[:-1]]], np.searchsorted(held, first)
    return Ordered(columns, keys, starts, base, ends - FARTHEST, np.where(sparse, -1, first[:-1]), begun)


@compiled
def find_ends(key, of, ends):
    """The lowest and the highest number of a cell along each axis, of each level (levels, 2, 3)."""
    for a in range(AXES):
        shift, k = np.uint64(BITS * (AXES - 1 - a)), np.uint64(0)
        while k < np.uint64(len(key)):
            # Particles of a level come many at once: what stands in registers need not be read again.
            level = of[k]
            lowest, highest = ends[level, 0, a], ends[level, 1, a]
            while k < np.uint64(len(key)) and of[k] == level:
                cell = key[k] >> shift & ALL
                lowest, highest = min(lowest, cell), max(highest, cell)
                k += np.uint64(1)
            ends[level, 0, a], ends[level, 1, a] = lowest, highest


@compiled
def number_in_boxes(key, of, low, sides, sparse, first, number):
    """The ``number`` of each particle's cell (n,): from the ``first`` of its level on, in a box of cells with
    so many along its ``sides`` (levels, 3) from ``low`` (levels, 3) on; where a level is ``sparse`` each has
    one there already."""
    for k in range(len(key)):
        level, found = of[k], np.int64(0)
        for a in range(AXES):
            cell = key[k] >> BITS * (AXES - 1 - a) & ALL
            found = found * sides[level, a] + cell - low[level, a]
        number[k] = first[level] + (number[k] if sparse[level] else found)


@compiled
def count_cells(number, starts, columns):
    """Write columns in the order of the ``number`` of their cells, those of one as they come; ``starts``
    (cells + 1,), zeros at first, become where each cell ends."""
    for k in range(len(number)):
        starts[number[k] + 1] += 1
    for cell in range(1, len(starts)):
        starts[cell] += starts[cell - 1]
    for k in range(len(number)):
        columns[starts[number[k]]] = k
        starts[number[k]] += 1
