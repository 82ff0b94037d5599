"""Slabs: which rank owns which planes of cells, by what their particles cost there.

Sums are of integers, and the rest is done number by number: ranks on different processors decide
alike.
"""

import numpy as np

from psph.errors import Refused

TOLERATED = 1.05
"""A dearest slab this much above what a new partition would give is left as it is."""

PAR = 1024
"""Price of a particle where it costs what it does on average."""

NEW_SHARE = 4
"""A new measurement counts for one part in so many: noise of single intervals fades."""

EXTREME = 4
"""A measured price this much above or below par is an accident, and cut off."""

WORTH_MEASURING = 1_000_000
"""Nanoseconds of all ranks together below which a measurement is but noise."""


class TooManyRanks(Refused):
    """More ranks than planes of cells."""


def check_ranks(ranks: int, planes: int) -> None:
    """Raise TooManyRanks, with the largest usable number, where a rank would get no plane."""
    if ranks > planes:
        most = f"at most {planes} rank{'s' * (planes != 1)}"
        raise TooManyRanks(f"{ranks} ranks for {planes} plane{'s' * (planes != 1)} of cells: use {most}")


def partition(costs: np.ndarray, ranks: int) -> np.ndarray:
    """Cut the planes into slabs of about equal cost, at least one plane each.

    ``costs`` int64 (planes,); returns int64 (ranks + 1,) first planes.  Raises TooManyRanks with
    the largest usable number.
    """
    planes = len(costs)
    check_ranks(ranks, planes)
    reached = np.concatenate([[0], np.cumsum(costs)])
    rank = np.arange(ranks + 1)
    goals = float(reached[-1]) * (rank / ranks)
    # Each cut is at the boundary of planes that is nearest to its goal.
    above = np.clip(np.searchsorted(reached, goals), 1, planes)
    cuts = above - (goals - reached[above - 1] < reached[above] - goals)
    cuts[[0, ranks]] = 0, planes
    # A plane at least for each rank before a cut, and for each behind it.
    return rank + np.clip(np.maximum.accumulate(cuts - rank), 0, planes - ranks)


def dearest(costs: np.ndarray, bounds: np.ndarray) -> int:
    """Cost of the dearest slab."""
    reached = np.concatenate([[0], np.cumsum(costs)])
    return int(np.diff(reached[bounds]).max())


def rebalanced(costs: np.ndarray, bounds: np.ndarray | None, ranks: int) -> np.ndarray:
    """New slabs when they pay, else the old ones: the same decision on every rank.

    Raises TooManyRanks, also where a run had planes enough before: cells are as wide as the particle that
    reaches farthest, and only where particles are.
    """
    if bounds is not None and ranks > len(costs):
        raise TooManyRanks(
            f"it has come from {bounds[-1]} planes of cells to {len(costs)}, fewer than its {ranks} ranks: "
            "particles reach farther or draw together; resume it on fewer from its last checkpoint, "
            "or begin on fewer"
        )
    best = partition(costs, ranks)
    if bounds is None or bounds[-1] != len(costs):
        return best
    # Costs are whole numbers that all ranks have summed: none can keep what another gives up.
    keep = dearest(costs, bounds) <= TOLERATED * dearest(costs, best)
    return bounds if keep else best


class Prices:
    """What a particle costs on each rank, learnt from the time that the ranks took.

    A rank may be slow, or its particles have many neighbours.  The prices steer the slabs and
    nothing else: no result depends on them.  The same on every rank.
    """

    def __init__(self, ranks: int):
        self.each = np.full(ranks, PAR, np.int64)

    def learn(self, histogram: np.ndarray, bounds: np.ndarray, spent: np.ndarray) -> None:
        """Take in ``spent`` (ranks,), ns on the particles of each slab since the last time.

        ``histogram`` (planes,) particles in each plane, ``bounds`` (ranks + 1,) the slabs.
        """
        held = np.add.reduceat(histogram, _fitted(bounds, histogram)[:-1])
        known = (held > 0) & (spent > 0)
        if spent.sum() < WORTH_MEASURING or not known.any():
            return
        average = spent.sum() / held.sum()
        measured = PAR * (spent[known] / held[known] / average)
        measured = np.clip(measured, PAR // EXTREME, PAR * EXTREME).astype(np.int64)
        self.each[known] += (measured - self.each[known]) // NEW_SHARE

    def of_planes(self, histogram: np.ndarray, bounds: np.ndarray) -> np.ndarray:
        """What each plane costs where it is now, int64 (planes,)."""
        return histogram * np.repeat(self.each, np.diff(_fitted(bounds, histogram)))


def _fitted(bounds: np.ndarray, histogram: np.ndarray) -> np.ndarray:
    """The slabs on a grid of another size: about where they were."""
    return bounds * len(histogram) // bounds[-1]
