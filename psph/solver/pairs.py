"""The pair loop: one pass over the neighbours for every effect of the scene."""

import numpy as np

from psph.jit import compiled
from psph.physics import compose
from psph.physics.compose import geometry, take
from psph.vectors import add, put, scale, zero_like

TINY = 1e-20
"""r² + TINY h² keeps two particles at one place from dividing by zero; too small to change any
other distance."""


@compiled
def sum_over_neighbours(
    effects, reductions, kernel, periods, tiny, view, first, last, low, begin, blocks, lists,
    acceleration, density_rate, written,
):
    """Rates of the particles in columns ``first`` to ``last``.

    ``effects`` is the scene's tuple, ``reductions`` those with a sum of their own and ``written``
    the array, or None, that each of these fills.  Sums are in gather form and in the order of the
    lists, so that they are the same on any number of ranks.
    """
    for k in range(np.uint64(first), np.uint64(last)):
        row = k - np.uint64(low)
        i = take(view, k)
        rate = 0.0
        a = zero_like(i.position)
        totals = compose.start(reductions, i, kernel)
        entry = begin[row]
        for n in range(blocks[row] * np.uint64(8)):
            j = take(view, lists[entry + n])
            pair = geometry(kernel, periods, tiny, i, j)
            rate += compose.density_rate(effects, i, j, pair)
            a = add(a, scale(pair.x_ij, compose.radial(effects, i, j, pair)))
            a = add(a, scale(pair.u_ij, compose.shear(effects, i, j, pair)))
            totals = compose.gather(reductions, totals, i, j, pair)
        a = add(a, compose.finish_acceleration(reductions, totals, i))
        put(acceleration, k, add(a, compose.body(effects, i)))
        density_rate[k] = rate
        compose.finish_value(reductions, totals, i, k, written)
