"""Friction of fluids whose viscosity depends on their rate of strain."""

from typing import Any, NamedTuple

import numpy as np

from psph.acts import FLUIDS
from psph.engine.jit import call_by_type
from psph.fields import Field, Same
from psph.formula import helper
from psph.physics.facts import Facts
from psph.physics.fluid.friction import (
    VELOCITY_GRADIENT,
    Apparent,
    Arithmetic,
    Harmonic,
    Rub,
    along_lines,
    central_step,
    friction_step,
    rub,
    rub_of,
    sheared,
    viscous,
)
from psph.physics.fluid.rheology import Granular, Newtonian, apparent_viscosity
from psph.physics.fluid.strain import linear_gradient, no_rate, rate_weight, take_rate
from psph.vectors import norm_squared, scale, subtract, symmetric_part

STRAIN_RATE = Field(
    "strain_rate", "1/s", "rate of strain, the root of 2 D:D; 0 in a wall", saved=True, image=Same
)
APPARENT_VISCOSITY = Field(
    "apparent_viscosity", "Pa s", "viscosity at this rate of strain; 0 in a wall", saved=True, image=Same
)


def rub_beside(scene: Facts):
    """The form of the friction that a scene with such fluids needs; between grains alone with the arithmetic
    mean of their viscosities."""
    smooth = all(isinstance(law, Granular) for law in scene.rheologies)
    grains = smooth and all(one.rheology and one.rubs for one in scene.species)
    return rub_of(scene, Apparent(), Arithmetic() if grains else Harmonic())


class FluidAlone(NamedTuple):
    """A rate of strain knows of no wall."""

    def part(self, j):
        """How much a neighbour counts."""
        return viscous(j)

    def difference(self, j, pair):
        """Of the velocities, m/s."""
        return pair.u_ij


class StickingWalls(NamedTuple):
    """A rate of strain knows what the walls mirror that the fluid sticks to (psph.physics.walls.slip)."""

    def part(self, j):
        """How much a neighbour counts."""
        return viscous(j) + j.grip

    def difference(self, j, pair):
        """Of the velocities, m/s: a wall shows v + s."""
        return subtract(pair.u_ij, j.slip)


part = call_by_type("part")
"""(what stands beside the fluid, j) → how much a neighbour counts in a rate of strain."""
difference = call_by_type("difference")
"""(what stands beside the fluid, j, pair) → difference of the velocities, m/s."""


class ApparentViscosity(NamedTuple):
    """Friction of fluids whose viscosity depends on their rate of strain: mud, paste, grains.

    a_i as by :class:`psph.physics.fluid.viscosity.LaminarViscosity` of the η_i, or with (η_i + η_j)/2 for μ̄
    where all fluids are grains.  η_i = η(γ̇_i, p_i) by the
    law of its fluid (psph.physics.fluid.rheology), γ̇ = √(2D:D), D = sym(−Σ_j V_j u_ij ∇W_ijᵀ M⁻¹) and
    M = −Σ_j V_j x_ij ∇W_ijᵀ over the fluid neighbours and, by their grip, what walls without slip mirror:
    exact for a linear flow up to a free surface, nearly so up to a wall; this is the G of the friction too.
    Both are those of the step before.  Beside ``physics.central_friction`` it acts along the line of each
    pair.
    """

    acts = (FLUIDS,)
    conserves = ("momentum",)

    def in_scene(self, scene: Facts):
        """The form that knows the laws of the scene."""
        laws = (Newtonian(), *scene.rheologies)
        largest = max(
            laws[one.rheology].largest / one.density if one.rheology else one.viscosity
            for one in scene.species
        )
        friction = rub_beside(scene)
        if scene.physics.central_friction is not None:
            return CentralApparentFriction(laws, largest, FluidAlone(), friction)
        beside = StickingWalls() if any(one.no_slip for one in scene.species) else FluidAlone()
        return ApparentFriction(laws, largest, beside, friction)


def _start(self, i):
    """No neighbour yet."""
    return no_rate(i)


def _gather(self, total, i, j, pair):
    """Take a neighbour that counts."""
    weight = rate_weight(j, pair) * part(self.beside, j)
    return take_rate(total, pair, difference(self.beside, j, pair), weight, weight)


@helper
def _found(self, gradient, i):
    """γ̇ in 1/s and η in Pa s of a fluid particle by G; zeros in a wall."""
    own = i.viscosity / i.specific_volume
    rate = np.sqrt(2.0 * norm_squared(symmetric_part(gradient, i.position), i.position))
    found = apparent_viscosity(self.laws, i.rheology, rate, i.pressure, own)
    return i.is_fluid * rate, i.is_fluid * found


class ApparentFriction(NamedTuple):
    """Friction of fluids whose viscosity depends on their rate of strain: mud, paste, grains.

    The form of :class:`ApparentViscosity` in a scene: its ``laws``, that of a constant viscosity first, the
    ``largest`` kinematic viscosity of them in m²/s, what stands ``beside`` the fluid, and the form of the
    ``friction``.
    """

    conserves = ("momentum",)

    laws: tuple
    largest: float
    beside: Any
    friction: Any

    writes = (STRAIN_RATE, APPARENT_VISCOSITY, VELOCITY_GRADIENT)
    lagged = True

    def push(self, i, j, pair):
        """F_ij (u_ij + Gᵀx_ij), m/s²."""
        return scale(sheared(i, j, pair), rub(self.friction, i, j, pair))

    def finish_value(self, total, i, kernel):
        """γ̇ in 1/s and η in Pa s of a fluid particle, and the components of its G; zeros in a wall."""
        gradient = linear_gradient(total, i)
        return _found(self, gradient, i) + scale(gradient, i.is_fluid)

    def longest_step(self, scene):
        """Δt ≤ 0.125 h²/ν with the largest ν that a law gives, s."""
        return friction_step(scene, self.largest)

    start, gather = _start, _gather


class CentralApparentFriction(NamedTuple):
    """Friction along the line of each pair, of fluids whose viscosity depends on their rate of strain.

    The form of :class:`ApparentViscosity` beside :class:`psph.physics.fluid.viscosity.CentralFriction`: the
    divergence of 2ηD in whole, at a free surface too.
    """

    conserves = ("momentum", "angular momentum")

    laws: tuple
    largest: float
    beside: Any
    friction: Any = Rub(Apparent())

    writes = (STRAIN_RATE, APPARENT_VISCOSITY)
    lagged = True

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        return along_lines(self.friction, i, j, pair)

    def finish_value(self, total, i, kernel):
        """γ̇ in 1/s and η in Pa s of a fluid particle; zeros in a wall."""
        return _found(self, linear_gradient(total, i), i)

    def longest_step(self, scene):
        """Δt ≤ 0.05 h²/ν with the largest ν that a law gives, s."""
        return central_step(scene, self.largest)

    start, gather = _start, _gather
