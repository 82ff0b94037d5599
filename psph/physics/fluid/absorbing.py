"""Waves that fade before a wall."""

from math import inf
from typing import Annotated, Literal, NamedTuple

from pydantic import Field

from psph.acts import FLUIDS, of_fluids
from psph.formula import helper, where
from psph.physics.facts import Facts
from psph.vectors import dot, scale, subtract

STABLE = 0.5
"""β Δt stays below.  A velocity that is predicted to first order is stable up to 1, and somewhat less beside
sound."""


class DampingZone(NamedTuple):
    """Waves fade in a zone of the fluid, so that its end does not reflect them.

    a_i = −β s² (v_i − U) where 0 ≤ s ≤ 1, s = (x − x₀)/(x₁ − x₀); elsewhere none.  A sponge layer as that of
    Altomare and others (2017), Coast. Eng. 127, 37, who take a part off the velocity in place of a force.  It
    conserves neither momentum nor energy: it takes both.  Soils, solids and bodies in it feel nothing of it.
    Before an open end U is the stream's: sound that meets the end at an angle fades, and vortices do.
    """

    acts = (FLUIDS,)

    begin: Annotated[
        float,
        Field(
            description="coordinate x₀ where it begins, without any damping", json_schema_extra={"unit": "m"}
        ),
    ]
    end: Annotated[
        float,
        Field(
            description="coordinate x₁ where it ends, with all of it; below begin it grows the other way",
            json_schema_extra={"unit": "m"},
        ),
    ]
    axis: Annotated[Literal["x", "y", "z"], Field(description="axis along which it grows")] = "x"
    strength: Annotated[
        float, Field(ge=0, description="damping β at its end", json_schema_extra={"unit": "1/s"})
    ] = 10.0
    speed: Annotated[
        float,
        Field(
            description="speed U of a stream along the axis, to which velocities fade",
            json_schema_extra={"unit": "m/s"},
        ),
    ] = 0.0

    @staticmethod
    def conflicts(physics, kernel):
        """It needs a length to grow over."""
        if physics.damping_zone.begin == physics.damping_zone.end:
            yield "begins where it ends; give another end"

    def in_scene(self, scene: Facts):
        """The form that knows its axis as a vector."""
        slope = 1.0 / (self.end - self.begin)
        growth = tuple(slope if name == self.axis else 0.0 for name in "xyz"[: scene.dimensions])
        zone = AbsorbingZone(growth, self.begin * slope, self.strength)
        if not self.speed:
            return zone
        return AbsorbingStream(zone, tuple(self.speed if g else 0.0 for g in growth))


class OtherDampingZone(DampingZone):
    """A second zone in which waves fade, at the other end of the water."""

    @staticmethod
    def conflicts(physics, kernel):
        """It needs a length to grow over."""
        if physics.other_damping_zone.begin == physics.other_damping_zone.end:
            yield "begins where it ends; give another end"


@helper
def fading(zone, i):
    """−β s² of i in a zone, 1/s."""
    s = dot(i.position, zone.growth) - zone.offset
    return of_fluids(i, where((s >= 0.0) & (s <= 1.0), -zone.strength * s * s, 0.0))


class AbsorbingZone(NamedTuple):
    """Waves fade in a zone of the fluid, so that its end does not reflect them.

    :class:`DampingZone` in a scene: s = g·x − s₀, with the ``growth`` g of s in 1/m and its ``offset`` s₀.
    """

    dissipates = True

    growth: tuple[float, ...]
    offset: float
    strength: float

    def body(self, i):
        """−β s² v_i, m/s²."""
        return scale(i.velocity, fading(self, i))

    def longest_step(self, scene: Facts):
        """Δt ≤ 0.5/β, s: see STABLE."""
        return STABLE / self.strength if self.strength else inf


class AbsorbingStream(NamedTuple):
    """The same in a stream: velocities fade to its ``stream`` (dim,), m/s, which can give energy."""

    zone: AbsorbingZone
    stream: tuple[float, ...]

    def body(self, i):
        """−β s² (v_i − U), m/s²."""
        return scale(subtract(i.velocity, self.stream), fading(self.zone, i))

    def longest_step(self, scene: Facts):
        """That of the zone, s."""
        return self.zone.longest_step(scene)
