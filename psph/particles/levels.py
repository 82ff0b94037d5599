"""Neighbours among particles of many sizes: a grid of cells for each level of sizes, one twice as coarse as
the one before.

A particle that reaches R looks in each level as far as the larger of R and of the largest reach there, so the
number of candidates for each neighbour does not grow with the ratio of sizes.  All ranks have the same levels
and cells: a row has its neighbours by level, cell and column, the same order on any rank.
"""

import numpy as np

from psph.engine.jit import inside, uncounted
from psph.engine.threads import in_rooms, threads
from psph.particles.lanes import LANES
from psph.particles.level_candidates import Gathered, append_row, box_around, gather, room_for
from psph.particles.level_grids import Slab, grids_of
from psph.particles.level_ranges import ALL, AXES, BITS, FARTHEST, candidates, extent, of_level
from psph.particles.level_rows import OwnedRows, Sought, finds, holds_sought, looks, owns
from psph.particles.neighbours import Neighbours, empty, entries_for
from psph.particles.sizes import ROUNDED, Sizes
from psph.particles.store import SPARE

SURPLUS = 8
"""Part of the entries for which there is room besides where there was too little: lists of a gas grow on."""

GROUPS = 512
"""Groups of candidates of a cell for which there is room at first; the guess need not be right."""

SOME = 40
"""Entries of a row for which there is room at first; the guess need not be right."""


