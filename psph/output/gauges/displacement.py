"""Displacement of a point of a solid."""

from typing import NamedTuple

import numpy as np

from psph.fields import CROSSED
from psph.parallel.reductions import exact_sums

REACH = 2.5
"""Spacings from the point within which particles count."""


class DisplacementGauge(NamedTuple):
    """How far a point ``at`` (dim,) in m of a solid, whose particles have the ``groups``, has moved, m.

    A straight function u = a + G(X − X_p) is fitted to the displacements of the particles within ``reach`` m
    of it in the reference, with the weights (1 − (|X − X_p|/reach)²)²: so a point on the face is not half a
    spacing off.  Where a domain repeats, each time that a particle has crossed it counts.
    """

    name: str
    every: float
    groups: tuple[int, ...]
    at: tuple[float, ...]
    reach: float

    def columns(self, scene) -> list[str]:
        """Their names, without the time."""
        return [f"{self.name}.displacement_{axis}" for axis in "xyz"[: scene.dimensions]]

    def row(self, simulation) -> list[float]:
        """The values, the same on every rank."""
        store, periods = simulation.store, simulation.domain.periods
        d = store.dimensions
        own = np.isin(store.shown("group"), self.groups)
        reference = store.shown("reference")[own]
        away, moved = reference - np.array(self.at), store.shown("position")[own] - reference
        for axis, period in enumerate(periods):
            if period is not None:
                away[:, axis] -= period * np.rint(away[:, axis] / period)
                moved[:, axis] += period * store.shown(CROSSED.name)[own, axis]
        weight = np.maximum(1.0 - (away**2).sum(axis=1) / self.reach**2, 0.0) ** 2
        basis = np.column_stack([np.ones(len(away)), away / self.reach])
        squares = weight[:, None, None] * basis[:, :, None] * basis[:, None, :]
        values = weight[:, None, None] * basis[:, :, None] * moved[:, None, :]
        flat = (table.reshape(len(away), (1 + d) * table.shape[2]) for table in (squares, values))
        sums = exact_sums(simulation.comm, np.column_stack([*flat]))
        matrix, right = sums[: (1 + d) ** 2].reshape(1 + d, 1 + d), sums[(1 + d) ** 2 :].reshape(1 + d, d)
        return np.linalg.lstsq(matrix, right, rcond=1e-9)[0][0].tolist()
