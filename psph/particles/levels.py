"""Neighbours among particles of many sizes: a grid of cells for each level of sizes, one twice as coarse as
the one before.

A particle that reaches R looks in each level as far as the larger of R and of the largest reach there, so the
number of candidates for each neighbour does not grow with the ratio of sizes.  All ranks have the same levels
and cells: a row has its neighbours by level, cell and column, the same order on any rank.
"""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import inside, overload, register_jitable, uncounted
from psph.engine.simd import bits, consecutive, width_of
from psph.engine.threads import in_rooms, threads
from psph.particles.lanes import LANES, append_near, consecutive_each
from psph.particles.level_rows import OwnedRows, holding_sought, looks
from psph.particles.neighbours import Neighbours, empty, entries_for
from psph.particles.sizes import Sizes
from psph.particles.store import SPARE
from psph.vectors import at, dot, nearest_image, subtract

AXES = 3
"""Axes of a grid; in 1D and 2D the first have one cell."""

CELLS_A_REACH = 2.0
"""Cells of a level are so many times narrower than its particles reach at the most: of 1, 1.5, 2 and 3 the
quickest in 3D."""

FARTHEST = 2**20 - 2
"""Cells from the corner of the domain within which particles have cells of their own; those farther out share
the outermost."""

BITS = 21
"""Of a cell's key for each axis."""

RANGES = 64
"""Ranges of candidates of a cell for which there is room at first; the guess need not be right."""

SOME = 40
"""Entries of a row for which there is room at first; the guess need not be right."""

UNSIGNED = 2**64 - 1
"""What is below zero becomes a large number by it, in compiled code and without."""

WIDER = 1.0 + 1e-9
"""Rounding may put a particle into the next cell."""


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
    along each axis, ``reach`` (levels,) the largest in each, m; ``periods`` in m or None.
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
    reach: np.ndarray
    periods: tuple


