"""Friction between particles that have a viscosity: one coefficient, whatever acts with it.

F_ij = m_j 2μ̄/(ρ_iρ_j) x_ij·∇W_ij/(r² + 0.01 h²) multiplies u_ij + Gᵀx_ij, with G the mean of the velocity
gradients of the two.  The sum is the divergence of μ(∇u + ∇uᵀ) up to walls and surfaces, and has its moments:
each pair of a fluid that turns as a whole feels F_ij (Ωx_ij + Ωᵀx_ij) = 0.  μ̄ = 2μ_iμ_j/(μ_i + μ_j) is the
mean by which a stress is continuous: Cleary & Monaghan (1999), J. Comput. Phys. 148, 227.  Of one fluid with
one ν, F_ij is that of Morris, Fox & Zhu (1997), J. Comput. Phys. 136, 214, with ((ρ_i + ρ_j)/2)² for ρ_iρ_j.
"""

from typing import Any, NamedTuple

from psph.engine.jit import call_by_type
from psph.fields import MATRIX, Field, VelocityGradient
from psph.formula import helper
from psph.moments import fastest_braking, fastest_smoothing
from psph.physics.fluid.strain import linear_gradient, no_rate, rate_weight, take_rate
from psph.vectors import add, applied, dot, scale, times, transposed

SINGULARITY = 0.01
"""η² = 0.01 h² keeps r² + η² away from zero."""

NO_VISCOSITY = 1e-30
"""Keeps a mean of two viscosities that are zero from dividing by zero, in single precision too."""

VELOCITY_GRADIENT = Field(
    "velocity_gradient",
    "1/s",
    "gradient of the velocity in a viscous fluid; 0 in a wall",
    MATRIX,
    image=VelocityGradient,
)


class Harmonic(NamedTuple):
    """Twice the harmonic mean: a stress is continuous, and there is none beside what has no viscosity."""

    def twice(self, one, two):
        """4ab/(a + b)."""
        return 4.0 * one * two / max(one + two, NO_VISCOSITY)


class Arithmetic(NamedTuple):
    """Twice the arithmetic mean, the better one where a viscosity varies smoothly: for grains alone."""

    def twice(self, one, two):
        """a + b."""
        return one + two


class Given(NamedTuple):
    """The viscosities are those of the case."""

    def kinematic(self, i):
        """ν of a fluid, m²/s; 0 in a wall."""
        return i.is_fluid * i.viscosity


class Apparent(NamedTuple):
    """The viscosities depend on the rate of strain (psph.physics.fluid.apparent)."""

    def kinematic(self, i):
        """η/ρ of a fluid, m²/s; 0 in a wall."""
        return i.apparent_viscosity * i.specific_volume


twice = call_by_type("twice")
"""(mean, a, b) → twice the mean of a and b."""
kinematic = call_by_type("kinematic")
"""(whose viscosities, i) → ν of a fluid, m²/s; 0 in a wall."""


@helper
def shared(form, i, j):
    """2μ̄/(ρ_iρ_j): a wall takes the viscosity of the fluid before it, if that rubs on it."""
    own, other = kinematic(form.of, i) * j.specific_volume, kinematic(form.of, j) * i.specific_volume
    one = own + (1.0 - i.is_fluid) * i.rubs * other
    two = other + (1.0 - j.is_fluid) * j.rubs * own
    return twice(form.mean, one, two)


@helper
def friction(form, i, j, pair, numerator):
    """F_ij ``numerator``/r², 1/s for r²."""
    h = i.smoothing_length
    return pair.m_dw_r * (shared(form, i, j) * numerator) / (pair.r2 + SINGULARITY * h * h)


@helper
def along_lines(form, i, j, pair):
    """(d + 2) F_ij (u_ij·x_ij)/r², 1/s²."""
    return (2.0 + len(pair.x_ij)) * friction(form, i, j, pair, pair.u_dot_x)


