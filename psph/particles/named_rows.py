"""Rows of some particles, those of their entries alone that are asked for."""

import numpy as np

from psph.engine.jit import compiled
from psph.particles.neighbours import Neighbours, empty, entries_for
from psph.particles.store import SPARE


class Naming:
    """Rows that name some alone, filled up to a multiple of ``lanes`` with the particle itself; they stand
    where those did that were found before."""

    def __init__(self, lanes: int):
        self._lanes, self._room = lanes, empty(0, 0)

    def find(
        self, lists: Neighbours, low: int, owned: int, named: np.ndarray, asked: np.ndarray
    ) -> Neighbours:
        """Rows of those ``owned`` columns from ``low`` on that are ``asked`` (columns,): those of their
        entries in ``lists`` that are ``named`` (columns,), in the same order; all other rows are empty."""
        most = np.where(asked[low : low + owned], lists.lengths[:owned], 0).astype(np.int64)
        needed, found = int((-(-most // self._lanes) * self._lanes).sum()), empty(owned, 0)
        if len(self._room.lists) < needed:
            self._room = self._room._replace(lists=entries_for(needed + needed // SPARE))
        self._room = found._replace(lists=self._room.lists)
        name_some(owned, low, lists, named, asked, self._lanes, self._room)
        return self._room


@compiled
def name_some(owned, low, lists, named, asked, lanes, found):
    """The entries of :meth:`Naming.find`, and how many each row has."""
    end, one = np.uint64(0), np.uint64(1)
    for row in range(np.uint64(owned)):
        k, begin = row + np.uint64(low), lists.begin[row]
        found.begin[row] = end
        if not asked[k]:
            continue
        for n in range(begin, begin + np.uint64(lists.lengths[row])):
            # Without a branch: at borders none is foretold.  What is not kept is written over.
            j = lists.lists[n]
            found.lists[end] = j
            end += np.uint64(named[np.uint64(j)])
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
