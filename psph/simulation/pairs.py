"""The pair loop: one pass over the neighbours for every effect of the scene."""

from typing import Any, NamedTuple

import numpy as np

from psph.composition import terms
from psph.composition.loads import by_fluid, completed, is_due
from psph.composition.mirrors import at_look, ends, image, looks
from psph.composition.pair import fetch, geometry, take
from psph.composition.space import difference, softened
from psph.composition.terms import added, asked, plus_held, pushed, store
from psph.engine.jit import compiled
from psph.engine.simd import spread, total, width_of
from psph.vectors import zero_like


class Summed(NamedTuple):
    """What a pass sums: its ``effects``, and the ``reductions``, those with a sum of their own; ``loads``
    says for which groups, if not for all (psph.composition.loads)."""

    effects: tuple
    reductions: tuple
    loads: Any = None


class Metric(NamedTuple):
    """How a pair is weighed: the smoothing ``kernel``, the ``space`` of its positions, and the
    ``softening`` that puts lanes behind the end of a row out of reach (psph.composition.space)."""

    kernel: Any
    space: Any
    softening: Any


class Around(NamedTuple):
    """The neighbours: ``records`` of what is read of them, as ``shown`` says, the ``lists`` of the
    particles from column ``low`` on (psph.particles.neighbours), and the ``mirrors`` that show them once
    more (psph.composition.mirrors), or None."""

    shown: Any
    records: Any
    low: Any
    lists: Any
    mirrors: Any


class Sums(NamedTuple):
    """Where sums go: the array, or None, that each reduction fills; ``acceleration`` and
    ``density_rate`` are None in a pass that gathers sums alone, or one of them where another pass sums it:
    then the loop has no term of it.  What an earlier pass summed of both, for this step and others, is
    ``held`` and ``held_rate``: they come besides, where they are not None."""

    acceleration: Any
    density_rate: Any
    written: tuple
    held: Any = None
    held_rate: Any = None


@compiled
def sum_over_neighbours(first, last, summed, metric, view, around, sums):
    """Rates of the particles in columns ``first`` to ``last``, which ``view`` shows.

    Sums are in gather form and in the order of the lists, so that they are the same on any number of
    ranks.
    """
    effects, reductions, loads = summed.effects, summed.reductions, summed.loads
    forces, rates = asked(sums.acceleration, effects), asked(sums.density_rate, effects)
    records, lists, mirrors = around.records, around.lists, around.mirrors
    for k in range(np.uint64(first), np.uint64(last)):
        if not is_due(loads, k):
            continue
        row = k - np.uint64(around.low)
        i = take(view, k)
        if not terms.concerns(effects, reductions, i):
            continue
        rate = spread(0.0, records)
        a = spread(zero_like(i.position), records)
        totals = spread(terms.start(reductions, i), records)
        for look in range(looks(mirrors, i)):
            begin = lists.begin[row]
            end = begin + np.uint64(lists.lengths[row])
            begin, end = ends(mirrors, look, begin, end, k, i)
            reflection = at_look(mirrors, look)
            for n in range(begin, end, width_of(records)):
                j = image(reflection, i, fetch(around.shown, records, lists.lists, n))
                x_ij = difference(metric.space, i, j, records, k)
                pair = geometry(metric.kernel, x_ij, softened(metric.softening, end - n), i, j)
                rate = rate + terms.density_rate(rates, i, j, pair)
                a = pushed(a, pair.x_ij, by_fluid(loads, j, pair, terms.radial(forces, i, j, pair)))
                a = pushed(a, pair.u_ij, by_fluid(loads, j, pair, terms.shear(forces, i, j, pair)))
                a = added(a, by_fluid(loads, j, pair, terms.push(forces, i, j, pair)))
                totals = terms.gather_each(reductions, totals, i, j, pair)
        folded = terms.fold_each(reductions, totals)
        whole = completed(loads, forces, reductions, folded, i, total(a))
        store(sums.acceleration, k, plus_held(sums.held, k, whole))
        store(sums.density_rate, k, plus_held(sums.held_rate, k, total(rate)))
        terms.finish_value(reductions, folded, i, metric.kernel, k, sums.written)