class Rub(NamedTuple):
    """F_ij with plain gradients, between the viscosities ``of`` two particles with their ``mean``."""

    of: Any = Given()
    mean: Any = Harmonic()

    def rub(self, i, j, pair):
        """F_ij, 1/s."""
        return friction(self, i, j, pair, pair.r2)


class CorrectedRub(NamedTuple):
    """F_ij with corrected gradients: m_j 2μ̄/(ρ_iρ_j) x_ij·(L_i + L_j)/2 ∇W_ij/r².

    As :class:`Rub`, less what makes it weak: on a lattice −Σ V x_ij·∇W_ij misses the number of dimensions by
    some percent, and 0.01 h² takes another.  Both stay however fine the spacing.
    """

    of: Any = Given()
    mean: Any = Harmonic()

    def rub(self, i, j, pair):
        """F_ij, 1/s."""
        stretch = add(i.gradient_correction, j.gradient_correction)
        stretch = 1.0 + 0.5 * dot(times(stretch, pair.x_ij), pair.x_ij) / pair.r2
        return pair.m_dw_r * shared(self, i, j) * stretch


rub = call_by_type("rub")
"""(form of the friction, i, j, pair) → F_ij, 1/s."""


def rub_of(scene, of=Given(), mean=Harmonic()):  # noqa: B008, values that nothing changes
    """The form of the friction that a scene needs: with corrected gradients where it has them."""
    form = Rub if scene.physics.gradient_correction is None else CorrectedRub
    return form(of, mean)


@helper
def viscous(j):
    """1 where neighbour j counts in the velocity gradient of a viscous fluid: it is one, else 0."""
    return j.is_fluid * j.rubs


@helper
def sheared(i, j, pair):
    """u_ij + Gᵀx_ij, m/s: between fluids G is the mean of theirs, beside a wall that of the fluid."""
    both = scale(add(i.velocity_gradient, j.velocity_gradient), 1.0 - 0.5 * i.is_fluid * j.is_fluid)
    return add(pair.u_ij, applied(transposed(both, pair.x_ij), pair.x_ij))


STEP = 0.125
"""Largest ν Δt/h² (Morris, Fox & Zhu 1997, eq. 22)."""

CENTRAL_STEP = 0.05
"""The same of friction along the lines of pairs, which damps compression up to 2.9 times as fast."""

LEFT, CENTRAL_LEFT = 0.8, 0.9
"""Δt times the fastest decay on the lattice: a predicted velocity is stable to 1, and the rest is left for
disorder, in which friction along lines is slower."""


def friction_step(scene, viscosity: float) -> float:
    """Δt ≤ 0.125 h²/ν of the largest kinematic ``viscosity``, s, and less where the kernel asks for it.

    ν Δt ≤ 0.4/S, S the fastest smoothing of the kernel on its lattice (psph.moments), so that the predicted
    velocity is stable: 0.095 h² with Wendland C4, 0.075 h² with C6.
    """
    fastest = fastest_smoothing(scene.kernel, scene.spacing, scene.dimensions)
    return min(STEP * scene.smoothing_length**2, 0.5 * LEFT / fastest) / viscosity


def central_step(scene, viscosity: float) -> float:
    """Δt ≤ 0.05 h²/ν of friction along lines, s, and less where the kernel asks for it.

    ν Δt ≤ 0.45/((d + 2) B), B the fastest braking along pairs (psph.moments).
    """
    fastest = (2.0 + scene.dimensions) * fastest_braking(scene.kernel, scene.spacing, scene.dimensions)
    return min(CENTRAL_STEP * scene.smoothing_length**2, 0.5 * CENTRAL_LEFT / fastest) / viscosity


def start_gradient(self, i):
    """No neighbour yet."""
    return no_rate(i)


def gather_gradient(self, total, i, j, pair):
    """Take the velocity and the place of a viscous neighbour."""
    weight = rate_weight(j, pair) * viscous(j)
    return take_rate(total, pair, pair.u_ij, weight, weight)


def finish_gradient(self, total, i, kernel):
    """G_i, 1/s."""
    return scale(linear_gradient(total, i), i.is_fluid)
