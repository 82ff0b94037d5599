"""Lists where particles are of several levels of sizes: pairs of one level, and those who lead."""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import compiled
from psph.particles.neighbours import Neighbours, entries_for

NOBODY = np.uint8(255)
"""No level: of those whom no row names."""


class Membership(NamedTuple):
    """Of each column its ``level`` and whether rows may name it: those who lead, or all fluid."""

    level: np.ndarray
    named: np.ndarray


def rows_that_name(
    lists: Neighbours, low: int, owned: int, of: Membership, asked: np.ndarray, same: bool, lanes: int
) -> Neighbours:
    """Rows of those ``owned`` columns from ``low`` on that are ``asked`` (columns,): those of their
    entries in ``lists`` that may be named, in the same order, on the ``same`` level or on others.

    They are filled up to a multiple of ``lanes`` with the particle itself; all other rows are empty.
    """
    most = np.where(asked[low : low + owned], lists.lengths[:owned], 0).astype(np.int64)
    room = int((-(-most // lanes) * lanes).sum())
    # Row by row, so that memory is touched as far as entries go alone.
    found = Neighbours(np.zeros(owned, np.uint64), np.zeros(owned, np.uint32), entries_for(room))
    level = of.level.astype(np.uint8)
    name_some(owned, low, lists, level, np.where(of.named, level, NOBODY), asked, same, lanes, found)
    return found


@compiled
def name_some(owned, low, lists, level, named, asked, same, lanes, found):
    """The entries of :func:`rows_that_name`, and how many each row has; ``named`` (columns,) are the levels
    of those whom rows may name, else NOBODY."""
    end, one = np.uint64(0), np.uint64(1)
    for row in range(np.uint64(owned)):
        k, begin = row + np.uint64(low), lists.begin[row]
        found.begin[row] = end
        if not asked[k]:
            continue
        own = level[k]
        for n in range(begin, begin + np.uint64(lists.lengths[row])):
            # Without a branch: at borders none is foretold.  What is not kept is written over.
            j = lists.lists[n]
            of = named[np.uint64(j)]
            found.lists[end] = j
            end += np.uint64((of != NOBODY) & ((of == own) == same))
        found.lengths[row] = end - found.begin[row]
        while (end - found.begin[row]) % np.uint64(lanes) != np.uint64(0):
            found.lists[end] = k
            end += one


@compiled
def find_beside(owned, low, lists, leads, beside):
    """Which of the rows of ``owned`` columns from ``low`` on name anyone who ``leads`` (columns,)."""
    for row in range(np.uint64(owned)):
        n, end = lists.begin[row], lists.begin[row] + np.uint64(lists.lengths[row])
        while n < end and not beside[row]:
            beside[row] = leads[np.uint64(lists.lists[n])]
            n += np.uint64(1)


@compiled
def keep_level(owned, low, lists, level, leads, beside):
    """Leave in each row those of its particle's own ``level`` (columns,), in the same order; what is left of
    it ends with the particle itself.  Rows ``beside`` (owned,) name anyone who ``leads`` (columns,)."""
    for row in range(np.uint64(owned)):
        k, begin = row + np.uint64(low), lists.begin[row]
        end, kept = begin + np.uint64(lists.lengths[row]), begin
        own, seen = level[k], False
        for n in range(begin, end):
            j = lists.lists[n]
            alike = level[np.uint64(j)] == own
            lists.lists[kept] = j
            kept += np.uint64(alike)
            seen |= alike & leads[np.uint64(j)]
        for n in range(kept, end):
            lists.lists[n] = k
        lists.lengths[row] = kept - begin
        beside[row] = seen
