"""Displacement of a point of a solid."""

from typing import NamedTuple

import numpy as np

from psph.fields import CROSSED
from psph.output.gauges.fit import fitted, nearest


class DisplacementGauge(NamedTuple):
    """How far a point ``at`` (dim,) in m of a solid, whose particles have the ``groups``, has moved, m.

    By the straight function that fits the displacements of the particles within ``reach`` m of it in the
    reference (psph.output.gauges.fit).  Where a domain repeats, each time that a particle has crossed it
    counts.
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
        own = np.isin(store.shown("group"), self.groups)
        reference = store.shown("reference")[own]
        away = nearest(reference - np.array(self.at), periods)
        moved = store.shown("position")[own] - reference
        for axis, period in enumerate(periods):
            if period is not None:
                moved[:, axis] += period * store.shown(CROSSED.name)[own, axis]
        return fitted(simulation.comm, away, self.reach, moved).tolist()
