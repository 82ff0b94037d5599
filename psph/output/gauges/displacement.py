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
        store = simulation.store
        columns = np.flatnonzero(store.of_groups(self.groups))
        reference = store.shown("reference")[columns]
        away = nearest(reference - np.array(self.at), simulation.domain.periods)
        moved = gone(simulation, columns) - reference
        return fitted(simulation.comm, away, self.reach, moved).tolist()


def gone(simulation, rows: np.ndarray) -> np.ndarray:
    """Where the particles of these ``rows`` have gone from the start, m (n, dim).

    Where the domain repeats also beyond it, if the particles count how often they crossed it.
    """
    store, domain = simulation.store, simulation.domain
    places, beyond = domain.taken_back(store.shown("position")[rows])
    for axis, period in enumerate(domain.periods):
        if period is not None and CROSSED.name in store:
            places[:, axis] += period * (store.shown(CROSSED.name)[rows, axis] + beyond[:, axis])
    return places
