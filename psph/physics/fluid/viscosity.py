"""Friction between particles: the fluid's own, and a numerical one."""

from typing import Annotated, Any, NamedTuple

from pydantic import Field

from psph.acts import FLUIDS
from psph.formula import helper
from psph.moments import fastest_braking
from psph.physics.facts import Facts
from psph.physics.fluid.friction import (
    SINGULARITY,
    VELOCITY_GRADIENT,
    Rub,
    along_lines,
    central_step,
    finish_gradient,
    friction_step,
    gather_gradient,
    rub,
    rub_of,
    sheared,
    start_gradient,
)
from psph.physics.roles import FRICTION
from psph.theory.stability import parts
from psph.vectors import scale

NEGLIGIBLE = 0.01
"""A fluid's viscosity below this part of the numerical one is negligible."""

TAKEN_OVER = "the friction of fluids with a rheology takes its place"
"""Why a friction with constant viscosities is absent beside one that depends on the rate of strain."""

ONSET = 0.2
"""Speed of approach over c above which impact damping sets in."""


@helper
def inverse_square(pair, h):
    """1/max(r², 0.01 h²), 1/m²."""
    return min(pair.inverse_r * pair.inverse_r, 1.0 / (SINGULARITY * h * h))


@helper
def lighter(i, j):
    """The smaller of the two rest densities, kg/m^d.

    A numerical friction takes it for its ρ₀ between two fluids: both feel the same force, and
    neither is slowed faster than among its own kind, so that the limits of the time step hold.
    """
    return min(i.rest_density, j.rest_density)


@helper
def slower(i, j):
    """The smaller of the two speeds of sound, m/s, so that the pair feels one friction."""
    return min(i.sound_speed, j.sound_speed)


class LaminarViscosity(NamedTuple):
    """Newtonian friction of the fluids' own viscosities: the divergence of μ(∇u + ∇uᵀ).

    a_i = Σ_j F_ij (u_ij + Gᵀx_ij), F_ij = m_j 2μ̄/(ρ_iρ_j) x_ij·∇W_ij/(r² + 0.01 h²): see
    psph.physics.fluid.friction.  G = ½(G_i + G_j) between fluids, beside a wall that of the fluid;
    G_i = −Σ_j V_j u_ij ∇W_ijᵀ M⁻¹, M = −Σ_j V_j x_ij ∇W_ijᵀ over viscous neighbours, exact for a linear flow
    up to a surface.  The part of u_ij: SSPH paper, eq. (6); Morris, Fox & Zhu (1997), J. Comput. Phys. 136,
    214.  That of G is psph's own: without it what turns as a whole is braked at a surface, and at a wall it
    lacks a moment of 2μωV.
    """

    acts = (FLUIDS,)
    conserves = ("momentum",)

    def in_scene(self, scene: Facts):
        """The form that knows of corrected gradients; nothing where the case names another friction, or where
        the viscosity depends on the rate of strain."""
        if _named(scene) or scene.rheologies:
            return None
        return NewtonianFriction(rub_of(scene))

    def why_absent(self, scene: Facts):
        """What takes its place."""
        return TAKEN_OVER if scene.rheologies else f"physics.{_named(scene)} takes its place"


def _named(scene: Facts) -> str:
    """The key of the friction that a case names in place of the viscous stress; empty where it names none."""
    if scene.physics.central_friction is not None:
        return "central_friction"
    return "laplacian_friction" if scene.physics.laplacian_friction is not None else ""


class NewtonianFriction(NamedTuple):
    """Newtonian friction of the fluids' own viscosities: the divergence of μ(∇u + ∇uᵀ).

    The form of :class:`LaminarViscosity` in a scene; ``friction`` is that of F_ij.
    """

    conserves = ("momentum",)
    held = True

    friction: Any = Rub()

    writes = VELOCITY_GRADIENT
    lagged = True
    slow = True

    def push(self, i, j, pair):
        """F_ij (u_ij + Gᵀx_ij), m/s²."""
        return scale(sheared(i, j, pair), rub(self.friction, i, j, pair))

    def longest_step(self, scene):
        """Δt ≤ 0.125 h²/ν with the largest ν of the scene, s (Morris, Fox & Zhu 1997, eq. 22), or less."""
        return friction_step(scene, scene.viscosity)

    def idle(self, scene: Facts, effects):
        """Why it has no influence, or None."""
        if not scene.expected_speed > 0.0 and not any(scene.gravity):
            return "nothing moves at the start and there is no gravity, so it has nothing to act on"
        alpha = sum(e.alpha for e in effects if isinstance(e, ArtificialViscosity))
        own = max(species.viscosity for species in scene.species)
        numerical = alpha * scene.sound_speed * scene.smoothing_length / 8.0
        if own > NEGLIGIBLE * numerical:
            return None
        return (
            f"its {own:g} m2/s are negligible beside the {numerical:.2g} m2/s of "
            "physics.artificial_viscosity (alpha c h/8); remove fluids.*.viscosity, or lower alpha"
        )

    start, gather, finish_value = start_gradient, gather_gradient, finish_gradient


