"""What a stress cannot exceed: soils yield by friction and cohesion, and tear where they are pulled."""

import math
from typing import NamedTuple

import numpy as np

from psph.acts import SOILS
from psph.engine.jit import call_by_number, call_by_type
from psph.formula import helper
from psph.physics.facts import Facts
from psph.physics.solid.plastic import PLASTIC_STRAIN
from psph.physics.stress.deviator import DEVIATOR
from psph.physics.stress.invariants import j2, j3
from psph.vectors import dot, scale

NO_STRESS = 1e-300
"""Keeps √J₂ = 0 from dividing by zero, Pa."""

returned = call_by_number("returned")
"""(laws, number, i, s, ρ) → s and ρ within the limit of a law, and the plastic strain of the way there."""

admitted = call_by_type("admit")
"""(effect, i, s, ρ) → what the effect admits of a particle's stress and density, and what it remembers."""


class Unbounded(NamedTuple):
    """Matter whose stress has no limit, beside other matter that yields."""

    def returned(self, i, s, rho):
        """The stress as it is."""
        return s, rho, 0.0


@helper
def narrowed(sine, i, s, q):
    """m = cos θ − sin θ sin φ/√3, by what √J₂ = ``q`` counts in the pyramid of Mohr and Coulomb.

    θ is the angle of Lode, sin 3θ = −3√3 J₃/(2 J₂^(3/2)): 30° where one stress presses most, 0 in plane
    strain that flows without dilatancy.  Zienkiewicz & Pande (1977), in Finite Elements in Geomechanics,
    Wiley, 179.
    """
    cube = max(q * q * q, NO_STRESS)
    triple = min(max(-1.5 * math.sqrt(3.0) * j3(s, i.position) / cube, -1.0), 1.0)
    angle = np.arcsin(triple) / 3.0
    return np.cos(angle) - np.sin(angle) * sine / math.sqrt(3.0)


class MohrCoulomb(NamedTuple):
    """Soil: it yields where m√J₂ > k − αI₁, and bears no more tension than it is told.

    With α = sin φ/3, k = c cos φ and m by :func:`narrowed` that is ½(σ₁ − σ₃) > c cos φ − ½(σ₁ + σ₃) sin φ of
    the largest and the smallest principal stress: Coulomb (1776), Mohr (1900).  In plane strain σ_zz counts
    as in 3D.  The way back is that of Bui, Fukagawa, Sako & Ohno (2008), Int. J. Numer. Anal. Meth. Geomech.
    32, 1537, along the gradient of √J₂ + α_ψI₁: with p = −I₁/3 less the pressure of the water in its pores,
    first p ≥ −T, then Δλ = max(m√J₂ − k − 3αp, 0)/(mG + 9Kαα_ψ), √J₂ −= GΔλ, p += 3Kα_ψΔλ.  s keeps its
    direction, so the edges of the pyramid need no rounding.  The plastic strain is Δλ/√3, as that of von
    Mises.

    ``friction`` 3α; ``cohesion`` k in Pa; ``dilation`` 3α_ψ; ``tension`` T ≤ k/3α in Pa; ``shear`` G
    and ``bulk`` K in Pa.  Pores hold still water of ``pores`` = ρ_w|g| in Pa/m up to ``level`` in m along
    ``up``; 0: dry.
    """

    friction: float
    cohesion: float
    dilation: float
    tension: float
    shear: float
    bulk: float
    pores: float
    level: float
    up: tuple[float, ...]

    def returned(self, i, s, rho):
        """s in Pa and ρ in kg/m^d on or within the yield surface, and the plastic strain of the way there."""
        trial = max(self.bulk * np.log(rho / i.rest_density), -self.tension)
        water = self.pores * max(self.level - dot(i.position, self.up), 0.0)
        p = max(trial - water, -self.tension)
        q = np.sqrt(j2(s, i.position))
        m = narrowed(self.friction, i, s, q)
        beyond = max(m * q - self.cohesion - self.friction * p, 0.0)
        slip = beyond / (m * self.shear + self.bulk * self.friction * self.dilation)
        p += self.bulk * self.dilation * slip
        left = 1.0 - self.shear * slip / max(q, NO_STRESS)
        return scale(s, left), rho * np.exp((p + water - trial) / self.bulk), slip / math.sqrt(3.0)


def pyramid(friction_angle: float, cohesion: float, dilatancy: float) -> tuple[float, float, float]:
    """3α = sin φ, k = c cos φ in Pa and 3α_ψ of soil with these angles in rad and this cohesion in Pa.

    α_ψ = tan ψ/√(9 + 12 tan²ψ): then soil that flows in plane strain gains volume by sin ψ times its shear.
    """
    sine, cosine = math.sin(friction_angle), math.cos(friction_angle)
    flow = math.tan(dilatancy) / math.sqrt(9.0 + 12.0 * math.tan(dilatancy) ** 2)
    return sine, cohesion * cosine, 3.0 * flow


class Strength(NamedTuple):
    """Soil yields by friction and cohesion, and tears: its stress stays within a pyramid.

    By the law of its soil (:class:`MohrCoulomb`), where the stress is predicted and after each kick.  The
    density that goes with the pressure is that of the volume less what dilatancy has opened; a crack stays in
    it, and has to close before the soil is pressed again (:class:`psph.physics.stress.bulk.Hooke`).
    """

    acts = (SOILS,)

    laws: tuple = (Unbounded(),)

    bounds = DEVIATOR
    remembers = PLASTIC_STRAIN

    def in_scene(self, scene: Facts):
        """With the laws of the scene; None where no stress has a limit."""
        return Strength((Unbounded(), *laws)) if (laws := scene.strengths) else None

    def why_absent(self, scene: Facts):
        """What it lacks."""
        return "nothing that bears an evolved stress has a limit to it"

    def admit(self, i, s, rho):
        """s, ρ and the plastic strain of the way there."""
        return returned(self.laws, i.strength, i, s, rho)
