"""Neighbours among particles of many sizes: a grid of cells for each level of sizes, one twice as coarse as
the one before.

A particle that reaches R looks in each level as far as the larger of R and of the largest reach there, so the
number of candidates for each neighbour does not grow with the ratio of sizes.  Which candidates there are
depends on the rank, who is a neighbour does not: a row names them by their columns, in rising order, which is
that of planes, cells and ids on any rank.
"""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import elementwise, inside
from psph.engine.threads import in_threads
from psph.particles.neighbours import Neighbours, entries_for
from psph.particles.sizes import Sizes

AXES = 3
"""Axes of a grid; in 1D and 2D the first have one cell."""

CELLS_A_PARTICLE = 2
"""A level has no more cells than so many for each of its particles: where it is sparse they are wider."""

SOME = 40
"""Entries of a row for which there is room at first."""

WIDER = 1.0 + 1e-9
"""Rounding may put a particle into the next cell."""


class Slab(NamedTuple):
    """The slab of a rank along ``axis``: its ``lower`` and ``upper`` edge, m; ``low`` ghosts, ``owned``
    particles and ``high`` ghosts in its columns; the ``periods`` in m, None for an open axis."""

    axis: int
    lower: float
    upper: float
    low: int
    owned: int
    high: int
    periods: tuple


class Places(NamedTuple):
    """Where particles are: ``own`` (3, n) as they have it, ``seen`` (3, n) with ghosts beside the slab, how
    far each reaches, ``reach`` (n,), all in m; ``images`` (3,) are the periods, 0 on an open axis, and
    ``axis`` is that of the slab."""

    own: np.ndarray
    seen: np.ndarray
    reach: np.ndarray
    images: np.ndarray
    axis: int


class Grids(NamedTuple):
    """The grids of all levels, one after the other.

    ``members`` are the columns of their particles by cell, ``places`` (5, n) these particles' places, m, the
    place along the slab axis where they are seen, and their reach; ``starts`` the first of each cell among
    them, ``base`` (levels,) the first cell of each level among ``starts``; ``counts`` (levels, 3) cells along
    each axis from ``origin`` (levels, 3), m, on, ``inverse`` (levels, 3) how many a metre; ``reach``
    (levels,) the largest in each, m; ``periods`` (3,) in m, 0 where cells do not go round.
    """

    members: np.ndarray
    places: np.ndarray
    starts: np.ndarray
    base: np.ndarray
    counts: np.ndarray
    origin: np.ndarray
    inverse: np.ndarray
    reach: np.ndarray
    periods: np.ndarray


