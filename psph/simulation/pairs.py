"""The pair loop: one pass over the neighbours for every effect of the scene."""

from typing import Any, NamedTuple

import numpy as np
from numba.core import types

from psph.composition import terms
from psph.composition.mirrors import at_look, ends, image, looks
from psph.composition.pair import fetch, geometry, take
from psph.composition.space import difference, softened
from psph.composition.terms import added, pushed, store
from psph.engine.jit import compiled, overload
from psph.engine.simd import spread, total, width_of
from psph.vectors import add, scale, subtract, zero_like


class Summed(NamedTuple):
    """What a pass sums: its ``effects``, and the ``reductions``, those with a sum of their own."""

    effects: tuple
    reductions: tuple


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
    ``density_rate`` are None in a pass that gathers sums alone; ``pressed`` takes the part of the
    acceleration that is by fluid neighbours, or is None where nobody asks for it."""

    acceleration: Any
    density_rate: Any
    pressed: Any
    written: tuple


def gained(pressed, by_fluid, before, now, j):
    """What fluid neighbours j have added from ``before`` to ``now``; nothing where nobody asks for it."""
    return by_fluid if pressed is None else _gained(pressed, by_fluid, before, now, j)


def _gained(pressed, by_fluid, before, now, j):
    return add(by_fluid, scale(subtract(now, before), j.is_fluid))


@overload(gained)
def _typed_gained(pressed, by_fluid, before, now, j):
    if isinstance(pressed, types.NoneType):
        return lambda pressed, by_fluid, before, now, j: by_fluid
    return _gained


@compiled
def sum_over_neighbours(first, last, summed, metric, view, around, sums):
    """Rates of the particles in columns ``first`` to ``last``, which ``view`` shows.

    Sums are in gather form and in the order of the lists, so that they are the same on any number of
    ranks.
    """
    effects, reductions = summed.effects, summed.reductions
    records, lists, mirrors = around.records, around.lists, around.mirrors
    for k in range(np.uint64(first), np.uint64(last)):
        row = k - np.uint64(around.low)
        i = take(view, k)
        if not terms.concerns(effects, reductions, i):
            continue
        rate = spread(0.0, records)
        a = spread(zero_like(i.position), records)
        by_fluid = spread(zero_like(i.position), records)
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
                before = a
                rate = rate + terms.density_rate(effects, i, j, pair)
                a = pushed(a, pair.x_ij, terms.radial(effects, i, j, pair))
                a = pushed(a, pair.u_ij, terms.shear(effects, i, j, pair))
                a = added(a, terms.push(effects, i, j, pair))
                by_fluid = gained(sums.pressed, by_fluid, before, a, j)
                totals = terms.gather_each(reductions, totals, i, j, pair)
        folded = terms.fold_each(reductions, totals)
        force = add(total(a), terms.finish_acceleration(reductions, folded, i))
        store(sums.acceleration, k, add(force, terms.body(effects, i)))
        store(sums.density_rate, k, total(rate))
        store(sums.pressed, k, total(by_fluid))
        terms.finish_value(reductions, folded, i, metric.kernel, k, sums.written)