class CentralFriction(NamedTuple):
    """The fluids' viscosity acts along the line of each pair: a free surface bears no shear stress.

    a_i = (d + 2) Σ_j F_ij (u_ij·x_ij)/r² x_ij, in place of :class:`LaminarViscosity`, with its F_ij.
    Monaghan & Gingold (1983), J. Comput. Phys. 52, 374; as a viscosity, Monaghan (2005), Rep. Prog. Phys. 68,
    1703.  It conserves angular momentum to rounding.
    """

    acts = (FLUIDS,)
    roles = (FRICTION,)
    conserves = ("momentum", "angular momentum")

    def in_scene(self, scene: Facts):
        """Nothing where the viscosity depends on the rate of strain."""
        return None if scene.rheologies else CentralNewtonianFriction()

    def why_absent(self, scene: Facts):
        """What takes its place."""
        return TAKEN_OVER


class CentralNewtonianFriction(NamedTuple):
    """The fluids' viscosity acts along the line of each pair: a free surface bears no shear stress.

    The form of :class:`CentralFriction` in a scene.
    """

    conserves = ("momentum", "angular momentum")
    held = True

    friction: Any = Rub()

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        return along_lines(self.friction, i, j, pair)

    def longest_step(self, scene):
        """Δt ≤ 0.05 h²/ν with the largest ν of the scene, s, or less where the kernel asks for it."""
        return central_step(scene, scene.viscosity)


class LaplacianFriction(NamedTuple):
    """The viscosity of fluids acts on the Laplacian of the velocity, as in the paper: it brakes what turns.

    a_i = Σ_j 4 m_j (μ_i + μ_j) x_ij·∇W_ij / [(ρ_i + ρ_j)² (r² + 0.01 h²)] u_ij, μ = ρν, in place of
    :class:`LaminarViscosity`.  SSPH paper, eqs. (2), (6); Morris, Fox & Zhu (1997), J. Comput. Phys. 136,
    214.  It is the same in the bulk of a fluid of one viscosity.  At its ends it lacks μ(∇u)ᵀ: a drop that
    turns is braked as exp(−4νt/R²), a body lacks a moment of 2μωV, a wave loses half of what it should.
    """

    acts = (FLUIDS,)
    roles = (FRICTION,)
    conserves = ("momentum",)
    held = True

    def shear(self, i, j, pair):
        """Coefficient of u_ij in the acceleration, 1/s."""
        v_i, v_j, h = i.specific_volume, j.specific_volume, i.smoothing_length
        both = (i.viscosity * v_j + j.viscosity * v_i) * v_i * v_j
        under = (v_i + v_j) * (v_i + v_j) * (pair.r2 + SINGULARITY * h * h)
        return 4.0 * pair.m_dw_r * (both * pair.r2) / under * (i.rubs * j.rubs)

    def longest_step(self, scene):
        """Δt ≤ 0.125 h²/ν with the largest ν of the scene, s (Morris, Fox & Zhu 1997, eq. 22), or less."""
        return friction_step(scene, scene.viscosity)


def _viscosity_of_pairs(alpha: float, scene: Facts) -> float:
    """αch/(2(d + 2)), m²/s: friction along lines, averaged over their directions."""
    return alpha * scene.sound_speed * scene.smoothing_length / (2.0 * (scene.dimensions + 2))


BRAKING = 0.7
"""B α c h Δt must stay below; B is the fastest braking along pairs on the lattice (psph.moments), 1/m².  A
velocity that is predicted to first order is stable up to the whole of its decay a step; the rest is left for
disorder."""


def braking_step(alpha: float, scene) -> float:
    """Δt ≤ 0.7/(B α c h), s, of a numerical friction along pairs of strength ``alpha``: see BRAKING."""
    braking = fastest_braking(scene.kernel, scene.spacing, scene.dimensions)
    rate = braking * scene.smoothing_length * alpha * scene.sound_speed
    return BRAKING / rate if rate > 0.0 else float("inf")


