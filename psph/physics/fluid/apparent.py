"""Friction of fluids whose viscosity depends on their rate of strain."""

from typing import Any, NamedTuple

import numpy as np

from psph.engine.jit import call_by_type
from psph.fields import Field, Same
from psph.formula import helper
from psph.physics.facts import Facts
from psph.physics.fluid.rheology import STILL, Granular, Newtonian, apparent_viscosity
from psph.physics.fluid.strain import linear_rate, no_rate, rate_weight, take_rate
from psph.physics.fluid.viscosity import corrected_friction, friction, friction_step
from psph.vectors import norm_squared, subtract

STRAIN_RATE = Field(
    "strain_rate", "1/s", "rate of strain, the root of 2 D:D; 0 in a wall", saved=True, image=Same
)
APPARENT_VISCOSITY = Field(
    "apparent_viscosity", "Pa s", "viscosity at this rate of strain; 0 in a wall", saved=True, image=Same
)


class Harmonic(NamedTuple):
    """Twice the harmonic mean: what flows beside what stands is not held by it."""

    def twice(self, one, two):
        """4ab/(a + b)."""
        return 4.0 * one * two / (one + two + STILL)


class Arithmetic(NamedTuple):
    """Twice the arithmetic mean, the better one where a viscosity varies smoothly: for grains alone."""

    def twice(self, one, two):
        """a + b."""
        return one + two


twice = call_by_type("twice")
"""(mean, a, b) → twice the mean of a and b."""


def mean_of(scene: Facts):
    """The mean of viscosities that a scene needs."""
    smooth = all(isinstance(law, Granular) for law in scene.rheologies)
    return Arithmetic() if smooth and all(one.rheology for one in scene.species) else Harmonic()


@helper
def apparent(mean, i, j):
    """(μ_i + μ_j)/(ρ_i ρ_j)² with the ``mean`` of the two apparent viscosities for each.

    A wall has none of its own and takes that of the fluid before it.
    """
    own, other = i.apparent_viscosity, j.apparent_viscosity
    one = own + (1.0 - i.is_fluid) * other
    two = other + (1.0 - j.is_fluid) * own
    volumes = i.specific_volume * j.specific_volume
    return twice(mean, one, two) * (volumes * volumes)


class Rub(NamedTuple):
    """The friction of :class:`psph.physics.fluid.viscosity.LaminarViscosity` between apparent viscosities."""

    mean: Any = Harmonic()

    def rub(self, i, j, pair):
        """Coefficient of a difference of velocities in the acceleration, 1/s."""
        return friction(apparent(self.mean, i, j), i, j, pair, pair.r2)


class CorrectedRub(NamedTuple):
    """That of :class:`psph.physics.fluid.viscosity.CorrectedViscosity` between apparent viscosities."""

    mean: Any = Harmonic()

    def rub(self, i, j, pair):
        """Coefficient of a difference of velocities in the acceleration, 1/s."""
        return corrected_friction(apparent(self.mean, i, j), i, j, pair)


rub = call_by_type("rub")
"""(form of the friction, i, j, pair) → coefficient of a difference of velocities, 1/s."""


def rub_of(scene: Facts):
    """The form of the friction that a scene needs: with corrected gradients where it has them."""
    form = Rub if scene.physics.gradient_correction is None else CorrectedRub
    return form(mean_of(scene))


class FluidAlone(NamedTuple):
    """A rate of strain knows of no wall."""

    def part(self, j):
        """How much a neighbour counts."""
        return j.is_fluid

    def difference(self, j, pair):
        """Of the velocities, m/s."""
        return pair.u_ij


class StickingWalls(NamedTuple):
    """A rate of strain knows what the walls mirror that the fluid sticks to (psph.physics.walls.slip)."""

    def part(self, j):
        """How much a neighbour counts."""
        return j.is_fluid + j.grip

    def difference(self, j, pair):
        """Of the velocities, m/s: a wall shows v + s."""
        return subtract(pair.u_ij, j.slip)


