"""Verlet lists: for every owned particle the columns of all particles within the cutoff."""

from typing import NamedTuple

import numpy as np

from psph.jit import LANES, bits_below, compiled
from psph.particles.cells import Grid
from psph.particles.store import FAR
from psph.vectors import (
    add, add_to_each, at, columns_like, dot, lower, nearest_image, put, scale, subtract, upper
)

WIDTH = 8
"""A row is padded to a multiple of this with the dummy particle: the loop needs no remainder."""


PACKED = np.zeros((1 << LANES, LANES), np.uint32)
"""For each pattern of bits the numbers of those that are set, packed to the left."""
HOW_MANY = np.zeros(1 << LANES, np.uint64)
"""For each pattern of bits how many are set."""
for _bits in range(1 << LANES):
    _set = [t for t in range(LANES) if _bits >> t & 1]
    PACKED[_bits, : len(_set)] = _set
    HOW_MANY[_bits] = len(_set)


class Neighbours(NamedTuple):
    """Row k belongs to owned particle ``low + k``: ``lists[begin[k] : begin[k] + 8 blocks[k]]``."""

    begin: np.ndarray
    blocks: np.ndarray
    lists: np.ndarray


def empty(owned: int, entries: int) -> Neighbours:
    """Room for the rows of ``owned`` particles with ``entries`` neighbours in all."""
    return Neighbours(
        np.zeros(owned, np.uint64), np.zeros(owned, np.uint64), np.zeros(entries, np.uint32)
    )


