"""Sums in volumes, for fluids whose rest densities differ: up to 1000 : 1 at the time step of one fluid.

Pressure and divergence are weighted by the densities of the pair, conjugate to each other:
θ_ij = 2ρ₀_j/(ρ₀_i + ρ₀_j) between fluids, θ_ij + θ_ji = 2.  The pair then has the pressure
p* = (ρ₀_j p_i + ρ₀_i p_j)/(ρ₀_i + ρ₀_j) and the velocity u* = (ρ₀_i u_i + ρ₀_j u_j)/(ρ₀_i + ρ₀_j), those
between two states that meet in one speed of sound (Rezavand, Zhang & Hu 2020, J. Comput. Phys. 402, 109092),
without their dissipation.  A heavy particle neither answers to the motion of a light one nor pushes it by its
own stiffness, so that no step gets shorter.  Sums of V_j = m_j/ρ_j alone (θ = 1: Colagrossi & Landrini 2003,
J. Comput. Phys. 191, 448) are as quiet only where ρ₀c² is the same on both sides.
A wall serves every fluid: beside one of another density or speed of sound than that which it continues θ is 2
in the fluid and 0 in the wall, a rigid mirror.
"""

from typing import NamedTuple

from psph.engine.jit import call_by_type
from psph.formula import helper, where
from psph.physics.facts import Facts
from psph.physics.fluid.parting import Hold, borne
from psph.physics.fluid.weight import Gravitation, down, pull_at_walls
from psph.vectors import add, scale, times


def several(scene: Facts) -> bool:
    """Whether sums have to know of several fluids: rest densities or speeds of sound differ.

    Beside elastic solids, and matter whose stress evolves, sums in masses serve, and so they do for pressure
    gradients from differences.
    """
    plain = all(one.bonded is None and not one.shear_modulus for one in scene.species)
    alike = len({(one.density, one.sound_speed) for one in scene.species}) == 1
    return plain and not alike and scene.physics.pressure_gradient == "symmetric"


@helper
def differ(i, j):
    """1 where two rest densities differ, else 0."""
    one, other = i.rest_density, j.rest_density
    return where(max(one, other) > min(one, other), 1.0, 0.0)


@helper
def faced(i, j):
    """1 where one of two is a wall that does not continue the other, in rest density or in speed of sound."""
    quicker = where(max(i.sound_speed, j.sound_speed) > min(i.sound_speed, j.sound_speed), 1.0, differ(i, j))
    return quicker * (1.0 - i.is_fluid * j.is_fluid)


class Mirroring(NamedTuple):
    """A wall is a rigid mirror to a fluid that it does not continue, under what is felt as gravity there."""

    pull: Gravitation

    def mirrors(self, i, j):
        """1 where a wall is one, else 0."""
        return faced(i, j)


class MirroringWherePressed(NamedTuple):
    """The same, but for walls that bear no pressure: they show each fluid what they show one fluid, none.

    The form beside walls with ``condition`` "repulsive" or "penalty".
    """

    pull: Gravitation

    def mirrors(self, i, j):
        """1 where a wall is one, else 0."""
        return faced(i, j) * (1.0 - max(i.repulsive, j.repulsive)) * (1.0 - max(i.penalty, j.penalty))


Facing = Mirroring | MirroringWherePressed

mirrors = call_by_type("mirrors")
"""(facing, i, j) → 1 or 0: see :class:`Mirroring`."""


def facing_of(scene: Facts) -> Facing:
    """What the walls of a scene are to fluids that they do not continue."""
    pressed = all(one.bearing for one in scene.species)
    return (Mirroring if pressed else MirroringWherePressed)(pull_at_walls(scene))


@helper
def shares(facing, i, j):
    """θ_ij and θ_ji: the part that each has in the velocity between both, twice.  The same two numbers from
    either side, so that momentum is exact to the last bit."""
    among, twice = i.is_fluid * j.is_fluid, 2.0 / (i.rest_density + j.rest_density)
    between, mirror = differ(i, j) * among, mirrors(facing, i, j)
    own = where(mirror > 0.0, 2.0 * i.is_fluid, where(between > 0.0, j.rest_density * twice, 1.0))
    other = where(mirror > 0.0, 2.0 * j.is_fluid, where(between > 0.0, i.rest_density * twice, 1.0))
    return own, other


