"""Which walls have fluid in reach: found where the neighbours are listed."""

import numpy as np

from psph.engine.jit import compiled
from psph.vectors import at, dot, nearest_image, subtract


@compiled
def mark_wet(first, last, low, lists, support, cutoff, periods, position, group, bearing, is_fluid, wet):
    """``wet`` of the columns ``first`` to ``last``: 0 in a wall without fluid in reach, else 1.

    A wall becomes wet where fluid comes within the kernel's ``support``, m, and dry where it leaves the
    ``cutoff`` of the lists, m: between the two it stays what it was, so that water that trembles does not
    make a wall at the edge of its reach lose its pressure again and again.  ``lists`` are
    :class:`psph.particles.neighbours.Neighbours` of the particles from column ``low`` on; ``is_fluid`` 1
    in a fluid, else 0.  Particles of a ``group`` that is not ``bearing`` stay dry.
    """
    for k in range(np.uint64(first), np.uint64(last)):
        row = k - np.uint64(low)
        found = is_fluid[k]
        reach = cutoff if wet[k] > 0.0 else support
        n, end = lists.begin[row], lists.begin[row] + np.uint64(lists.lengths[row])
        while found == 0.0 and bearing[group[k]] and n < end:
            j = np.uint64(lists.lists[n])
            x = nearest_image(subtract(at(position, k), at(position, j)), periods)
            found = 1.0 if is_fluid[j] > 0.0 and dot(x, x) < reach * reach else 0.0
            n += np.uint64(1)
        wet[k] = found


FIRST_BODY = 2
"""Number of a first rigid body among solids: 0 is no solid, 1 a wall."""


@compiled
def rest_dry(first, last, low, lists, is_fluid, wet, group, bearing, solid, free, mirrored):
    """Rows of dry walls without any fluid in their lists become empty: nothing has to be summed for them.

    Nor for those of a rigid body, unless it may touch another solid: ``solid`` has the number of each
    column's, ghosts among them.  Where the scene is ``mirrored`` that may be its own image.  Of the columns
    ``first`` to ``last``, those of groups from number ``free`` on, which forces do not move.  One that is
    not ``bearing`` needs no sum even with fluid around.
    """
    for k in range(np.uint64(first), np.uint64(last)):
        row = k - np.uint64(low)
        n, end = lists.begin[row], lists.begin[row] + np.uint64(lists.lengths[row])
        idle = wet[k] == 0.0 and group[k] >= free and not (mirrored and solid[k] >= FIRST_BODY)
        while idle and bearing[group[k]] and n < end:
            j = np.uint64(lists.lists[n])
            idle = is_fluid[j] == 0.0 and (solid[k] < FIRST_BODY or solid[k] == solid[j])
            n += np.uint64(1)
        if idle:
            lists.lengths[row] = 0