def list_by_levels(
    room: Neighbours, position, listed, across: np.ndarray, sizes: Sizes, slab: Slab, lanes: int, sought=None
) -> tuple[Neighbours, Neighbours]:
    """Lists of the owned particles: of all that are nearer than the larger reach of both, and nobody else's;
    or, where ``sizes`` ask for that, those of its own level, and of others than its own, as far as these
    reach.

    ``position`` are component arrays and ``listed`` the smoothing lengths, m, of all columns; who does not
    look ``across`` (columns,) lists its own level alone.  Where ``sought`` is given (columns,) a row stays
    empty that names no column above 0, but for those of such columns.  Rows are filled up to a multiple of
    ``lanes`` with the particle itself.  ``room`` is used again where it is large enough.
    """
    if not slab.owned:
        return empty(0, 0), empty(0, 0)
    total = slab.low + slab.owned + slab.high
    grids = grids_of([x[:total] for x in position], sizes.reach(listed[:total]), slab)
    columns, seek = grids.columns[:total], Sought.none()
    if sought is not None:
        seek = Sought.among(sought[:total] > 0.0, columns)
    if len(room.begin) < slab.owned:
        room = empty(slab.owned + slab.owned // SPARE, max(len(room.lists), SOME * total))
    # How many entries there are is known once they are written: too little room, and all is done again.
    others, most = empty(0 if sizes.mutual else slab.owned, 0), GROUPS
    rows = OwnedRows(slab.low, slab.owned, lanes, across[columns], float(sizes.mutual), seek)
    while True:
        work = [work_room(most, len(position)) for _ in range(threads())]
        needed = in_rooms(fill_levels, 0, len(grids.keys), work, grids, rows, room, others)
        if not any(needed):
            return room, others._replace(lists=room.lists)
        most = max(most, *(-2 * n for n in needed))
        if max(needed) > 0:
            room = room._replace(lists=entries_for(max(needed) + max(needed) // SURPLUS))


def work_room(groups: int, dimensions: int) -> tuple:
    """What a thread works in: room for so many ``groups`` of candidates of a cell."""
    return np.zeros((groups, 2), np.int64), np.zeros((3, AXES)), room_for(groups, dimensions)


@inside
def middle_of(grids, level, cell, low, high, reach, middle):
    """Write the ``middle`` of a cell (3,), m from the origin: that of the box from ``low`` to ``high`` around
    its particles where it is one of the outermost, which have no width.

    By which factor squares of reaches are narrower in single precision, of particles that reach so far, m:
    places are rounded by 6e-8 of how far they are from the middle, less than two reaches.
    """
    factor = 1.0 - ROUNDED
    for a in range(AXES):
        number, per = (grids.keys[cell] >> BITS * (AXES - 1 - a) & ALL) - FARTHEST, grids.inverse[level, a]
        middle[a] = 0.5 * (low[a] + high[a])
        if per > 0.0 and abs(number) < FARTHEST:
            middle[a] = (number + 0.5) / per  # the same on every rank, whoever is there
        elif per > 0.0:
            factor = max(factor, 1.0 + ROUNDED * ((high[a] - low[a]) / reach) ** 2)
    return factor


@uncounted
def fill_levels(first, last, grids, rows, room, others, ranges, corners, near):
    """Fill the rows of those particles in the cells ``first`` to ``last`` that a rank owns; returns 0, or
    about how many entries are needed for all, or, with a minus, how many groups of candidates; ``ranges``
    (groups, 2), ``corners`` (3, 3) and ``near`` are room too.  Where there are rows of ``others`` than those
    of a particle's own level each stands behind that of these, and is empty where that stays empty.

    Cells take the part of the ``room`` that is their part of the particles.
    """
    starts, entries, one, parted = grids.starts, room.lists, np.uint64(1), len(others.begin) > 0
    each = len(entries) / starts[len(starts) - 1]
    begun, capacity = np.int64(each * starts[first]), np.int64(each * starts[last])
    end, level, low, high = np.uint64(begun), 0, corners[0], corners[1]
    for cell in range(first, last):
        while cell >= grids.base[level + 1]:
            level += 1
        members = starts[cell], starts[cell + 1]
        if not owns(rows, grids.columns, *members):
            continue
        # The particles of a cell have the same candidates.
        reach = extent(grids, *members, low, high)
        levels = (0, len(grids.reach)) if looks(rows, *members) else (level, level + 1)
        many, held = candidates(grids, low, high, rows.own * reach, levels, ranges)
        if max(many * LANES, held) > len(ranges) * LANES:
            return -np.int64(max(many, held // LANES + 1))
        least, most = of_level(grids, level, ranges, many)
        own = holds_sought(rows.sought.before, ranges, least, most)
        every = own if parted else holds_sought(rows.sought.before, ranges, 0, many)
        found = Gathered(np.int64(0), np.int64(0), np.int64(0), np.int64(0))
        if every:
            narrower = middle_of(grids, level, cell, low, high, reach, corners[2])
            box = box_around(low, high, corners[2], grids.origin, grids.periods)
            told = box, rows.own * reach * reach, narrower, near
            found = gather(grids, ranges, many, (least, most), members, *told)
            asked = (found.first, found.last) if parted else (np.int64(0), found.end)
            every = finds(rows.sought, grids.columns[members[0]], near.columns, *asked)
        for m in range(np.uint64(members[0]), np.uint64(members[1])):
            k = np.int64(grids.columns[m])
            row = k - rows.low
            if not 0 <= row < rows.owned:
                continue
            if np.int64(end) + found.end + LANES + rows.multiple > capacity:
                done = np.int64(m) - starts[first] + 1
                guess = (np.int64(end) - begun + found.end) * starts[len(starts) - 1] // done
                return max(guess, len(entries)) + found.end + LANES + rows.multiple
            begin, named = end, every and (own or rows.across[m])
            itself = np.uint64(found.itself + np.int64(m) - members[0])
            if named:
                all_levels = rows.across[m] and not parted
                part = (np.int64(0), found.end) if all_levels else (found.first, found.last)
                end = append_row(entries, end, itself, rows.own, near, *part)
                named = finds(rows.sought, k, entries, begin, end)
                end = end if named else begin
            room.begin[row], room.lengths[row] = begin, end - begin
            while (end - begin) % np.uint64(rows.multiple) != np.uint64(0):
                entries[end] = k
                end += one
            if parted:
                begin = end
                if named and rows.across[m]:
                    end = append_row(entries, end, itself, rows.own, near, np.int64(0), found.first)
                    end = append_row(entries, end, itself, rows.own, near, found.last, found.end)
                others.begin[row], others.lengths[row] = begin, end - begin
    return np.int64(0)
