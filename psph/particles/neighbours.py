"""Verlet lists: for every owned particle the columns of all particles within the cutoff."""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import compiled
from psph.engine.simd import AHEAD
from psph.engine.threads import in_threads
from psph.particles.cells import Grid
from psph.particles.lanes import LANES, append_near, near_bits
from psph.particles.store import SPARE
from psph.vectors import at

ROUNDING = 1e-6
"""Relative error of a distance in single precision, generously."""


ROOM = 16
"""Room behind the entries of lists, as a part of these, for rows of each particle by itself: a row has more
entries."""


class Neighbours(NamedTuple):
    """Row k belongs to owned particle ``low + k``: ``lists[begin[k] : begin[k] + lengths[k]]``.

    Behind it the particle itself fills the last register of the row up.
    """

    begin: np.ndarray
    lengths: np.ndarray
    lists: np.ndarray


class Near(NamedTuple):
    """What makes two particles neighbours: their positions in single precision, m, the periods of the
    axes, m, and the square of the cutoff, m²."""

    position: tuple
    periods: tuple
    cutoff2: float


def empty(owned: int, entries: int) -> Neighbours:
    """Room for the rows of ``owned`` particles with ``entries`` neighbours in all."""
    return Neighbours(np.zeros(owned, np.uint64), np.zeros(owned, np.uint32), entries_for(entries))


