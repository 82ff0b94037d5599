"""Errors of the fluid against the exact solution of its case."""

from collections.abc import Iterator

import numpy as np
from mpi4py import MPI

from psph.fields import FLUID, GAS
from psph.parallel.domain import Domain
from psph.parallel.reductions import exact_sums, largest
from psph.scene.levels import LENGTH
from psph.theory.solutions.catalogue import known
from psph.theory.solutions.setting import Setting

NORMS = ("l1", "l2", "linf")
"""Σ|e|/Σ|f|, √(Σe²/Σf²) and max|e|/max|f| over the fluid's particles, f the exact values."""


class Accuracy:
    """Errors of a domain's fluid against an exact solution; every method is collective."""

    def __init__(self, domain: Domain, solution, setting: Setting):
        self.domain, self.solution, self.setting = domain, solution, setting
        self.fields = known(solution)

    def columns(self) -> list[str]:
        """Names of the values: ``velocity_l1``, ``velocity_l2``, ``velocity_linf``, ..."""
        return [f"{field}_{norm}" for field in self.fields for norm in NORMS]

    def errors(self, time: float) -> list[float]:
        """Relative errors at ``time`` s in the order of :meth:`columns`.

        NaN where the exact field is zero everywhere.  The same bits on any number of ranks.
        """
        store = self.domain.store
        fluid = np.isin(store.owned_rows("kind"), (FLUID, GAS))
        x = self.domain.inside(store.owned_rows("position"))[fluid]
        weight = self._weight()[fluid]
        errors: list[float] = []
        for field in self.fields:
            exact = getattr(self.solution, field)(x, time, self.setting)
            off = store.owned_rows(field)[fluid] - exact
            if field in self.solution.up_to_a_constant:
                off, exact = off - self._mean(off, weight), exact - self._mean(exact, weight)
            errors += norms(self.domain.comm, _size(off), _size(exact), weight)
        return errors

    def _weight(self) -> np.ndarray:
        """How much each particle counts: 1, or its volume in units of the coarsest where levels of sizes
        differ."""
        store = self.domain.store
        if LENGTH not in store.rows:
            return np.ones(store.owned)
        return (store.owned_rows(LENGTH) / store.constants["smoothing_length"]) ** store.dimensions

    def _mean(self, values: np.ndarray, weight: np.ndarray) -> float:
        total, count = exact_sums(self.domain.comm, np.column_stack([values * weight, weight]))
        return total / count


def norms(comm: MPI.Comm, error: np.ndarray, size: np.ndarray, weight: np.ndarray) -> Iterator[float]:
    """The three norms of |e| over those of |f|, both (n,) of this rank, by their ``weight``; collective."""
    sums = exact_sums(comm, weight[:, None] * np.column_stack([error, size, error**2, size**2]))
    tops = largest(comm, [error.max(initial=0.0), size.max(initial=0.0)])
    with np.errstate(invalid="ignore", divide="ignore"):
        l1, l2 = np.divide(sums[0], sums[1]), np.sqrt(np.divide(sums[2], sums[3]))
        yield from (float(l1), float(l2), float(np.divide(tops[0], tops[1])))


def _size(values: np.ndarray) -> np.ndarray:
    """|f| of each particle."""
    return np.abs(values) if values.ndim == 1 else np.sqrt((values**2).sum(axis=1))