part = call_by_type("part")
"""(what stands beside the fluid, j) → how much a neighbour counts in a rate of strain."""
difference = call_by_type("difference")
"""(what stands beside the fluid, j, pair) → difference of the velocities, m/s."""


class ApparentViscosity(NamedTuple):
    """Friction of fluids whose viscosity depends on their rate of strain: mud, paste, grains.

    a_i as by :class:`psph.physics.fluid.viscosity.LaminarViscosity`, with 2η_iη_j/(η_i + η_j) for the
    viscosity of each of a pair, or with (η_i + η_j)/2 where all fluids are grains.  η_i = η(γ̇_i, p_i) by the
    law of its fluid (psph.physics.fluid.rheology), γ̇ = √(2D:D), D = sym(−Σ_j V_j u_ij ∇W_ijᵀ M⁻¹) and
    M = −Σ_j V_j x_ij ∇W_ijᵀ over the fluid neighbours and, by their grip, what walls without slip mirror:
    exact for a linear flow up to a free surface, nearly so up to a wall.  η is that of the step before.  The
    harmonic mean: Cleary & Monaghan (1999), J. Comput. Phys. 148, 227.  Beside ``physics.central_friction``
    it acts along the line of each pair.
    """

    conserves = ("momentum",)

    def in_scene(self, scene: Facts):
        """The form that knows the laws of the scene."""
        laws = (Newtonian(), *scene.rheologies)
        largest = max(
            laws[one.rheology].largest / one.density if one.rheology else one.viscosity
            for one in scene.species
        )
        if scene.physics.central_friction is not None:
            return CentralApparentFriction(laws, largest, FluidAlone(), mean_of(scene))
        beside = StickingWalls() if any(one.no_slip for one in scene.species) else FluidAlone()
        return ApparentFriction(laws, largest, beside, rub_of(scene))


def _start(self, i):
    """No neighbour yet."""
    return no_rate(i)


def _gather(self, total, i, j, pair):
    """Take a neighbour that counts."""
    weight = rate_weight(j, pair) * part(self.beside, j)
    return take_rate(total, pair, difference(self.beside, j, pair), weight, weight)


def _finish_value(self, total, i, kernel):
    """γ̇ in 1/s and η in Pa s of a fluid particle; zeros in a wall."""
    pressure, own = i.pressure, i.viscosity / i.specific_volume
    rate = np.sqrt(2.0 * norm_squared(linear_rate(total, i), i.position))
    found = apparent_viscosity(self.laws, i.rheology, rate, pressure, own)
    return i.is_fluid * rate, i.is_fluid * found


def _longest_step(self, scene):
    """Δt ≤ 0.125 h²/ν with the largest ν that a law gives, s."""
    return friction_step(scene.smoothing_length, self.largest)


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

    writes = (STRAIN_RATE, APPARENT_VISCOSITY)
    lagged = True

    def shear(self, i, j, pair):
        """Coefficient of u_ij in the acceleration, 1/s."""
        return rub(self.friction, i, j, pair)

    start, gather, finish_value, longest_step = _start, _gather, _finish_value, _longest_step


class CentralApparentFriction(NamedTuple):
    """Friction along the line of each pair, of fluids whose viscosity depends on their rate of strain.

    The form of :class:`ApparentViscosity` beside :class:`psph.physics.fluid.viscosity.CentralFriction`: the
    divergence of 2ηD in whole, at a free surface too.
    """

    conserves = ("momentum", "angular momentum")

    laws: tuple
    largest: float
    beside: Any
    mean: Any = Harmonic()

    writes = (STRAIN_RATE, APPARENT_VISCOSITY)
    lagged = True

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        return (2.0 + len(pair.x_ij)) * friction(apparent(self.mean, i, j), i, j, pair, pair.u_dot_x)

    start, gather, finish_value, longest_step = _start, _gather, _finish_value, _longest_step
