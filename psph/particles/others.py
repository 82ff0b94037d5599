"""Lists that name particles of other solids alone."""

import numpy as np

from psph.engine.jit import compiled


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