def list_by_levels(position, listed, sizes: Sizes, slab: Slab, lanes: int) -> Neighbours:
    """Lists of the owned particles: of all that are nearer than the larger reach of both, and the skin.

    ``position`` are component arrays and ``listed`` the smoothing lengths, m, of all columns.  Rows are
    filled up to a multiple of ``lanes`` with the particle itself.
    """
    total = slab.low + slab.owned + slab.high
    places = _places(position, sizes.reach(listed[:total]) + sizes.skin, slab, total)
    grids, lengths = _grids(places), np.zeros(slab.owned, np.uint32)
    rows = slab.low, slab.low + slab.owned, slab.low
    parts = in_threads(fill_levels, *rows, places, grids, lanes, lengths)
    padded = -(-lengths.astype(np.uint64) // np.uint64(lanes)) * np.uint64(lanes)
    ends = np.cumsum(padded, dtype=np.uint64)
    found = Neighbours(ends - padded, lengths, entries_for(sum(map(len, parts))))
    np.concatenate(parts, out=found.lists)
    return found


def _places(position, reach: np.ndarray, slab: Slab, total: int) -> Places:
    """Where particles are, and where ghosts are seen from the slab."""
    own, images = np.zeros((AXES, total)), np.zeros(AXES)
    first = AXES - len(position)
    for d, (x, period) in enumerate(zip(position, slab.periods)):
        own[first + d] = x[:total]
        images[first + d] = period or 0.0
    seen, axis = own.copy(), first + slab.axis
    if period := slab.periods[slab.axis]:
        sides = (slice(0, slab.low), slab.lower), (slice(total - slab.high, total), slab.upper)
        for ghosts, edge in sides:
            x = seen[axis, ghosts]
            x -= period * np.rint((x - edge) / period)
    return Places(own, seen, reach, images, axis)


def _grids(places: Places) -> Grids:
    """The levels of particles at these places."""
    seen, reach, periods = places.seen, places.reach, places.images.copy()
    periods[places.axis] = 0.0
    smallest = reach.min(initial=np.inf)
    levels = np.floor(np.log2(reach / smallest)).astype(np.int64)
    members, starts, base, shapes = [], [np.zeros(1, np.int64)], [], []
    begun = cells = 0
    for level in np.unique(levels):
        own = np.flatnonzero(levels == level)
        counts, origin, inverse = _cells(seen[:, own], periods, reach[own].max())
        at = (seen[:, own] - origin[:, None]) * inverse[:, None]
        at = np.clip(at.astype(np.int64), 0, counts[:, None] - 1)
        cell = (at[0] * counts[1] + at[1]) * counts[2] + at[2]
        members.append(own[np.argsort(cell, kind="stable")])
        starts.append(begun + np.cumsum(np.bincount(cell, minlength=int(counts.prod()))))
        base.append(cells)
        shapes.append((counts, origin, inverse, reach[own].max()))
        begun, cells = begun + len(own), cells + int(counts.prod())
    order = np.concatenate([*members, np.zeros(0, np.int64)])
    counts, origin, inverse, largest = zip(*shapes) if shapes else ([np.zeros(AXES)],) * 3 + ([0.0],)
    return Grids(
        order.astype(np.uint32),
        np.vstack([places.own, seen[places.axis], reach])[:, order],
        np.concatenate(starts),
        np.array(base, np.int64),
        np.array(counts, np.int64),
        np.array(origin),
        np.array(inverse),
        np.array(largest),
        periods,
    )


def _cells(places: np.ndarray, periods: np.ndarray, size: float) -> tuple[np.ndarray, ...]:
    """Numbers of cells, corner and cells a metre of a level, of a ``size`` in m or wider."""
    lower, upper = places.min(axis=1), places.max(axis=1)
    repeats = periods > 0.0
    extent = np.where(repeats, periods, upper - lower)
    while True:
        counts = np.maximum(1, (extent / size).astype(np.int64))
        if counts.prod() <= CELLS_A_PARTICLE * places.shape[1] or (counts == 1).all():
            break
        size *= 1.25
    inverse = counts / np.where(extent > 0.0, extent, 1.0)
    return counts, lower, inverse


@inside
def along_axis(x, reach, origin, inverse, count, period):
    """First and last cell of an axis within ``reach`` m of ``x``; beyond the ends where it repeats."""
    first = np.int64(np.floor((x - reach - origin) * inverse))
    last = np.int64(np.floor((x + reach - origin) * inverse))
    if period > 0.0:
        whole = last - first >= count
        return (0, count - 1) if whole else (first, last)
    return max(min(first, count - 1), 0), max(min(last, count - 1), 0)


@inside
def is_near(k, m, places, grids):
    """Whether particle ``k`` and the member ``m`` are within the larger reach of both, and seen so there."""
    apart2 = 0.0
    for a in range(AXES):
        x = places.own[a, k] - grids.places[a, m]
        if places.images[a] > 0.0:
            x -= places.images[a] * np.rint(x / places.images[a])
        apart2 += x * x
    within = max(places.reach[k], grids.places[AXES + 1, m])
    # Of a particle of the slab and its image behind the other side only one is beside another.
    beside = abs(places.seen[places.axis, k] - grids.places[AXES, m]) <= within * WIDER
    return beside and apart2 <= within * within


@inside
def look_around(k, places, grids, entries, end):
    """Write the neighbours of ``k`` into ``entries`` from ``end`` on; returns these, longer where that is
    needed, and the new end."""
    x = places.seen
    for level in range(len(grids.base)):
        far = max(places.reach[k], grids.reach[level]) * WIDER
        n, origin, inverse = grids.counts[level], grids.origin[level], grids.inverse[level]
        first0, last0 = along_axis(x[0, k], far, origin[0], inverse[0], n[0], grids.periods[0])
        first1, last1 = along_axis(x[1, k], far, origin[1], inverse[1], n[1], grids.periods[1])
        first2, last2 = along_axis(x[2, k], far, origin[2], inverse[2], n[2], grids.periods[2])
        inside_line = first2 >= 0 and last2 < n[2]
        for c0 in range(first0, last0 + 1):
            for c1 in range(first1, last1 + 1):
                line = grids.base[level] + ((c0 % n[0]) * n[1] + c1 % n[1]) * n[2]
                # Cells of a line lie side by side: one range, unless it goes round.
                for c2 in range(first2, first2 + 1 if inside_line else last2 + 1):
                    low = line + (c2 if inside_line else c2 % n[2])
                    begin, stop = grids.starts[low], grids.starts[(line + last2 if inside_line else low) + 1]
                    if end + stop - begin > len(entries):
                        longer = np.empty(2 * len(entries) + stop - begin, np.uint32)
                        longer[:end] = entries[:end]
                        entries = longer
                    for m in range(begin, stop):
                        if is_near(k, m, places, grids) and grids.members[m] != k:
                            entries[end] = grids.members[m]
                            end += 1
    return entries, end


@elementwise
def fill_levels(first, last, low, places, grids, lanes, lengths):
    """Rows of the columns ``first`` to ``last``, one after the other, and their ``lengths``."""
    entries, end = np.empty(SOME * (last - first + 1), np.uint32), 0
    for k in range(first, last):
        begin = end
        entries, end = look_around(k, places, grids, entries, begin)
        entries[begin:end].sort()
        lengths[k - low] = end - begin
        filled = begin + (end - begin + lanes - 1) // lanes * lanes
        if filled > len(entries):
            longer = np.empty(filled + len(entries), np.uint32)
            longer[:end] = entries[:end]
            entries = longer
        entries[end:filled] = k
        end = filled
    return entries[:end]
