"""How the shares of solids in three dimensions are found (psph.physics.solid.shares)."""

from collections.abc import Callable

import numpy as np

from psph.composition.pair import fetch, take
from psph.composition.space import softened
from psph.engine.jit import compiled
from psph.engine.simd import spread, total, width_of
from psph.engine.threads import in_threads
from psph.physics.solid.shares import bounded, wish
from psph.simulation.solid_pairs import Rows, stretched
from psph.simulation.solid_table import SolidRecords
from psph.smoothing import weight
from psph.vectors import dot, nearest_image, subtract

GIVEN = "given"
"""What is read of partners, to be summed."""


def shares_of(weights, seen: SolidRecords, lists, held: np.ndarray, bring: Callable) -> np.ndarray:
    """w (rows,) of the first places in ``seen``, of which some are ``held`` by clamps; ``lists`` have all
    their neighbours in the reference.  ``bring`` fetches a column of a table from other ranks: collective."""
    rows, d = len(held), len(seen.view.reference)
    table = SolidRecords({"reference": d, GIVEN: 1}, len(seen.records), 1.0)
    begin, end = seen.places["reference"]
    table.records[:, :d] = seen.records[:, begin:end]
    around = Rows(table.view, table.records, lists)

    def smoothed(given: np.ndarray) -> np.ndarray:
        smoothed = np.zeros(rows)
        table.records[:rows, d] = given
        bring(table, GIVEN)
        if rows:
            in_threads(smooth, 0, rows, weights, around, smoothed)
        return smoothed

    volume = seen.view.volume
    q = wish(smoothed(np.full(rows, volume)))
    return bounded(q * smoothed(volume / smoothed(volume * q)), held)


@compiled
def smooth(first, last, weights, rows, found):
    """Σ_j W_ij x_j of what is ``given``, over each of the rows ``first`` to ``last`` and its neighbours."""
    records, lists = rows.records, rows.lists
    for k in range(np.uint64(first), np.uint64(last)):
        i = take(rows.shown, k)
        begin = lists.begin[k]
        end = begin + np.uint64(lists.lengths[k])
        sums = spread(0.0, records)
        for n in range(begin, end, width_of(records)):
            j = fetch(rows.shown, records, lists.lists, n)
            apart = nearest_image(subtract(i.reference, j.reference), weights.periods)
            r = stretched(weights.finer, k, np.sqrt(dot(apart, apart) + softened(weights.softening, end - n)))
            sums = sums + j.given * weight(weights.kernel, r)
        found[k] = i.given * weight(weights.kernel, 0.0) + total(sums)
