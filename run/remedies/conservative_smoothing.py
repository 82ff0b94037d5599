"""Remedy: a filter of the velocity, under which short waves fade.

A case beside this file says ``use = ["conservative_smoothing.py"]``.
"""

from typing import Annotated, NamedTuple

from pydantic import Field

from psph.physics.catalogue import Catalogue, Entry
from psph.physics.facts import Facts

STABLE = 0.25
"""αcΔt/h must stay below: the fastest mode of a lattice decays at 1.01 αc/h with any kernel, and
a quarter a step leaves room for places where particles crowd."""


class ConservativeSmoothing(NamedTuple):
    """Velocity relaxes towards the mean around it: this damps short waves.

    du_i/dt = (α c/h) Σ_j m_j/ρ̄_ij (u_j − u_i) W_ij over fluid neighbours: the filter of Swegle,
    Hicks & Attaway (1995), J. Comput. Phys. 116, 123, and Wen, Hicks & Swegle (1994), Sandia report
    SAND94-1932, which they apply once in so many steps, as a rate, so that its strength does not
    follow Δt.  They filter density and energy too.  Momentum is conserved, angular momentum is not:
    it acts as a viscosity, on a rotation too.
    """

    conserves = ("momentum",)

    alpha: Annotated[
        float,
        Field(
            ge=0,
            description="α: part of the mean taken over in a time h/c",
            json_schema_extra={"unit": "1"},
        ),
    ] = 0.1

    def shear(self, i, j, pair):
        """Coefficient of u_ij in the acceleration, 1/s."""
        v_i, v_j = i.specific_volume, j.specific_volume
        volume = 2.0 * j.mass * v_i * v_j / (v_i + v_j) * j.is_fluid
        return -self.alpha * min(i.sound_speed, j.sound_speed) / i.smoothing_length * volume * pair.w

    def longest_step(self, scene):
        """Δt ≤ h/(4 α c), s: see STABLE."""
        mixing = self.alpha * scene.sound_speed
        return STABLE * scene.smoothing_length / mixing if mixing > 0.0 else float("inf")

    def linear(self, scene: Facts):
        """Its part in linear theory."""
        return Relaxation(self.alpha)


class Relaxation(NamedTuple):
    """du_a/dt = −(α c/h) Σ V W u_ab: its part in linear theory (psph.theory.stability.parts)."""

    alpha: float

    def damping(self, uniform, r):
        """In any direction, 1/s."""
        rate = self.alpha * uniform.sound_speed / uniform.smoothing_length
        return 0.0, rate * uniform.volume * uniform.weight(r)


CATALOGUE = Catalogue(effects=(Entry("physics.conservative_smoothing", ConservativeSmoothing),))
