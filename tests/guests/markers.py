"""Markers that go with the fluid."""

from typing import NamedTuple

import numpy as np

from psph.case.keys import Table, key
from psph.case.shapes import Shape
from psph.fields import OTHER, VECTOR, Drifting, Field
from psph.kinds import Created, Kind, Work
from psph.physics.catalogue import Catalogue, Entry
from psph.physics.motion import OfItsKind
from psph.scene.sites import sites_in
from psph.scene.species import Species
from psph.vectors import add, scale, zero_like


class Current(NamedTuple):
    """Markers feel the velocity of the fluid around them."""

    across = True
    writes = Field("current", "m/s", "velocity of the fluid around a marker", VECTOR, image=Drifting)

    def start(self, i):
        return zero_like(i.position)

    def gather(self, total, i, j, pair):
        """Add V_j W_ij (v_j − v_i) of a fluid."""
        return add(total, scale(pair.u_ij, -j.is_fluid * j.mass * j.specific_volume * pair.w))

    def finish_value(self, total, i, kernel):
        return total


class Marker(Table):
    """A group of markers."""

    shape: Shape = key("where they are at the start")


class Markers(Kind):
    """The markers by name."""

    name, table, moves = "markers", Marker, True

    def groups(self):
        water = self.scene.species[0]
        mass = 1e-9 * water.mass
        return tuple(Species(name, OfItsKind(), water.density, 0.0, mass, water.law) for name in self._tables)

    def particles(self):
        places = [sites_in(self.scene, one.shape, offset=0.5) for one in self._tables.values()]
        group = np.repeat(np.arange(len(places)), [len(x) for x in places])
        position = np.concatenate(places)
        density = np.full(len(group), self.scene.species[0].density)
        return Created(group, position, np.zeros_like(position), density, {})

    def rehearsed(self):
        return (len(self.scene.species),)

    def work(self, rank):
        yield Going(rank.store)

    @property
    def _tables(self):
        return self.scene.case.markers


class Going(Work):
    """The markers of a rank."""

    def __init__(self, store):
        self.store = store

    def advance(self, time, dt, largest_speed):
        s = self.store
        own = s.low + np.flatnonzero(s.shown("kind") == OTHER)
        for x, v, ahead, of in zip(s["position"], s["velocity"], s["predicted_velocity"], s["current"]):
            v[own] += of[own]
            x[own] += dt * v[own]
            ahead[own] = v[own]


CATALOGUE = Catalogue(effects=(Entry("markers.*", Current),), kinds=(Entry("markers", Markers),))