def build(room: Neighbours, store, grid: Grid, starts, planes: int, cutoff: float, periods):
    """Lists of every owned particle, in the global order of cells, then ids.

    ``starts`` are the first columns of the cells of ``planes`` owned planes and one ghost plane
    on either side.  ``room`` is used again where it is large enough.
    """
    owned = store.owned
    if len(room.begin) < owned:
        room = empty(owned + owned // 16, max(len(room.lists), 64 * owned + 1024))
    while True:
        needed = fill_lists(
            store["position"], periods, cutoff * cutoff, grid.counts, grid.periodic, grid.reach,
            starts, planes, store.low, store.total, room.begin, room.blocks, room.lists,
        )
        if needed == 0:
            return room
        room = room._replace(lists=np.zeros(needed + needed // 8, np.uint32))


@compiled
def fill_lists(
    position, periods, cutoff2, counts, periodic, reach, starts, planes, low, dummy,
    begin, blocks, lists,
):
    """Fill the rows; returns 0, or about how many entries are needed when they do not fit.

    The candidates of a cell are copied once into one contiguous block, as their nearest images,
    eight to a group; each particle of the cell then meets them without gathers.
    """
    rows, columns = counts[1], counts[2]
    from_k = np.empty(18, np.uint64)
    to_k = np.empty(18, np.uint64)
    near = columns_like(position, 512)
    squares = np.empty(512)
    columns_of = np.empty(64, np.uint32)
    capacity = len(lists) - WIDTH
    end = np.uint64(0)
    for plane in range(1, planes + 1):
        for row in range(rows):
            for column in range(columns):
                cell = (plane * rows + row) * columns + column
                if starts[cell] == starts[cell + 1]:
                    continue
                ranges, candidates = candidate_ranges(
                    plane, row, column, rows, columns, periodic, reach, starts, from_k, to_k
                )
                if candidates > len(squares):
                    near = columns_like(position, 2 * candidates)
                    squares = np.empty(2 * candidates)
                    columns_of = np.empty(candidates // 4, np.uint32)
                x_0 = middle(position, starts[cell], starts[cell + 1])
                copy_candidates(position, periods, x_0, ranges, from_k, to_k, near, columns_of)
                own = place_in_block(starts[cell], ranges, from_k, to_k)
                for i in range(np.uint64(starts[cell]), np.uint64(starts[cell + 1])):
                    if np.int64(end) + candidates > capacity:
                        done = max(np.int64(i) - low, 1)
                        total = starts[(planes + 1) * rows * columns] - low
                        return np.int64(end) * total // done + candidates + 1024
                    measure(near, subtract(at(position, i), x_0), candidates, squares)
                    squares[own + i - np.uint64(starts[cell])] = FAR  # not its own neighbour
                    first = end
                    for g in range(np.uint64(candidates // LANES)):
                        bits = bits_below(squares, g * np.uint64(LANES), cutoff2)
                        for t in range(LANES):  # all eight: those past the last are overwritten
                            lists[end + np.uint64(t)] = columns_of[g] + PACKED[bits, t]
                        end += HOW_MANY[bits]
                    while (end - first) % np.uint64(WIDTH) != np.uint64(0):
                        lists[end] = dummy
                        end += np.uint64(1)
                    begin[i - np.uint64(low)] = first
                    blocks[i - np.uint64(low)] = (end - first) // np.uint64(WIDTH)
    return np.int64(0)


@compiled
def middle(position, first, last):
    """Middle of the box around some particles: none is more than half a cell away."""
    low = high = at(position, np.uint64(first))
    for k in range(np.uint64(first), np.uint64(last)):
        low, high = lower(low, at(position, k)), upper(high, at(position, k))
    return scale(add(low, high), 0.5)


@compiled
def copy_candidates(position, periods, x_0, ranges, from_k, to_k, near, columns_of):
    """Nearest images of the candidates relative to ``x_0``, each range filled up to groups.

    ``columns_of`` receives the store's column of the first candidate of each group.
    """
    m = np.uint64(0)
    for q in range(ranges):
        for j in range(from_k[q], to_k[q]):
            if (j - from_k[q]) % np.uint64(LANES) == np.uint64(0):
                columns_of[m // np.uint64(LANES)] = j
            put(near, m, nearest_image(subtract(at(position, j), x_0), periods))
            m += np.uint64(1)
        while m % np.uint64(LANES) != np.uint64(0):
            put(near, m, add_to_each(x_0, FAR))
            m += np.uint64(1)


@compiled
def place_in_block(column, ranges, from_k, to_k):
    """Where a column of the store stands in the block of candidates."""
    m = np.uint64(0)
    for q in range(ranges):
        if from_k[q] <= np.uint64(column) < to_k[q]:
            return m + np.uint64(column) - from_k[q]
        m += grouped(to_k[q] - from_k[q])
    return m


@compiled
def grouped(n):
    """``n`` rounded up to whole groups."""
    lanes = np.uint64(LANES)
    return (n + lanes - np.uint64(1)) // lanes * lanes


@compiled
def measure(near, offset, candidates, squares):
    """Squared distances of the candidates from a particle at ``offset``, m²."""
    for m in range(np.uint64(candidates)):
        x_ij = subtract(offset, at(near, m))
        squares[m] = dot(x_ij, x_ij)


@compiled
def candidate_ranges(
    plane, row, column, rows, columns, periodic, reach, starts, from_k, to_k
):
    """Ranges of columns of the store that can hold neighbours of a cell's particles, in order."""
    n = 0
    candidates = 0
    for p in range(plane - 1, plane + 2):
        for r in range(row - 1, row + 2):
            inside = 0 <= r < rows
            if not inside and not periodic[1]:
                continue
            base = (p * rows + r % rows) * columns
            left, right = column - reach, column + reach + 1
            if left < 0 and periodic[2]:
                from_k[n], to_k[n] = starts[base + left + columns], starts[base + columns]
                candidates += np.int64(grouped(to_k[n] - from_k[n]))
                n += 1
            middle_left, middle_right = max(left, 0), min(right, columns)
            from_k[n], to_k[n] = starts[base + middle_left], starts[base + middle_right]
            candidates += np.int64(grouped(to_k[n] - from_k[n]))
            n += 1
            if right > columns and periodic[2]:
                from_k[n], to_k[n] = starts[base], starts[base + right - columns]
                candidates += np.int64(grouped(to_k[n] - from_k[n]))
                n += 1
    return n, candidates
