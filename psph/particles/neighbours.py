"""Verlet lists: for every owned particle the columns of all particles within the cutoff."""

from typing import NamedTuple

import numpy as np

from psph.jit import compiled
from psph.particles.cells import Grid
from psph.vectors import (
    add, at, columns_like, dot, lower, nearest_image, put, scale, subtract, upper
)

WIDTH = 8
"""A row is padded to a multiple of this with the dummy particle: the loop needs no remainder."""


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

    The candidates of a cell are copied once into one contiguous block, as their nearest images;
    each particle of the cell then meets them without gathers.
    """
    rows, columns = counts[1], counts[2]
    from_k = np.empty(18, np.uint64)
    to_k = np.empty(18, np.uint64)
    near = columns_like(position, 256)
    column_of = np.empty(256, np.uint32)
    hit = np.empty(256, np.uint32)
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
                if candidates > len(hit):
                    near = columns_like(position, 2 * candidates)
                    column_of = np.empty(2 * candidates, np.uint32)
                    hit = np.empty(2 * candidates, np.uint32)
                x_0 = middle(position, starts[cell], starts[cell + 1])
                copy_candidates(position, periods, x_0, ranges, from_k, to_k, near, column_of)
                for i in range(np.uint64(starts[cell]), np.uint64(starts[cell + 1])):
                    if np.int64(end) + candidates > capacity:
                        done = max(np.int64(i) - low, 1)
                        total = starts[(planes + 1) * rows * columns] - low
                        return np.int64(end) * total // done + candidates + 1024
                    mark_near(near, subtract(at(position, i), x_0), cutoff2, candidates, hit)
                    first = end
                    for m in range(np.uint64(candidates)):
                        lists[end] = column_of[m]
                        end += np.uint64(hit[m] & (column_of[m] != np.uint32(i)))
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
def copy_candidates(position, periods, x_0, ranges, from_k, to_k, near, column_of):
    """Positions of the candidates' nearest images relative to ``x_0``, and their columns."""
    m = np.uint64(0)
    for q in range(ranges):
        for j in range(from_k[q], to_k[q]):
            put(near, m, nearest_image(subtract(at(position, j), x_0), periods))
            column_of[m] = j
            m += np.uint64(1)


@compiled
def mark_near(near, offset, cutoff2, candidates, hit):
    """Mark those candidates that lie within the cutoff of a particle at ``offset``."""
    for m in range(np.uint64(candidates)):
        x_ij = subtract(offset, at(near, m))
        hit[m] = dot(x_ij, x_ij) < cutoff2


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
                candidates += np.int64(to_k[n] - from_k[n])
                n += 1
            middle_left, middle_right = max(left, 0), min(right, columns)
            from_k[n], to_k[n] = starts[base + middle_left], starts[base + middle_right]
            candidates += np.int64(to_k[n] - from_k[n])
            n += 1
            if right > columns and periodic[2]:
                from_k[n], to_k[n] = starts[base], starts[base + right - columns]
                candidates += np.int64(to_k[n] - from_k[n])
                n += 1
    return n, candidates
