"""Slabs: which rank owns which planes of cells."""

import numpy as np

TOLERATED = 1.05
"""A fullest slab this much above what a new partition would give is left as it is."""


class TooManyRanks(ValueError):
    """More ranks than planes of cells."""


def check_ranks(ranks: int, planes: int) -> None:
    """Raise TooManyRanks, with the largest usable number, where a rank would get no plane."""
    if ranks > planes:
        raise TooManyRanks(
            f"{ranks} ranks for {planes} planes of cells: use at most {planes} ranks"
        )


def partition(histogram: np.ndarray, ranks: int) -> np.ndarray:
    """Cut the planes into slabs of about equal particle number, at least one plane each.

    ``histogram`` (planes,) particles in each plane; returns int64 (ranks + 1,) first planes.
    Raises TooManyRanks with the largest usable number.
    """
    planes = len(histogram)
    check_ranks(ranks, planes)
    reached = np.concatenate([[0], np.cumsum(histogram)])
    bounds = np.zeros(ranks + 1, np.int64)
    bounds[ranks] = planes
    for r in range(1, ranks):
        goal = reached[-1] * r / ranks
        cut = int(np.searchsorted(reached, goal))
        if cut > 0 and goal - reached[cut - 1] < reached[cut] - goal:
            cut -= 1
        bounds[r] = min(max(cut, bounds[r - 1] + 1), planes - (ranks - r))
    return bounds


def fullest(histogram: np.ndarray, bounds: np.ndarray) -> int:
    """Particles of the fullest slab."""
    reached = np.concatenate([[0], np.cumsum(histogram)])
    return int(np.diff(reached[bounds]).max())


def rebalanced(histogram: np.ndarray, bounds: np.ndarray | None, ranks: int) -> np.ndarray:
    """New slabs when they pay, else the old ones: a decision on global counts alone."""
    best = partition(histogram, ranks)
    if bounds is None or bounds[-1] != len(histogram):
        return best
    keep = fullest(histogram, bounds) <= TOLERATED * fullest(histogram, best)
    return bounds if keep else best
