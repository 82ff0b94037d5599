"""What kinds of matter share whose particles move by rates of their own: a group of particles for each table
of the case, on the sites of its shape, and the kick and drift of these on a rank.

A file that a case uses derives its kind from :class:`FreeKind` and its work from :class:`FreeParticles`
(docs/recipes/kind.md).
"""

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar

import numpy as np

from psph.kinds import Created, Kind, kinds_in
from psph.physics.motion import OfItsKind
from psph.scene.sites import sites_in
from psph.scene.species import Species
from psph.work import Work


class FreeKind(Kind):
    """Particles by the names of tables that have a ``shape``, a ``density`` and perhaps a ``velocity``."""

    moves = True
    offset: ClassVar[float] = 0.5
    """Spacings by which its sites are off those of the scene's lattice along each axis."""

    @property
    def tables(self) -> Mapping[str, Any]:
        """Its tables of the case."""
        return getattr(self.scene.case, self.name)

    @property
    def first(self) -> int:
        """The number of its first group: behind those of the lattice and of kinds before it."""
        before = 0
        for kind in kinds_in(self.scene):
            if type(kind) is type(self):
                break
            before += len(kind.groups())
        return len(self.scene.species) + before

    def sites(self, one: Any) -> np.ndarray:
        """Where the particles of a table begin (n, dim), m."""
        return sites_in(self.scene, one.shape, self.offset)

    def density_of(self, one: Any) -> float:
        """Mass of a table's particles by volume, kg/m^d."""
        return one.density

    def mass_of(self, one: Any) -> float:
        """Mass of each of them, kg."""
        return self.density_of(one) * self.scene.spacing**self.scene.dimensions

    def values_of(self, one: Any) -> dict[str, float]:
        """The fields in which they begin with another number than zero."""
        return {}

    def faults(self) -> Iterator[str]:
        """Shapes without a site."""
        for name, one in self.tables.items():
            if not len(self.sites(one)):
                yield f"{self.name}.{name}.shape: no site lies in it; make it larger than space.spacing"

    def groups(self) -> tuple[Species, ...]:
        """One for each table."""
        law = self.scene.species[0].law
        return tuple(
            Species(name, OfItsKind(), self.density_of(one), 0.0, self.mass_of(one), law)
            for name, one in self.tables.items()
        )

    def particles(self) -> Created:
        """One at each site of each shape."""
        tables, still = [*self.tables.values()], (0.0,) * self.scene.dimensions
        places = [self.sites(one) for one in tables]
        group = np.repeat(np.arange(len(places)), [len(x) for x in places])
        velocity = np.array([getattr(one, "velocity", None) or still for one in tables])[group]
        density = np.array([self.density_of(one) for one in tables])[group]
        values = [self.values_of(one) for one in tables]
        begun = {name: np.array([of[name] for of in values])[group] for name in values[0]}
        return Created(group, np.concatenate(places), velocity, density, begun)

    def rehearsed(self) -> tuple[int, ...]:
        """One of its particles."""
        return (self.first,)


class FreeParticles(Work):
    """The particles of a ``kind`` on a ``rank``: they go as their acceleration says, which others fill.

    ``own`` are their columns in ``store``.  v += ½ a Δt, x += v Δt, and v + ½ a Δt as the predicted velocity;
    at the end of the step v += ½ a Δt with the new acceleration.
    """

    def __init__(self, kind: FreeKind, rank: Any):
        self.store, self.comm = rank.store, rank.domain.comm
        self.groups = range(kind.first, kind.first + len(kind.tables))
        self.settle()

    def settle(self) -> None:
        """Their columns."""
        store = self.store
        self.own = store.low + np.flatnonzero(store.of_groups(self.groups))

    def advance(self, time: float, dt: float, largest_speed: float) -> None:
        """Kick, drift, predict."""
        own, names = self.own, ("position", "velocity", "predicted_velocity", "acceleration")
        for x, v, ahead, a in zip(*(self.store[name] for name in names)):
            v[own] += 0.5 * dt * a[own]
            x[own] += dt * v[own]
            ahead[own] = v[own] + 0.5 * dt * a[own]
        self.kicked(dt)

    def kicked(self, dt: float) -> None:
        """What goes with half a kick of a step of ``dt`` s, after it: say, work."""

    def kick(self, dt: float) -> tuple[float, ...]:
        """The second kick; the largest |a|² and |v|² where psph.simulation.integrator.kick has them."""
        own, v2, a2 = self.own, np.zeros(len(self.own)), np.zeros(len(self.own))
        for v, a in zip(self.store["velocity"], self.store["acceleration"]):
            v[own] += 0.5 * dt * a[own]
            v2, a2 = v2 + v[own] ** 2, a2 + a[own] ** 2
        self.kicked(dt)
        trouble = 0.0 if np.isfinite(v2 + a2).all() else np.inf
        return 0.0, a2.max(initial=0.0), trouble, 0.0, v2.max(initial=0.0)
