"""Lists of pairs that the ordinary passes do not see: those with a particle that is apart (psph.kinds)."""

import numpy as np

from psph.engine.jit import compiled
from psph.particles.neighbours import Neighbours, entries_for


def part(lists: Neighbours, store, apart: np.ndarray, lanes: int) -> Neighbours:
    """Take the pairs with a particle that is ``apart`` (columns,) out of the ``lists`` of a store.

    They are returned, in the same order, in rows of their own that are padded alike.
    """
    lengths = np.zeros(len(lists.lengths), np.uint32)
    count_apart(store.owned, store.low, lists, apart, lengths)
    padded = -(-lengths.astype(np.uint64) // np.uint64(lanes)) * np.uint64(lanes)
    ends = np.cumsum(padded, dtype=np.uint64)
    total = int(ends[-1]) if len(ends) else 0
    parted = Neighbours(ends - padded, lengths, entries_for(total))
    move_apart(store.owned, store.low, lists, apart, parted, padded)
    return parted


@compiled
def count_apart(owned, low, lists, apart, lengths):
    """The ``lengths`` of the rows of pairs that are apart."""
    for row in range(np.uint64(owned)):
        k, begin = row + np.uint64(low), lists.begin[row]
        for n in range(begin, begin + np.uint64(lists.lengths[row])):
            lengths[row] += np.uint32(apart[k] or apart[np.uint64(lists.lists[n])])


@compiled
def move_apart(owned, low, lists, apart, own, padded):
    """Move these pairs to the rows of ``own``, each as long as ``padded`` says with the particle itself."""
    one = np.uint64(1)
    for row in range(np.uint64(owned)):
        k, begin = row + np.uint64(low), lists.begin[row]
        end, kept, moved = begin + np.uint64(lists.lengths[row]), begin, own.begin[row]
        for n in range(begin, end):
            j = np.uint64(lists.lists[n])
            if apart[k] or apart[j]:
                own.lists[moved] = j
                moved += one
            else:
                lists.lists[kept] = j
                kept += one
        for n in range(kept, end):
            lists.lists[n] = k
        for n in range(moved, own.begin[row] + padded[row]):
            own.lists[n] = k
        lists.lengths[row] = kept - begin