class ArtificialViscosity(NamedTuple):
    """Numerical friction between approaching particles: it spreads shocks and damps noise.

    a_i = −Σ_j m_j Π_ij ∇W_ij, Π = (−α c μ + β μ²)/ρ̄, μ = h u_ij·x_ij/(r² + 0.01 h²) where the pair
    approaches, else 0.  Monaghan (1992), Annu. Rev. Astron. Astrophys. 30, 543, eq. (4.1).  It
    conserves momentum and angular momentum.
    """

    conserves = ("momentum", "angular momentum")
    held = True

    alpha: Annotated[
        float, Field(ge=0, description="linear coefficient α", json_schema_extra={"unit": "1"})
    ] = 0.05
    beta: Annotated[
        float, Field(ge=0, description="quadratic coefficient β", json_schema_extra={"unit": "1"})
    ] = 0.0

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        h, c = i.smoothing_length, slower(i, j)
        v_i, v_j = i.specific_volume, j.specific_volume
        # μ = h (v_i + v_j) q and μ/ρ̄ = 2 h v_i v_j q: one division for both.
        q = min(pair.u_dot_x, 0.0) / ((pair.r2 + SINGULARITY * h * h) * (v_i + v_j))
        strength = self.alpha * c - self.beta * h * ((v_i + v_j) * q)
        return 2.0 * h * v_i * (v_j * q) * strength * pair.m_dw_r

    def numerical_viscosity(self, scene: Facts):
        """The kinematic viscosity of its linear part, m²/s: that of PairDamping for half of the pairs."""
        return 0.5 * _viscosity_of_pairs(self.alpha, scene)

    def longest_step(self, scene):
        """Δt ≤ 0.7/(B α c h), s: see :func:`braking_step`."""
        return braking_step(self.alpha, scene)

    def idle(self, scene: Facts, effects):
        """Why it has no influence, or None."""
        if self.alpha or self.beta:
            return None
        return "both of its coefficients are zero; remove physics.artificial_viscosity"


class PairDamping(NamedTuple):
    """Numerical friction along the line of every pair, approaching or parting: it damps sound.

    a_i = α c h Σ_j ρ₀ m_j/(ρ_i ρ_j) (u_ij·x_ij)/max(r², 0.01 h²) ∇W_ij, ρ₀ the smaller of the
    pair's two rest densities.  Monaghan & Gingold (1983), J.
    Comput. Phys. 52, 374; without the switch, Antuono, Colagrossi, Marrone & Molteni (2010), Comput.
    Phys. Commun. 181, 532.  It conserves momentum and angular momentum, and acts as a viscosity of
    αch/(2(d + 2)), αch/8 in 2D.
    """

    conserves = ("momentum", "angular momentum")
    held = True
    brakes = True
    """A light body too, faster than the fluid: see psph.scene.bodies.braked."""

    alpha: Annotated[float, Field(ge=0, description="coefficient α", json_schema_extra={"unit": "1"})] = 0.02

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        h, v_i, v_j = i.smoothing_length, i.specific_volume, j.specific_volume
        # ρ̄ = ρ_i ρ_j/ρ₀
        strength = self.alpha * h * slower(i, j) * (v_i * lighter(i, j))
        return strength * v_j * (pair.u_dot_x * inverse_square(pair, h)) * pair.m_dw_r

    def numerical_viscosity(self, scene: Facts):
        """The kinematic viscosity that it acts as, m²/s: αch/(2(d + 2)), the mean over all directions."""
        return _viscosity_of_pairs(self.alpha, scene)

    def longest_step(self, scene):
        """Δt ≤ 0.7/(B α c h), s: see :func:`braking_step`."""
        return braking_step(self.alpha, scene)

    def linear(self, scene: Facts):
        """Its part in linear theory."""
        return parts.LinearPairDamping(self.alpha)


class ImpactDamping(NamedTuple):
    """Numerical friction between neighbours that approach fast: it stops what hits a wall at up to c.

    a_i = −β Σ_j ρ₀ m_j/(ρ_i ρ_j) e² ∇W_ij, e = max(−h u_ij·x_ij/max(r², 0.01 h²) − c/5, 0), ρ₀ the
    smaller of the pair's two rest densities: over a length h of matter a speed falls by e^β.  von
    Neumann & Richtmyer (1950), J. Appl. Phys. 21, 232; for
    pairs, Monaghan (1989), J. Comput. Phys. 82, 1.  Theirs begins at once, and costs a rotating
    patch 1 % of its energy; with the onset water does not know of it.  It conserves momentum and
    angular momentum.
    """

    conserves = ("momentum", "angular momentum")

    beta: Annotated[
        float, Field(ge=0, le=4, description="coefficient β", json_schema_extra={"unit": "1"})
    ] = 2.0

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        h, v_i, v_j = i.smoothing_length, i.specific_volume, j.specific_volume
        strength = self.beta * (v_i * lighter(i, j))
        approach = -h * pair.u_dot_x * inverse_square(pair, h)
        excess = max(approach - ONSET * max(i.sound_speed, j.sound_speed), 0.0)
        return -strength * v_j * (excess * excess) * pair.m_dw_r
