"""Elastic solids that are inside each other, or in a wall: what ends a run."""

import math

import numpy as np

from psph.engine.jit import compiled
from psph.engine.settled import settled
from psph.engine.threads import in_threads
from psph.physics.solid.contact import REACH
from psph.simulation.immersion import Immersion
from psph.vectors import at, dot, nearest_image, subtract


def inside_others(engine, spacing: float, depth: float) -> np.ndarray:
    """True for each particle of this rank (owned,) that is more than ``depth`` spacings inside another solid
    or a wall, by the part of its neighbourhood that these fill.

    The weight 1 − r²/R², R = 2.5dx, of the particles of others is compared with what is within R before a
    plane ``depth`` behind the particle.  Where solids do not touch, nothing is inside.
    """
    store, low = engine.store, engine.store.low
    found = np.zeros(store.owned)
    if not engine.plan.touching:
        return found > 0.0
    wet = engine.of_kind(Immersion)
    lists = wet.contact.lists if wet else engine.domain.lists
    seen = lists, store["position"], engine.domain.periods, REACH * spacing
    in_threads(settled(crowd), low, low + store.owned, low, *seen, found)
    return found > filled(depth / REACH, store.dimensions) * whole(store.dimensions)


def whole(dimensions: int) -> float:
    """The sum of the weights of a lattice around a particle."""
    return {2: math.pi / 2.0 * REACH**2, 3: 8.0 * math.pi / 15.0 * REACH**3}[dimensions]


def filled(depth: float, dimensions: int) -> float:
    """The part of them that is before a plane ``depth`` radii behind the particle."""
    z = min(depth, 1.0)
    if dimensions == 3:
        return 0.5 + (15.0 * z - 10.0 * z**3 + 3.0 * z**5) / 16.0
    return 0.5 + (z * (5.0 - 2.0 * z * z) * math.sqrt(1.0 - z * z) + 3.0 * math.asin(z)) / (3.0 * math.pi)


@compiled
def crowd(first, last, low, lists, position, periods, reach, found):
    """The weights of the neighbours of the columns ``first`` to ``last``, all of which are of others."""
    for k in range(np.uint64(first), np.uint64(last)):
        row = k - np.uint64(low)
        begin, total = lists.begin[row], 0.0
        for n in range(begin, begin + np.uint64(lists.lengths[row])):
            apart = nearest_image(subtract(at(position, lists.lists[n]), at(position, k)), periods)
            total += max(1.0 - dot(apart, apart) / (reach * reach), 0.0)
        found[row] = total
