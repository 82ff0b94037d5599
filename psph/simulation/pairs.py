"""The pair loop: one pass over the neighbours for every effect of the scene."""

import numpy as np

from psph.engine.jit import compiled
from psph.engine.simd import spread, total, width_of
from psph.physics import compose
from psph.physics.compose import added, fetch, geometry, pushed, take
from psph.physics.space import difference, softened
from psph.vectors import add, put, zero_like


@compiled
def sum_over_neighbours(
    first,
    last,
    effects,
    reductions,
    kernel,
    space,
    softening,
    view,
    neighbour_view,
    records,
    low,
    begin,
    lengths,
    lists,
    acceleration,
    density_rate,
    written,
):
    """Rates of the particles in columns ``first`` to ``last``.

    ``view`` shows the particles themselves, ``records`` what is read of neighbours, as
    ``neighbour_view`` says.  ``effects`` is the scene's tuple, ``reductions`` those with a sum of
    their own and ``written``
    the array, or None, that each of these fills; ``acceleration`` and ``density_rate`` are None in a
    pass that gathers sums alone.  ``softening`` (psph.physics.space) puts lanes
    behind the end of a row out of reach.  Sums are in gather form and in the order of the
    lists, so that they are the same on any number of ranks.
    """
    for k in range(np.uint64(first), np.uint64(last)):
        row = k - np.uint64(low)
        i = take(view, k)
        rate = spread(0.0, records)
        a = spread(zero_like(i.position), records)
        totals = spread(compose.start(reductions, i), records)
        end = begin[row] + np.uint64(lengths[row])
        for n in range(begin[row], end, width_of(records)):
            added_to_r2 = softened(softening, end - n)
            j = fetch(neighbour_view, records, lists, n)
            pair = geometry(kernel, difference(space, i, j, records, k), added_to_r2, i, j)
            rate = rate + compose.density_rate(effects, i, j, pair)
            a = pushed(a, pair.x_ij, compose.radial(effects, i, j, pair))
            a = pushed(a, pair.u_ij, compose.shear(effects, i, j, pair))
            a = added(a, compose.push(effects, i, j, pair))
            totals = compose.gather_each(reductions, totals, i, j, pair)
        sums = compose.fold_each(reductions, totals)
        force = add(total(a), compose.finish_acceleration(reductions, sums, i))
        if acceleration is not None:
            put(acceleration, k, add(force, compose.body(effects, i)))
            density_rate[k] = total(rate)
        compose.finish_value(reductions, sums, i, kernel, k, written)
