"""Particles of many sizes: how far lists and cells reach where each particle has its own smoothing length."""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import elementwise
from psph.errors import Failed
from psph.particles.neighbours import Neighbours
from psph.vectors import at, dot, nearest_image, subtract

GROWTH = 1.1
"""By how much a smoothing length may grow before lists are made anew."""

CUTOFFS_A_PERIOD = 3.0
"""A period holds so many cutoffs at the least: the nearest image is the only one in reach."""


class TooLarge(Failed):
    """Particles that reach too far for the period of the domain."""


class Sizes(NamedTuple):
    """Where sizes differ: the kernel's ``support`` over h, the ``skin`` in m, and the names of the fields
    that hold h, the ``length``, and that of when lists were made, ``listed``."""

    support: float
    skin: float
    length: str
    listed: str

    def reach(self, length):
        """Distance up to which a particle lists others, m, by its smoothing ``length``."""
        return GROWTH * self.support * length

    def cutoff(self, longest: float, periods) -> float:
        """How far lists reach, m, by the ``longest`` smoothing length of all; raises TooLarge where that does
        not fit into the ``periods`` of the domain, m or None."""
        found = self.reach(longest) + self.skin
        for axis, period in zip("xyz", periods):
            if period is not None and CUTOFFS_A_PERIOD * found > period:
                raise TooLarge(
                    f"a particle's smoothing length has grown to {longest:.4g} m: {CUTOFFS_A_PERIOD:g} times "
                    f"its reach is more than the period along {axis}, {period:g} m; give a longer domain or "
                    "more particles"
                )
        return found


def narrow(lists: Neighbours, store, sizes: Sizes, periods) -> None:
    """Take out of the ``lists`` of a store, which name all within the cutoff, those that neither of a pair
    reaches: what stays is within the larger reach of both, and the skin."""
    narrow_rows(
        store.owned,
        store.low,
        lists,
        store["position"],
        store[sizes.listed],
        GROWTH * sizes.support,
        sizes.skin,
        tuple(periods),
    )


@elementwise
def narrow_rows(owned, low, lists, position, listed, reach, skin, periods):
    """The same, by the ``listed`` lengths (columns,), m; rows are filled up with the particle itself."""
    for row in range(np.uint64(owned)):
        k, begin = row + np.uint64(low), lists.begin[row]
        end, kept = begin + np.uint64(lists.lengths[row]), begin
        for n in range(begin, end):
            j = np.uint64(lists.lists[n])
            x = nearest_image(subtract(at(position, k), at(position, j)), periods)
            within = reach * max(listed[k], listed[j]) + skin
            if dot(x, x) <= within * within:
                lists.lists[kept] = j
                kept += np.uint64(1)
        for n in range(kept, end):
            lists.lists[n] = k
        lists.lengths[row] = kept - begin
