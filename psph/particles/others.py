"""Lists that name particles of other solids alone."""

from collections.abc import Iterable

import numpy as np

from psph.engine.jit import compiled, register_jitable
from psph.engine.settled import settled
from psph.particles.neighbours import Neighbours
from psph.particles.partners import padded_lists


class Others:
    """Lists of those that may touch, where lists name all: another solid, and one of the two elastic.

    ``elastic`` are the numbers of elastic solids; a column has the number of its ``solid``, 0 of a fluid.
    """

    def __init__(self, elastic: Iterable[int]):
        numbers = sorted(set(elastic))
        self._elastic = np.zeros(256, bool)
        self._elastic[numbers] = True
        self._count, self._name = settled(count_others), settled(name_others)

    def beside(self, low: int, owned: int, lists: Neighbours, solid: np.ndarray, multiple: int) -> Neighbours:
        """Those of the ``owned`` particles from column ``low`` on, in the order of ``lists``."""
        seen = low, lists, solid, self._elastic
        counts = np.zeros(owned, np.int64)
        self._count(0, owned, *seen, counts)
        entries = np.zeros(int(counts.sum()), np.int64)
        self._name(0, owned, *seen, entries)
        return padded_lists(counts, entries, multiple, low)


@compiled
def count_others(first, last, low, lists, solid, elastic, counts):
    """How many particles beside each of some rows may touch it."""
    for row in range(np.uint64(first), np.uint64(last)):
        k, begin = row + np.uint64(low), lists.begin[row]
        for n in range(begin, begin + np.uint64(lists.lengths[row])):
            if meets(k, np.uint64(lists.lists[n]), solid, elastic):
                counts[row] += 1


@compiled
def name_others(first, last, low, lists, solid, elastic, entries):
    """Their columns, one row after another."""
    done = 0
    for row in range(np.uint64(first), np.uint64(last)):
        k, begin = row + np.uint64(low), lists.begin[row]
        for n in range(begin, begin + np.uint64(lists.lengths[row])):
            if meets(k, np.uint64(lists.lists[n]), solid, elastic):
                entries[done] = lists.lists[n]
                done += 1


@register_jitable
def meets(k, j, solid, elastic):
    """Whether the particles in the columns ``k`` and ``j`` may touch."""
    one, other = np.int64(solid[k]), np.int64(solid[j])
    return one != other and one > 0 and other > 0 and (elastic[one] or elastic[other])


@compiled
def keep_others(first, last, low, lists, solid):
    """Take the particles of its own ``solid`` out of the rows of the columns ``first`` to ``last``.

    What stays keeps its order.  ``lists`` are :class:`psph.particles.neighbours.Neighbours` of the particles
    from column ``low`` on, ``solid`` the number of each column's solid, ghosts among them.
    """
    one = np.uint64(1)
    for k in range(np.uint64(first), np.uint64(last)):
        row = k - np.uint64(low)
        begin = lists.begin[row]
        end = begin + np.uint64(lists.lengths[row])
        kept = begin
        for n in range(begin, end):
            j = np.uint64(lists.lists[n])
            if solid[j] != solid[k]:
                lists.lists[kept] = j
                kept += one
        for n in range(kept, end):
            lists.lists[n] = k
        lists.lengths[row] = kept - begin
