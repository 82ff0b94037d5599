"""Particles of many sizes: how far lists and cells reach where each particle has its own smoothing length."""

import math
from typing import NamedTuple

import numpy as np

from psph.errors import Failed

GROWTH = 1.1
"""By how much a smoothing length may grow before lists are made anew, where particles have strayed by half of
their skin."""

LEAST_GROWTH = 1.02
"""Lists are made anew where they reach no farther than for lengths that have grown by this."""

ROUNDED = 4e-6
"""Part of a reach by which lists may fall short of it: they are made in single precision, and name nobody who
is farther, whom a ghost would have to stand for."""

CUTOFFS_A_PERIOD = 3.0
"""A period holds so many cutoffs at the least: the nearest image is the only one in reach."""


class TooLarge(Failed):
    """Particles that reach too far for the period of the domain."""


class Sizes(NamedTuple):
    """Where sizes differ: the kernel's ``support`` over h, the ``skin`` as a part of it, and the names of the
    fields that hold h, the ``length``, and that of when lists were made, ``listed``; ``between`` is the
    shortest distance of two mirrors across one axis, m.  Lists reach ``growth`` + ``skin`` times the support:
    the ways that both of a pair have strayed, and what lengths have grown by, share what is more than 1.
    ``across`` (groups,) says which groups list others of all levels of sizes, each as far as that one
    reaches, and not of their own alone; None: all do, as far as one of the two reaches.  Nobody ``strays``
    farther, m, from where lists were made.  Where lists last, the skin narrows down to the ``least``, with
    new ones so many times as ``dear`` as the pairs of a step; None: it stays."""

    support: float
    skin: float
    length: str
    listed: str
    between: float = math.inf
    growth: float = GROWTH
    across: np.ndarray | None = None
    strays: float = math.inf
    least: float | None = None
    dear: float = 1.0

    def reach(self, length):
        """Distance up to which a particle lists others, m, by its smoothing ``length``."""
        return (self.growth + self.skin) * self.support * length

    @property
    def mutual(self) -> bool:
        """Whether a particle lists all that it reaches itself, and not only those that reach it."""
        return self.across is None

    def looks_across(self, group: np.ndarray) -> np.ndarray:
        """Whether particles of some ``group`` (n,) list others of all levels (n,)."""
        return np.ones(len(group), np.bool_) if self.across is None else self.across[group]

    @property
    def grow(self) -> bool:
        """Whether sizes change in time."""
        return self.growth > 1.0

    @property
    def least_growth(self) -> float:
        """Growth for which lists have to reach at the least."""
        return min(self.growth, LEAST_GROWTH)

    def growth_left(self, strayed, most: float):
        """By how much h may have grown since lists were made, of particles that have ``strayed`` by this part
        of their support then, and others by this at the ``most``."""
        return (1.0 - ROUNDED) * (self.growth + self.skin) - strayed - most

    def cutoff(self, longest: float, periods) -> float:
        """How far lists reach, m, by the ``longest`` smoothing length of all; raises TooLarge where that does
        not fit into the ``periods`` of the domain, m or None, or between two mirrors."""
        found = self.reach(longest)
        for axis, period in zip("xyz", periods):
            if period is not None and CUTOFFS_A_PERIOD * found > period:
                raise TooLarge(
                    f"space.periodic: {axis} is {period:g} m long, less than {CUTOFFS_A_PERIOD:g} times the "
                    f"{found:.4g} m that a particle with a smoothing length of {longest:.4g} m reaches; give "
                    "a longer domain (space.upper), a smaller space.spacing, or an earlier time.end"
                )
        if found > self.between:
            raise TooLarge(
                f"space.symmetry: two mirrors are {self.between:g} m apart, less than the {found:.4g} m that "
                f"a particle with a smoothing length of {longest:.4g} m reaches; put them farther apart, or "
                "give a smaller space.spacing or an earlier time.end"
            )
        return found
