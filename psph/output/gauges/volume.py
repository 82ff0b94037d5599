"""Volume of the fluid in a region, and beyond the crest of a structure."""

from collections.abc import Sequence
from itertools import product
from typing import Any, NamedTuple

import numpy as np

from psph.output.flowing import ALL, counted
from psph.output.gauges.carried import Carrier
from psph.parallel.reductions import exact_sums
from psph.scene.lattice import TOLERANCE
from psph.scene.shapes import inside


class Within(NamedTuple):
    """The part of space in a ``shape`` of the case (psph.case.shapes), whose edges count to a ``tolerance``,
    m, and in its images in a domain that repeats; None: all of it."""

    shape: Any
    tolerance: float

    @classmethod
    def of(cls, scene, shape) -> "Within":
        """That of a table of the case."""
        return cls(shape, TOLERANCE * scene.spacing)

    def holds(self, places: np.ndarray, periods: Sequence[float | None]) -> np.ndarray:
        """True where one of ``places`` (n, dim), m, lies in it (n,)."""
        if self.shape is None:
            return np.ones(len(places), bool)
        found = np.zeros(len(places), bool)
        for shift in product(*((0.0,) if one is None else (0.0, one, -one) for one in periods)):
            grid = [x + by for x, by in zip(places.T, shift)]
            found |= np.broadcast_to(inside(self.shape, grid, self.tolerance), found.shape)
        return found


class VolumeGauge(NamedTuple):
    """Volume Σ V_j and mass Σ m_j of the fluid particles whose middles are ``within`` a region.

    V = m/ρ.  Fluids are those of the groups ``of``.  With a ``carrier`` the region is that of the start, and
    goes with it.  m³ and kg; per metre of depth in 2D.
    """

    name: str
    every: float
    within: Within
    carrier: Carrier | None = None
    of: tuple[int, ...] = ALL

    def columns(self, scene) -> list[str]:
        """Their names, without the time."""
        return [f"{self.name}.volume", f"{self.name}.mass"]

    def row(self, simulation) -> np.ndarray:
        """The values, the same on every rank."""
        store, domain = simulation.store, simulation.domain
        rows = np.flatnonzero(counted(store.kinds, self.of)[store.shown("group")])
        places = domain.inside(store.shown("position")[rows])
        if self.carrier is not None:
            places = self.carrier.taken_back(simulation, places)
        rows = rows[self.within.holds(places, domain.periods)]
        mass = store.shown("mass")[rows]
        return exact_sums(simulation.comm, np.column_stack([mass / store.shown("density")[rows], mass]))


class OvertoppingGauge(NamedTuple):
    """Volume of the fluid beyond the crest of a structure, by the metre of crest, m³/m.

    V = Σ V_j b_j / w with the part b_j of a particle's cell, a cube of its volume, that is beyond the plane
    of the crest, which stands at ``at`` m across an ``axis``; ``way`` is 1 where beyond is above ``at``, else
    −1, ``width`` w m.  What has passed between two times is the difference.  Particles count whose middles
    are ``within`` a region.  Fluids are those of the groups ``of``.
    """

    name: str
    every: float
    axis: int
    way: int
    at: float
    width: float
    within: Within
    of: tuple[int, ...] = ALL

    def columns(self, scene) -> list[str]:
        """Its name, without the time."""
        return [f"{self.name}.beyond"]

    def row(self, simulation) -> np.ndarray:
        """The value, the same on every rank."""
        store, domain = simulation.store, simulation.domain
        rows = np.flatnonzero(counted(store.kinds, self.of)[store.shown("group")])
        places = domain.inside(store.shown("position")[rows])
        held = self.within.holds(places, domain.periods)
        rows, past = rows[held], self.way * (places[held, self.axis] - self.at)
        volume = store.shown("mass")[rows] / store.shown("density")[rows]
        part = np.clip(0.5 + past / volume ** (1.0 / store.dimensions), 0.0, 1.0)
        return exact_sums(simulation.comm, (volume * part / self.width)[:, None])