def entries_for(count: int) -> np.ndarray:
    """Zeros, and behind them as many as the pair loop looks ahead, and room that takes no memory until
    somebody writes there (psph.composition.mirrors)."""
    return np.zeros(count + count // ROOM + AHEAD, np.uint32)[:count]


def build(
    room: Neighbours,
    store,
    grid: Grid,
    starts,
    planes: int,
    cutoff: float,
    periods,
    lanes: int,
    sought,
    fill,
):
    """Lists of every owned particle, in the global order of cells, then ids.

    ``starts`` are the first columns of the cells of ``planes`` owned planes and one ghost plane
    on either side.  ``room`` is used again where it is large enough.  Rows are filled up to a
    multiple of ``lanes``.  Where ``sought`` is given (columns,) a row stays empty that has no column above 0
    in the cells around.  ``fill`` is :func:`fill_lists`, or one that is settled.
    """
    owned, first = store.owned, int(starts[0])
    before = np.zeros(0 if sought is None else store.total - first + 1, np.int64)
    if sought is not None:
        np.cumsum(sought[first : store.total] > 0.0, out=before[1:])
    position, cutoff = in_single_precision(store, grid, first, cutoff)
    # The guess of entries need not be right; the same lists come of any.
    if len(room.begin) < owned:
        room = empty(owned + owned // SPARE, max(len(room.lists), 64 * owned + 1024))
    near = Near(position, periods, cutoff * cutoff)
    # How many entries there are is known once they are written: too little room, and all is done again.
    while True:
        parts = in_threads(fill, 1, planes + 1, near, grid, starts, store.low, owned, lanes, before, room)
        needed = max(parts)
        if needed == 0:
            return room
        room = room._replace(lists=entries_for(needed + needed // SPARE))


def in_single_precision(store, grid: Grid, first: int, cutoff: float):
    """Positions relative to the grid, rounded, and a cutoff that loses no neighbour by it.

    Twice as many fit into a register.  The lists may name a few particles just outside the cutoff:
    harmless, and the same ones on any number of ranks.
    """
    arrays = store["position"]
    lower = dict(zip(grid.axes, grid.lower))
    near = [np.zeros(store.total + LANES, np.float32) for _ in arrays]
    used = slice(first, store.total)
    for d, (x, rounded) in enumerate(zip(arrays, near)):
        np.subtract(x[used], lower[d], out=rounded[used], casting="same_kind")
    # From the grid, since the cutoff must be the same on every rank.
    extent = max(n / per_metre for n, per_metre in zip(grid.along_axes, grid.inverse))
    rounding = len(arrays) * 2.0 * extent * np.finfo(np.float32).eps
    return tuple(near), cutoff * (1.0 + ROUNDING) + rounding


@compiled
def fill_lists(first_plane, last_plane, near, grid, starts, low, owned, multiple, sought, room):
    """Fill the rows of some planes; returns 0, or about how many entries are needed for all.

    Planes take the part of the lists that is their part of the ``owned`` particles.
    The candidates of a cell are a few ranges of columns, eight to a group; all eight are compared at
    once, and a table packs those that are near.  ``sought`` counts, before each column from the first
    on, those of which a row must have one in its cells around; it is empty where all rows are filled.
    """
    begin, lengths, lists = room.begin, room.lengths, room.lists
    rows, columns = grid.counts[1], grid.counts[2]
    from_k = np.empty(18, np.uint64)
    to_k = np.empty(18, np.uint64)
    column_of = np.empty(64, np.uint32)
    valid = np.empty(64, np.uint64)
    line = rows * columns
    before = starts[first_plane * line] - low
    here = starts[last_plane * line] - low - before
    # A group is written whole: between two parts lies room for it.
    each = max(len(lists) - 2 * LANES * (len(starts) // line), 0) / max(owned, 1)
    begun = np.int64(each * before) + 2 * LANES * (first_plane - 1)
    capacity = begun + np.int64(each * here)
    one = np.uint64(1)
    end = np.uint64(begun)
    for plane in range(first_plane, last_plane):
        for row in range(rows):
            for column in range(columns):
                cell = (plane * rows + row) * columns + column
                if starts[cell] == starts[cell + 1]:
                    continue
                ranges, candidates = candidate_ranges(
                    plane, row, column, rows, columns, grid.periodic, grid.reach, starts, from_k, to_k
                )
                if len(sought) and not any_within(ranges, from_k, to_k, sought, starts[0]):
                    for i in range(np.uint64(starts[cell]), np.uint64(starts[cell + 1])):
                        begin[i - np.uint64(low)], lengths[i - np.uint64(low)] = end, 0
                    continue
                if candidates > len(column_of) * LANES:
                    column_of = np.empty(candidates // 4, np.uint32)
                    valid = np.empty(candidates // 4, np.uint64)
                own = group_candidates(starts[cell], ranges, from_k, to_k, column_of, valid)
                for i in range(np.uint64(starts[cell]), np.uint64(starts[cell + 1])):
                    if np.int64(end) + candidates > capacity:
                        done = max(np.int64(i) - low - before, 1)
                        guess = (np.int64(end) - begun) * owned // done + candidates
                        return max(guess, len(lists) + len(lists) // SPARE) + 1024
                    x_i = at(near.position, i)
                    lane = own + i - np.uint64(starts[cell])
                    own_group, own_bit = lane // np.uint64(LANES), one << lane % np.uint64(LANES)
                    valid[own_group] ^= own_bit  # not its own neighbour
                    first = end
                    for g in range(np.uint64(candidates // LANES)):
                        column_g = np.uint64(column_of[g])
                        bits = near_bits(near.position, column_g, x_i, near.periods, near.cutoff2) & valid[g]
                        end = append_near(lists, end, column_g, bits)
                    valid[own_group] ^= own_bit
                    begin[i - np.uint64(low)] = first
                    lengths[i - np.uint64(low)] = end - first
                    while (end - first) % np.uint64(multiple) != np.uint64(0):
                        lists[end] = i
                        end += np.uint64(1)
    return np.int64(0)


@compiled
def any_within(ranges, from_k, to_k, before, first):
    """Whether ``before``, which counts what is sought before each column from ``first`` on, rises within one
    of the ranges."""
    found, first = False, np.uint64(first)
    for q in range(ranges):
        found = found or before[to_k[q] - first] > before[from_k[q] - first]
    return found


@compiled
def group_candidates(cell_start, ranges, from_k, to_k, column_of, valid):
    """Cut the ranges into groups: their first columns, and bits of the lanes inside the range.

    Returns the lane, counted over all groups, of the cell's first particle.
    """
    lanes, one = np.uint64(LANES), np.uint64(1)
    g = own = np.uint64(0)
    for q in range(ranges):
        if from_k[q] <= np.uint64(cell_start) < to_k[q]:
            own = g * lanes + np.uint64(cell_start) - from_k[q]
        for column in range(from_k[q], to_k[q], lanes):
            column_of[g] = column
            valid[g] = (one << min(lanes, to_k[q] - column)) - one
            g += one
    return own


@compiled
def grouped(n):
    """``n`` rounded up to whole groups."""
    lanes = np.uint64(LANES)
    return (n + lanes - np.uint64(1)) // lanes * lanes


@compiled
def candidate_ranges(plane, row, column, rows, columns, periodic, reach, starts, from_k, to_k):
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
