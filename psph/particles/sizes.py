"""Particles of many sizes: how far lists and cells reach where each particle has its own smoothing length."""

import math
from typing import NamedTuple

from psph.errors import Failed

GROWTH = 1.1
"""By how much a smoothing length may grow before lists are made anew."""

CUTOFFS_A_PERIOD = 3.0
"""A period holds so many cutoffs at the least: the nearest image is the only one in reach."""


class TooLarge(Failed):
    """Particles that reach too far for the period of the domain."""


class Sizes(NamedTuple):
    """Where sizes differ: the kernel's ``support`` over h, the ``skin`` as a part of it, and the names of the
    fields that hold h, the ``length``, and that of when lists were made, ``listed``; ``between`` is the
    shortest distance of two mirrors across one axis, m; until new lists h may grow by ``growth``."""

    support: float
    skin: float
    length: str
    listed: str
    between: float = math.inf
    growth: float = GROWTH

    def reach(self, length):
        """Distance up to which a particle lists others, m, by its smoothing ``length``."""
        return (self.growth + self.skin) * self.support * length

    def stray(self, length):
        """Distance, m, by which a particle may stray that was listed with this smoothing ``length``."""
        return 0.5 * self.skin * self.support * length

    def cutoff(self, longest: float, periods) -> float:
        """How far lists reach, m, by the ``longest`` smoothing length of all; raises TooLarge where that does
        not fit into the ``periods`` of the domain, m or None, or between two mirrors."""
        found = self.reach(longest)
        for axis, period in zip("xyz", periods):
            if period is not None and CUTOFFS_A_PERIOD * found > period:
                raise TooLarge(
                    f"a particle's smoothing length is {longest:.4g} m: {CUTOFFS_A_PERIOD:g} times "
                    f"its reach is more than the period along {axis}, {period:g} m; give a longer domain or "
                    "more particles"
                )
        if found > self.between:
            raise TooLarge(
                f"a particle's smoothing length is {longest:.4g} m: its reach is more than the distance of "
                f"two mirrors, {self.between:g} m; put them farther apart, or give more particles"
            )
        return found