@helper
def half_way(facing, i, j, pair):
    """What half the way to a wall of another density adds to twice the pressure of a fluid, Pa: ρ₀ g·x_ji."""
    fluid = i.is_fluid * (1.0 - j.is_fluid) * i.rest_density
    behind = j.is_fluid * (1.0 - i.is_fluid) * j.rest_density
    return mirrors(facing, i, j) * (behind - fluid) * down(facing.pull, i, j, pair)


@helper
def in_volumes(i, j, pair):
    """V_j W′/(ρ_i r), m^(d-2)/kg."""
    return i.specific_volume * j.specific_volume * pair.m_dw_r


class VolumeContinuity(NamedTuple):
    """Density changes by the divergence of the velocity, between fluids of several densities.

    dρ_i/dt = ρ_i Σ_j V_j θ_ij u_ij·∇W_ij (psph.physics.fluid.several), as :class:`Continuity
    <psph.physics.fluid.continuity.Continuity>` where densities agree; ``facing`` says what walls are to
    fluids that they do not continue.
    """

    facing: Facing

    def density_rate(self, i, j, pair):
        """One neighbour's share of dρ_i/dt, kg/(m^d s)."""
        return (
            pair.u_dot_x
            * pair.m_dw_r
            * (shares(self.facing, i, j)[0] * (j.specific_volume / i.specific_volume))
        )

    def linear(self, scene: Facts):
        """Linear theory knows of one fluid."""
        return None


class VolumePressure(NamedTuple):
    """Pressure gradient, symmetric in the pair, between fluids of several densities.

    a_i = −1/ρ_i Σ_j V_j (θ_ij p_i + θ_ji p_j + w_ij) ∇W_ij (psph.physics.fluid.several); w_ij is the weight
    of half the way to a wall of another density, −ρ₀_i g·x_ij in the fluid, of one that moves with g − a_w:
    ``facing``.  ``walls`` say what stands for p beside them (psph.physics.fluid.parting).  Along an interface
    a row of the lighter fluid feels less than the gradient of the pressure, down to half of it, and one of
    the heavier fluid up to 3/2.
    """

    conserves = ("momentum", "angular momentum")

    walls: Hold
    facing: Facing

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        theta_ij, theta_ji = shares(self.facing, i, j)
        own, other = borne(self.walls, i, j)
        both = theta_ij * own + theta_ji * other + half_way(self.facing, i, j, pair)
        return -both * in_volumes(i, j, pair)

    def linear(self, scene: Facts):
        """Linear theory knows of one fluid."""
        return None


class VolumeBackground(NamedTuple):
    """A constant pressure pushes particles apart, in fluids of several densities.

    a_i = −2 p_b/ρ_i Σ_j V_j ∇W_ij: :class:`VolumePressure` of the same p_b in all.
    """

    conserves = ("momentum", "angular momentum")

    pressure: float

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        return -2.0 * self.pressure * in_volumes(i, j, pair)

    def linear(self, scene: Facts):
        """Linear theory knows of one fluid."""
        return None


class CorrectedVolumeBackground(NamedTuple):
    """A constant pressure pushes particles apart, in fluids of several densities, with corrected gradients.

    a_i = −p_b/ρ_i Σ_j V_j (θ_ij L_i + θ_ji L_j) ∇W_ij.
    """

    conserves = ("momentum",)

    pressure: float
    facing: Facing

    def push(self, i, j, pair):
        """Acceleration, m/s²."""
        theta_ij, theta_ji = shares(self.facing, i, j)
        both = add(scale(i.gradient_correction, theta_ij), scale(j.gradient_correction, theta_ji))
        whole = add(scale(pair.x_ij, 2.0), times(both, pair.x_ij))
        return scale(whole, -self.pressure * in_volumes(i, j, pair))

    def linear(self, scene: Facts):
        """Linear theory knows of one fluid."""
        return None
