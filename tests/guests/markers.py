"""Markers that go with the fluid."""

from typing import NamedTuple

from psph.case.keys import Table, key
from psph.case.shapes import Shape
from psph.fields import VECTOR, Drifting, Field
from psph.matter.free import FreeKind, FreeParticles
from psph.physics.catalogue import Catalogue, Entry
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


class Markers(FreeKind):
    """The markers by name."""

    name, table = "markers", Marker

    def density_of(self, one):
        return self.scene.species[0].density

    def mass_of(self, one):
        return 1e-9 * self.scene.species[0].mass

    def work(self, rank):
        yield Going(self, rank)


class Going(FreeParticles):
    """The markers of a rank."""

    def advance(self, time, dt, largest_speed):
        s, own = self.store, self.own
        for x, v, ahead, of in zip(s["position"], s["velocity"], s["predicted_velocity"], s["current"]):
            v[own] += of[own]
            x[own] += dt * v[own]
            ahead[own] = v[own]

    def kick(self, dt):
        """They have no acceleration."""


CATALOGUE = Catalogue(effects=(Entry("markers.*", Current),), kinds=(Entry("markers", Markers),))
