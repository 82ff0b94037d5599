"""Verlet lists: for every owned particle the columns of all particles within the cutoff."""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import inside, uncounted
from psph.engine.simd import AHEAD
from psph.engine.threads import in_rooms, threads
from psph.particles.cells import Grid
from psph.particles.lanes import LANES
from psph.particles.near_cell import Near, append_row, gather, room_near
from psph.particles.store import SPARE

ROUNDING = 1e-6
"""Relative error of a distance in single precision, generously."""


GROUPS = 256
"""Groups of candidates for which there is room at first; the guess need not be right."""


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
    position, cutoff, slack = in_single_precision(store, grid, first, cutoff)
    # The guess of entries need not be right; the same lists come of any.
    if len(room.begin) < owned:
        room = empty(owned + owned // SPARE, max(len(room.lists), 64 * owned + 1024))
    near = Near(position, periods, cutoff * cutoff, slack)
    # How many entries and candidates there are is known once they are written: too little room, and all is
    # done again.
    groups = GROUPS
    while True:
        work = [(room_near(groups, len(position)),) for _ in range(threads())]
        told = near, grid, starts, store.low, owned, lanes, before, room
        needed = in_rooms(fill, 1, planes + 1, work, *told)
        if not any(needed):
            return room
        groups = max(groups, *(-2 * n for n in needed))
        if max(needed) > 0:
            room = room._replace(lists=entries_for(max(needed) + max(needed) // SPARE))


def in_single_precision(store, grid: Grid, first: int, cutoff: float):
    """Positions relative to the grid, rounded, a cutoff that loses no neighbour by it, and how much it is
    larger by that.

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
    return tuple(near), cutoff * (1.0 + ROUNDING) + rounding, rounding


@uncounted
def fill_lists(first_plane, last_plane, near, grid, starts, low, owned, multiple, sought, room, found):
    """Fill the rows of some planes; returns 0, or about how many entries are needed for all, or, with a
    minus, how many groups of candidates.

    Planes take the part of the lists that is their part of the ``owned`` particles.
    The particles of a few cells in a row, as wide as the cutoff together, have the same candidates: a few
    ranges of columns, of which ``found`` takes those that may be near any of them.  ``sought`` counts, before
    each column from the first on, those of which a row must have one in its cells around; it is empty where
    all rows are filled.
    """
    begin, lengths, lists = room.begin, room.lengths, room.lists
    rows, columns = grid.counts[1], grid.counts[2]
    line, width = rows * columns, max(grid.reach, 1)
    before = starts[first_plane * line] - low
    here = starts[last_plane * line] - low - before
    # A group is written whole: between two parts lies room for it.
    each = max(len(lists) - 2 * LANES * (len(starts) // line), 0) / max(owned, 1)
    begun = np.int64(each * before) + 2 * LANES * (first_plane - 1)
    capacity = begun + np.int64(each * here)
    end = np.uint64(begun)
    for plane in range(first_plane, last_plane):
        for row in range(rows):
            for column in range(0, columns, width):
                cell = (plane * rows + row) * columns + column
                first, last = starts[cell], starts[cell + min(width, columns - column)]
                if first == last:
                    continue
                ranges, candidates = candidate_ranges(plane, row, column, grid, starts, found)
                if len(sought) and not any_within(ranges, found.begins, found.ends, sought, starts[0]):
                    for i in range(np.uint64(first), np.uint64(last)):
                        begin[i - np.uint64(low)], lengths[i - np.uint64(low)] = end, 0
                    continue
                if candidates + 2 * LANES > len(found.columns):
                    return -np.int64(candidates // LANES + 2)
                groups, own = gather(near, np.uint64(first), np.uint64(last), ranges, found)
                most = np.int64(groups) * LANES
                for i in range(np.uint64(first), np.uint64(last)):
                    if np.int64(end) + most > capacity:
                        done = max(np.int64(i) - low - before, 1)
                        guess = (np.int64(end) - begun) * owned // done + most
                        return max(guess, len(lists) + len(lists) // SPARE) + 1024
                    begun_row = end
                    end = append_row(lists, end, own + i - np.uint64(first), near, found, groups)
                    begin[i - np.uint64(low)] = begun_row
                    lengths[i - np.uint64(low)] = end - begun_row
                    while (end - begun_row) % np.uint64(multiple) != np.uint64(0):
                        lists[end] = i
                        end += np.uint64(1)
    return np.int64(0)


@inside
def any_within(ranges, from_k, to_k, before, first):
    """Whether ``before``, which counts what is sought before each column from ``first`` on, rises within one
    of the ranges."""
    found, first = False, np.uint64(first)
    for q in range(ranges):
        found = found or before[to_k[q] - first] > before[from_k[q] - first]
    return found


@inside
def candidate_ranges(plane, row, column, grid, starts, found):
    """Write ranges of columns of the store, in order, that can hold neighbours of particles in the cells from
    this one on, as far as the cutoff is wide; returns how many, and how many groups fill them, in columns."""
    rows, columns = grid.counts[1], grid.counts[2]
    n, candidates, from_k, to_k = 0, 0, found.begins, found.ends
    for p in range(plane - 1, plane + 2):
        for r in range(row - 1, row + 2):
            inside = 0 <= r < rows
            if not inside and not grid.periodic[1]:
                continue
            base = (p * rows + r % rows) * columns
            left, right = column - grid.reach, column + max(2 * grid.reach, 1)
            if grid.periodic[2]:
                right = min(right, left + columns)  # each cell once
            if left < 0 and grid.periodic[2]:
                from_k[n], to_k[n] = starts[base + left + columns], starts[base + columns]
                n += 1
            from_k[n], to_k[n] = starts[base + max(left, 0)], starts[base + min(right, columns)]
            n += 1
            if right > columns and grid.periodic[2]:
                from_k[n], to_k[n] = starts[base], starts[base + right - columns]
                n += 1
    for q in range(n):
        candidates += np.int64(to_k[q] - from_k[q]) + LANES
    return n, candidates
