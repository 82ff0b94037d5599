"""Which walls have fluid in reach: found where the neighbours are listed."""

import numpy as np

from psph.engine.jit import compiled
from psph.vectors import at, dot, nearest_image, subtract


@compiled
def mark_wet(first, last, low, begin, lengths, lists, support2, periods, position, wall, wet):
    """``wet`` of the columns ``first`` to ``last``: 0 in a wall without fluid in reach, else 1.

    ``begin``, ``lengths`` and ``lists`` as in :class:`psph.particles.neighbours.Neighbours`;
    ``support2`` the square of the kernel's support, m²; ``wall`` 1 in a wall, 0 in a fluid.
    """
    for k in range(np.uint64(first), np.uint64(last)):
        row = k - np.uint64(low)
        found = 1.0 - wall[k]
        n, end = begin[row], begin[row] + np.uint64(lengths[row])
        while found == 0.0 and n < end:
            j = np.uint64(lists[n])
            x = nearest_image(subtract(at(position, k), at(position, j)), periods)
            found = 1.0 if wall[j] == 0.0 and dot(x, x) < support2 else 0.0
            n += np.uint64(1)
        wet[k] = found
