"""Elastic solids that are inside each other, or in a wall: what ends a run."""

import math

import numpy as np

from psph.engine.jit import compiled
from psph.engine.settled import settled
from psph.engine.threads import in_threads
from psph.parallel.reductions import largest
from psph.physics.solid.contact import REACH
from psph.vectors import at, dot, nearest_image, subtract
from psph.work import Work


class SolidOverlap(Work):
    """Solids of a ``rank`` that touch: whether some are inside others; in a fluid by the lists of an
    ``immersion`` (psph.simulation.immersion)."""

    def __init__(self, rank, immersion=None):
        self._spacing, self._domain, self._immersion = rank.scene.spacing, rank.domain, immersion

    def overlapping(self, store, depth: float) -> np.ndarray | None:
        """The particles of this rank that are more than ``depth`` spacings inside another solid, a body or a
        wall; None where there are none on any rank."""
        lists = self._immersion.contact.lists if self._immersion else self._domain.lists
        crowded = inside_others(store, self._domain, lists, self._spacing, depth)
        return crowded.astype(float) if largest(self._domain.comm, [crowded.any()])[0] > 0.0 else None

    def overlap_words(self, number: int, key: str) -> str:
        """Who is inside."""
        return f"particle {number} of {key} is inside another solid, a body or a wall"


def inside_others(store, domain, lists, spacing: float, depth: float) -> np.ndarray:
    """True for each particle of this rank (owned,) that is more than ``depth`` spacings inside another solid
    or a wall, by the part of its neighbourhood that these fill.

    The weight 1 − r²/R², R = 2.5dx, of the particles of others in its ``lists`` is compared with what is
    within R before a plane ``depth`` behind the particle.
    """
    low, crowding = store.low, np.zeros(store.owned)
    seen = lists, store["position"], domain.periods, REACH * spacing
    in_threads(settled(crowd), low, low + store.owned, low, *seen, crowding)
    return crowding > filled(depth / REACH, store.dimensions) * whole(store.dimensions)


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