def list_by_levels(
    room: Neighbours, position, listed, across: np.ndarray, sizes: Sizes, slab: Slab, lanes: int, sought=None
) -> Neighbours:
    """Lists of the owned particles: of all that are nearer than the larger reach of both, or than the reach
    of these where ``sizes`` ask for that.

    ``position`` are component arrays and ``listed`` the smoothing lengths, m, of all columns; who does not
    look ``across`` (columns,) lists its own level alone.  Where ``sought`` is given (columns,) a row stays
    empty that has no column above 0 in the cells around.  Rows are filled up to a multiple of ``lanes`` with
    the particle itself.  ``room`` is used again where it is large enough.
    """
    if not slab.owned:
        return empty(0, 0)
    total = slab.low + slab.owned + slab.high
    grids = grids_of([x[:total] for x in position], sizes.reach(listed[:total]), slab)
    across, before = across[grids.columns], np.zeros(0 if sought is None else total + 1, np.int64)
    if sought is not None:
        np.cumsum(sought[grids.columns] > 0.0, out=before[1:])
    if len(room.begin) < slab.owned:
        room = empty(slab.owned + slab.owned // SPARE, max(len(room.lists), SOME * total))
    # How many entries there are is known once they are written: too little room, and all is done again.
    rows, most = OwnedRows(slab.low, slab.owned, lanes, across, float(sizes.mutual), before), RANGES
    while True:
        work = [(np.zeros((most, 2), np.int64), np.zeros((2, AXES))) for _ in range(threads())]
        needed = in_rooms(fill_levels, 0, len(grids.keys), work, grids, rows, room)
        if not any(needed):
            return room
        most = max(most, *(-2 * n for n in needed))
        if max(needed) > 0:
            room = room._replace(lists=entries_for(max(needed) + max(needed) // SPARE))


def grids_of(position: list[np.ndarray], reach: np.ndarray, slab: Slab) -> Grids:
    """The levels of particles at these places."""
    first = AXES - len(position)
    level = np.floor(np.log2(slab.cutoff * WIDER / reach)).astype(np.int64)
    levels = np.unique(level)
    counts, inverse = np.zeros((len(levels), AXES), np.int64), np.zeros((len(levels), AXES))
    origin, seen = np.zeros(AXES), np.zeros((AXES, len(reach)))
    key, of = np.zeros(len(reach), np.int64), np.searchsorted(levels, level)
    box = np.zeros((len(levels), 2, AXES), np.int64)
    for a in range(first):
        key |= FARTHEST << BITS * (AXES - 1 - a)
    for d, (x, period) in enumerate(zip(position, slab.periods)):
        a, wide = first + d, slab.cutoff * 0.5**levels / CELLS_A_REACH
        origin[a] = slab.origin[d]
        if period:
            counts[:, a] = np.ceil(period / wide)  # narrower: no two images of one are candidates
        inverse[:, a] = counts[:, a] / period if period else 1.0 / wide
        cell = np.nan_to_num((x - origin[a]) * inverse[of, a], nan=0.0)
        cell = np.floor(np.clip(cell, -FARTHEST, FARTHEST)).astype(np.int64)
        seen[a] = x
        if period:
            cell = np.clip(cell, 0, counts[of, a] - 1)
        if period and d == slab.axis:
            beyond = _beyond(x, period, slab)
            cell += beyond * counts[of, a]
            seen[a] += beyond * period
            counts[:, a] = 0  # ghosts stand where they are seen: it does not go round
        cell = np.clip(cell, -FARTHEST, FARTHEST)
        box[:, 0, a] = [cell[of == n].min() for n in range(len(levels))]
        box[:, 1, a] = [cell[of == n].max() for n in range(len(levels))]
        key |= (cell + FARTHEST) << BITS * (AXES - 1 - a)
    order = np.lexsort((key, of))
    key, of = key[order], of[order]
    starts = np.flatnonzero(np.concatenate([[True], (np.diff(key) != 0) | (np.diff(of) != 0)]))
    return Grids(
        order.astype(np.uint32),
        seen[:, order],
        tuple(_padded(x[order]) for x in position),
        _padded(reach[order] ** 2),
        key[starts],
        np.append(starts, len(order)),
        np.searchsorted(of[starts], np.arange(len(levels) + 1)),
        inverse,
        origin,
        counts,
        box,
        np.maximum.reduceat(reach[order], np.searchsorted(of, np.arange(len(levels)))),
        tuple(slab.periods),
    )


def _beyond(x: np.ndarray, period: float, slab: Slab) -> np.ndarray:
    """By how many periods each column is seen beyond its place: 0 but for ghosts."""
    found = np.zeros(len(x), np.int64)
    sides = (slice(0, slab.low), slab.lower), (slice(len(x) - slab.high, len(x)), slab.upper)
    for ghosts, edge in sides:
        found[ghosts] = -np.rint((x[ghosts] - edge) / period)
    return found


def _padded(values: np.ndarray) -> np.ndarray:
    """Values and as many more as a register reads behind the last."""
    return np.concatenate([values, np.zeros(LANES)])


@inside
def lower_bound(keys, first, last, key):
    """The first place from ``first`` on, and before ``last``, whose key is not below this, or ``last``."""
    step = 1
    while first + step < last and keys[first + step - 1] < key:
        first += step
        step *= 2
    last = min(last, first + step)
    while first < last:
        middle = (first + last) // 2
        if keys[middle] < key:
            first = middle + 1
        else:
            last = middle
    return first


@register_jitable
def along_axis(low, high, far, inverse, count):
    """The first and last cell of an axis between ``far`` before ``low`` and ``far`` behind ``high``, m from
    its origin, and after how many it goes round; beyond its ends where that is after ``count`` cells, or all
    of them, and −1."""
    first, last = (low - far) * inverse, (high + far) * inverse
    # Comparisons that no NaN passes: it must not become a number of a cell.
    first = np.int64(np.floor(first)) if first > -FARTHEST else -FARTHEST
    last = np.int64(np.floor(last)) if last < FARTHEST else FARTHEST
    if count > 0 and last - first >= count:
        return np.int64(0), np.int64(count - 1), np.int64(-1)
    return min(first, FARTHEST), max(last, -FARTHEST), np.int64(count)


@inside
def extent(grids, first, last, low, high):
    """Write the corners of the box around the particles ``first`` to ``last``, m from the origin, to ``low``
    and ``high`` (3,); their largest reach, m."""
    within2 = 0.0
    for a in range(AXES):
        low[a], high[a] = np.inf, -np.inf
    for m in range(first, last):
        for a in range(AXES):
            x = grids.seen[a, m] - grids.origin[a]
            low[a], high[a] = min(low[a], x), max(high[a], x)
        within2 = max(within2, grids.within2[m])
    return np.sqrt(within2)


@register_jitable
def around(cell, count):
    """The cell of an axis that goes round after ``count`` cells, if that is above 0."""
    return cell % count if count > 0 else cell


@register_jitable
def gap(low, high, cell, inverse, count):
    """How far a box from ``low`` to ``high``, m from the origin of an axis, is from one of its cells at the
    least; 0 where the cell has no width, or is one of the outermost."""
    if inverse == 0.0 or abs(cell) >= FARTHEST or count < 0:
        return 0.0
    return max(0.0, cell / inverse - high, low - (cell + 1) / inverse)


@inside
def candidates(grids, low, high, reach, levels, ranges):
    """Ranges of particles of some ``levels``, from one to before another, in cells around a box, into the
    rows of ``ranges`` (most, 2), as far as there is room; how many there are, and how many particles they
    hold at the most."""
    many, held = 0, 0
    for level in range(levels[0], levels[1]):
        n, per, box = grids.counts[level], grids.inverse[level], grids.box[level]
        far = max(reach, grids.reach[level]) * WIDER
        first0, last0, n0 = along_axis(low[0], high[0], far, per[0], n[0])
        place = grids.base[level]
        for c0 in range(first0, last0 + 1):
            row0 = around(c0, n[0])
            if not box[0, 0] <= row0 <= box[1, 0]:
                continue
            left2 = far * far - gap(low[0], high[0], c0, per[0], n0) ** 2
            first1, last1, n1 = along_axis(low[1], high[1], np.sqrt(max(left2, 0.0)), per[1], n[1])
            for c1 in range(first1, last1 + 1):
                row1 = around(c1, n[1])
                if not box[0, 1] <= row1 <= box[1, 1]:
                    continue
                rest2 = left2 - gap(low[1], high[1], c1, per[1], n1) ** 2
                if rest2 < 0.0:
                    continue
                first2, last2, _ = along_axis(low[2], high[2], np.sqrt(rest2), per[2], n[2])
                line = ((row0 + FARTHEST) << 2 * BITS) + ((row1 + FARTHEST) << BITS)
                c2 = first2
                while c2 <= last2:
                    # Where the line goes round there is a second range, from its other end on.
                    here = around(c2, n[2])
                    stop = min(last2 - c2, n[2] - 1 - here) if n[2] > 0 else last2 - c2
                    key = line + here + FARTHEST
                    place, close = within(grids, level, place, key, key + stop)
                    if many < len(ranges):
                        ranges[many, 0], ranges[many, 1] = grids.starts[place], grids.starts[close]
                    many += close > place
                    held += grids.starts[close] - grids.starts[place] + LANES
                    place = close
                    c2 += stop + 1
    return many, held


@inside
def within(grids, level, place, first, last):
    """The cells of a level from key ``first`` to ``last``: from which on, and before which; they are sought
    from the cell ``place`` on, unless they come before."""
    begin, end = grids.base[level], grids.base[level + 1]
    if place > begin and grids.keys[place - 1] >= first:
        place = begin
    found = lower_bound(grids.keys, place, end, first)
    close = found
    while close < end and grids.keys[close] <= last:
        close += 1
    return found, close


@inside
def of_level(grids, level, ranges, many):
    """Which of the ``ranges``, from one to before another, are of a level: they come level by level."""
    first, last = grids.starts[grids.base[level]], grids.starts[grids.base[level + 1]]
    least, most = 0, many
    while least < most and ranges[least, 0] < first:
        least += 1
    while most > least and ranges[most - 1, 0] >= last:
        most -= 1
    return least, most


def near_bits(x_i, within2_i, grids, m):
    """Bit t says whether particle ``m + t`` of the grids lies within its reach of ``x_i``, or within that of
    this one, whose square is ``within2_i``."""
    x_ij = nearest_image(subtract(x_i, at(grids.position, m)), grids.periods)
    return int(dot(x_ij, x_ij) <= max(within2_i, grids.within2[m]))


@overload(near_bits)
def _typed_near_bits(x_i, within2_i, grids, m):
    def compare(x_i, within2_i, grids, m):
        x_ij = nearest_image(subtract(x_i, consecutive_each(grids.position, m)), grids.periods)
        return bits(dot(x_ij, x_ij) <= max(consecutive(grids.within2, m), within2_i))

    return compare


@inside
def append_row(entries, end, m, within2_i, grids, ranges, least, most):
    """Write the columns of the neighbours of particle ``m`` of the grids behind ``end``, of those in the
    ``ranges`` from number ``least`` to before ``most``; returns the new end."""
    x_i, first, one = at(grids.position, m), end, np.uint64(1)
    for r in range(least, most):
        stop = np.uint64(ranges[r, 1])
        for n in range(np.uint64(ranges[r, 0]), stop, width_of(grids.within2)):
            others = (one << min(np.uint64(LANES), stop - n)) - one
            ahead = np.uint64((m - n) & UNSIGNED)
            others &= ~(np.uint64(ahead < np.uint64(LANES)) << ahead % np.uint64(LANES))
            end = append_near(entries, end, n, near_bits(x_i, within2_i, grids, n) & others)
    for entry in range(first, end):
        entries[entry] = grids.columns[entries[entry]]
    return end


@uncounted
def fill_levels(first, last, grids, rows, room, ranges, corners):
    """Fill the rows of those particles in the cells ``first`` to ``last`` that a rank owns; returns 0, or
    about how many entries are needed for all, or, with a minus, how many ``ranges`` (most, 2); ``corners``
    (2, 3) is room too.

    Cells take the part of the ``room`` that is their part of the particles.
    """
    starts, entries, one = grids.starts, room.lists, np.uint64(1)
    each = len(entries) / starts[len(starts) - 1]
    begun, capacity = np.int64(each * starts[first]), np.int64(each * starts[last])
    end, level, low, high = np.uint64(begun), 0, corners[0], corners[1]
    for cell in range(first, last):
        while cell >= grids.base[level + 1]:
            level += 1
        # The particles of a cell have the same candidates.
        reach = extent(grids, starts[cell], starts[cell + 1], low, high)
        levels = (0, len(grids.reach)) if looks(rows, starts[cell], starts[cell + 1]) else (level, level + 1)
        many, held = candidates(grids, low, high, rows.own * reach, levels, ranges)
        if many > len(ranges):
            return -np.int64(many)
        least, most = of_level(grids, level, ranges, many)
        # By the ranges of a row alone: whether others in the cell look across is known of owned ones only.
        own = holding_sought(rows.sought, ranges, least, most)
        every = holding_sought(rows.sought, ranges, 0, many)
        for m in range(np.uint64(starts[cell]), np.uint64(starts[cell + 1])):
            k = np.int64(grids.columns[m])
            row = k - rows.low
            if not 0 <= row < rows.owned:
                continue
            if np.int64(end) + held + rows.multiple > capacity:
                done = np.int64(m) - starts[first] + 1
                guess = (np.int64(end) - begun + held) * starts[len(starts) - 1] // done
                return max(guess, len(entries)) + held + rows.multiple
            least, most = every if rows.across[m] else own
            within2 = rows.own * grids.within2[m]
            begin, end = end, append_row(entries, end, m, within2, grids, ranges, least, most)
            room.begin[row], room.lengths[row] = begin, end - begin
            while (end - begin) % np.uint64(rows.multiple) != np.uint64(0):
                entries[end] = k
                end += one
    return np.int64(0)
