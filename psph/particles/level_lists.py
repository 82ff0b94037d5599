"""Lists where particles are of several levels of sizes: pairs of one level, and those who lead."""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import compiled
from psph.particles.neighbours import Neighbours, entries_for


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
    most = np.where(asked[low : low + owned], lists.lengths[:owned], 0).astype(np.uint64)
    room = -(-most // np.uint64(lanes)) * np.uint64(lanes)
    ends = np.cumsum(room, dtype=np.uint64)
    lengths = np.zeros(owned, np.uint32)
    found = Neighbours(ends - room, lengths, entries_for(int(ends[-1]) if owned else 0))
    name_some(owned, low, lists, of, asked, same, lanes, found)
    return found


@compiled
def name_some(owned, low, lists, of, asked, same, lanes, found):
    """The entries of :func:`rows_that_name`, and how many each row has."""
    one = np.uint64(1)
    for row in range(np.uint64(owned)):
        k, begin, end = row + np.uint64(low), lists.begin[row], found.begin[row]
        if not asked[k]:
            continue
        for n in range(begin, begin + np.uint64(lists.lengths[row])):
            j = np.uint64(lists.lists[n])
            if of.named[j] and (of.level[j] == of.level[k]) == same:
                found.lists[end] = j
                end += one
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
def keep_level(owned, low, lists, level):
    """Leave in each row those of its particle's own ``level`` (columns,), in the same order; what is left of
    it ends with the particle itself."""
    one = np.uint64(1)
    for row in range(np.uint64(owned)):
        k, begin = row + np.uint64(low), lists.begin[row]
        end, kept = begin + np.uint64(lists.lengths[row]), begin
        for n in range(begin, end):
            j = np.uint64(lists.lists[n])
            if level[j] == level[k]:
                lists.lists[kept] = j
                kept += one
        for n in range(kept, end):
            lists.lists[n] = k
        lists.lengths[row] = kept - begin
