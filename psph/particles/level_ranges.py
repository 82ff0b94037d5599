"""Ranges of candidates: the particles of a grid's cells that may be near those of one cell."""

import numpy as np

from psph.engine.jit import inside, register_jitable
from psph.particles.lanes import LANES

AXES = 3
"""Axes of a grid; in 1D and 2D the first have one cell."""

FARTHEST = 2**20 - 2
"""Cells from the corner of the domain within which particles have cells of their own; those farther out share
the outermost."""

BITS = 21
"""Of a cell's key for each axis."""

ALL = 2**BITS - 1
"""The bits of an axis."""

WIDER = 1.0 + 1e-9
"""Rounding may put a particle into the next cell."""


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
def along_axis(low, high, far, inverse, count, lowest, highest):
    """The first and last cell of an axis between ``far`` before ``low`` and ``far`` behind ``high``, m from
    its origin, and after how many it goes round; from the ``lowest`` to the ``highest`` where it does not,
    beyond its ends where that is after ``count`` cells, or all of them, and −1."""
    first, last = (low - far) * inverse, (high + far) * inverse
    # Comparisons that no NaN passes: it must not become a number of a cell.
    first = np.int64(np.floor(first)) if first > -FARTHEST else -FARTHEST
    last = np.int64(np.floor(last)) if last < FARTHEST else FARTHEST
    if count > 0 and last - first >= count:
        return np.int64(0), np.int64(count - 1), np.int64(-1)
    if count > 0:
        return min(first, FARTHEST), max(last, -FARTHEST), np.int64(count)
    return max(first, lowest), min(last, highest), np.int64(count)


@inside
def extent(grids, first, last, low, high):
    """Write the corners of the box around the particles ``first`` to ``last``, m from the origin, to ``low``
    and ``high`` (3,); their largest reach, m."""
    within2 = 0.0
    for m in range(np.uint64(first), np.uint64(last)):
        within2 = max(within2, grids.within2[m])
    for a in range(AXES):
        least, most = np.inf, -np.inf
        for m in range(np.uint64(first), np.uint64(last)):
            x = grids.seen[a, m]
            least, most = min(least, x), max(most, x)
        low[a], high[a] = least - grids.origin[a], most - grids.origin[a]
    return np.sqrt(within2)


@register_jitable
def around(cell, count):
    """The cell of an axis that goes round after ``count`` cells, if that is above 0."""
    return cell % count if count > 0 else cell


@register_jitable
def width(inverse):
    """How wide a cell is, m, of which a metre has so many; infinite where there is but one."""
    return 1.0 / inverse if inverse > 0.0 else np.inf


@register_jitable
def gap(low, high, cell, wide, count):
    """How far a box from ``low`` to ``high``, m from the origin of an axis, is from one of its cells, which
    are so ``wide``, m, at the least; 0 where the cell is as wide as all, or one of the outermost."""
    if wide == np.inf or abs(cell) >= FARTHEST or count < 0:
        return 0.0
    return max(0.0, cell * wide - high, low - (cell + 1) * wide)


@inside
def candidates(grids, low, high, reach, levels, ranges):
    """Ranges of particles of some ``levels``, from one to before another, in cells around a box, into the
    rows of ``ranges`` (most, 2), as far as there is room; how many there are, and how many particles they
    hold at the most."""
    many, held = 0, 0
    for level in range(levels[0], levels[1]):
        n, per, box = grids.counts[level], grids.inverse[level], grids.box[level]
        wide0, wide1 = width(per[0]), width(per[1])
        far = max(reach, grids.reach[level]) * WIDER
        first0, last0, n0 = along_axis(low[0], high[0], far, per[0], n[0], box[0, 0], box[1, 0])
        place = grids.base[level]
        for c0 in range(first0, last0 + 1):
            row0 = around(c0, n[0])
            if not box[0, 0] <= row0 <= box[1, 0]:
                continue
            left2 = far * far - gap(low[0], high[0], c0, wide0, n0) ** 2
            if left2 < 0.0:
                continue
            first1, last1, n1 = along_axis(
                low[1], high[1], np.sqrt(left2), per[1], n[1], box[0, 1], box[1, 1]
            )
            for c1 in range(first1, last1 + 1):
                row1 = around(c1, n[1])
                if not box[0, 1] <= row1 <= box[1, 1]:
                    continue
                rest2 = left2 - gap(low[1], high[1], c1, wide1, n1) ** 2
                if rest2 < 0.0:
                    continue
                first2, last2, _ = along_axis(
                    low[2], high[2], np.sqrt(rest2), per[2], n[2], box[0, 2], box[1, 2]
                )
                c2 = first2
                while c2 <= last2:
                    # Where the line goes round there is a second range, from its other end on.
                    here = around(c2, n[2])
                    stop = min(last2 - c2, n[2] - 1 - here) if n[2] > 0 else last2 - c2
                    begin, end, place = of_line(grids, level, place, row0, row1, here, here + stop)
                    if many < len(ranges):
                        ranges[many, 0], ranges[many, 1] = begin, end
                    many += end > begin
                    held += end - begin + LANES
                    c2 += stop + 1
    return many, held


@inside
def of_line(grids, level, place, row0, row1, first, last):
    """The particles of a level in the cells ``first`` to ``last`` of a line within its box: from which on,
    and before which; where cells are not numbered they are sought from the cell ``place`` on, and from which
    on those of the next line are."""
    box, number = grids.box[level], grids.first[level]
    if number >= 0:
        first, last = max(first, box[0, 2]) - box[0, 2], min(last, box[1, 2]) - box[0, 2]
        line = (row0 - box[0, 0]) * (box[1, 1] - box[0, 1] + 1) + row1 - box[0, 1]
        number += line * (box[1, 2] - box[0, 2] + 1)
        if first > last:
            return np.int64(0), np.int64(0), place
        return grids.begun[number + first], grids.begun[number + last + 1], place
    line = ((row0 + FARTHEST) << 2 * BITS) + ((row1 + FARTHEST) << BITS) + FARTHEST
    found, close = within(grids, level, place, line + first, line + last)
    return grids.starts[found], grids.starts[close], close


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
