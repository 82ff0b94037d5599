"""The deviatoric stress of matter that resists shear: how it evolves, and how it acts.

The stress is σ = s − p1, tension positive, with p from the density as that of a fluid; in 2D the matter is in
plane strain, and s_zz = −(s_xx + s_yy).  A fluid beside it has G = 0 and s = 0.
"""

from typing import Any, NamedTuple

from psph.acts import SOILS, UPDATED
from psph.fields import SYMMETRIC, StressUnderWeight
from psph.fields import Field as Declared
from psph.formula import helper
from psph.physics.damping.diffusion import diffusion_step
from psph.physics.facts import Facts
from psph.physics.fluid.strain import FEWEST, linear_gradient, no_rate, rate_weight, take_rate
from psph.physics.stress.faces import OwnPressure, Sticking, across, column_of, counts, faces_of, steepness
from psph.physics.stress.spreading import AnyOrder, levelled, order_of, spread
from psph.vectors import (
    add,
    less_diagonal,
    matrix_product,
    outer,
    scale,
    skew_part,
    symmetric_part,
    times,
    trace,
    zero_like,
)

DEVIATOR = Declared(
    "deviator",
    "Pa",
    "deviatoric stress, tension positive",
    SYMMETRIC,
    saved=True,
    evolves=True,
    image=StressUnderWeight,
)

FEWEST_OF_ELASTIC = 0.45
"""Determinant of M below which the gradient of the velocity fades in matter that never yields, in 2D.  In 3D
its power 3/2: at a surface M is below 1 along each axis, along z of a solid that is drawn out too."""


@helper
def jaumann_rate(gradient, s, shear_modulus, like):
    """ds/dt = 2G (D − ⅓ tr D 1) + Ωs + sΩᵀ, Pa/s, of the velocity gradient D + Ω by rows, 1/s.

    D − ⅓ tr D in 2D too: plane strain.  ``like`` is any vector of the dimension.
    """
    rate = symmetric_part(gradient, like)
    shear = less_diagonal(rate, trace(rate, like) / 3.0, like)
    turned = symmetric_part(matrix_product(skew_part(gradient, like), s, like), like)
    return add(scale(shear, 2.0 * shear_modulus), scale(turned, 2.0))


@helper
def take_neighbour(faces, total, j, pair):
    """Take what counts of a neighbour into the sums of a velocity gradient."""
    weight = rate_weight(j, pair)
    return take_rate(total, pair, across(faces, j, pair), weight, weight * counts(faces, j, pair))


class DeviatorRate(NamedTuple):
    """The deviatoric stress follows the flow: elastic, with the rate of Jaumann.

    ds_i/dt = 2G (D − ⅓ tr D 1) + Ωs + sΩᵀ, D and Ω the symmetric and the skew part of
    ∇v_i = −Σ_j V_j u_ij ∇W_ijᵀ M⁻¹, M = −Σ_j V_j x_ij ∇W_ijᵀ, over neighbours that resist shear and walls
    without slip, of other walls with n(n·u_ij) for u_ij (:class:`psph.physics.stress.faces.SmoothFace`):
    exact for a linear flow up to a surface.  Gray, Monaghan & Swift (2001), Comput. Methods Appl. Mech. Eng.
    190, 6641; corrected, Randles & Libersky (1996), 139, 375.
    """

    acts = (SOILS, UPDATED)

    least: float = FEWEST
    faces: Any = Sticking()

    writes = DEVIATOR
    written_in = True

    def in_scene(self, scene: Facts):
        """Where soils ask for it, the form whose stress spreads between neighbours too; in matter that never
        yields the correction fades sooner: else particles with few neighbours, at an edge, tear out."""
        if not scene.strengths:
            return DeviatorRate(FEWEST_OF_ELASTIC ** (max(scene.dimensions, 2) / 2.0), faces_of(scene))
        diffusion = max(one.stress_diffusion for one in scene.species)
        if not diffusion:
            return DeviatorRate(self.least, faces_of(scene))
        return DiffusedDeviatorRate(diffusion, levelled(scene), order_of(scene), faces_of(scene))

    def start(self, i):
        """No neighbour yet."""
        return no_rate(i)

    def gather(self, total, i, j, pair):
        """Take a neighbour that holds."""
        return take_neighbour(self.faces, total, j, pair)

    def finish_value(self, total, i, kernel):
        """ds/dt, Pa/s; 0 in what does not resist shear."""
        gradient = linear_gradient(total, i, self.least)
        return jaumann_rate(gradient, i.deviator, i.shear_modulus, i.position)


class DiffusedDeviatorRate(NamedTuple):
    """The deviatoric stress follows the flow, with the rate of Jaumann, and its noise spreads.

    As :class:`DeviatorRate`, and what :class:`psph.physics.stress.spreading.StressSlopes` says.  The pressure
    spreads as that of fluids does.  ``largest`` δ of any soil, ``level`` by
    :func:`psph.physics.stress.spreading.levelled`.
    """

    largest: float
    level: tuple
    order: Any = AnyOrder()
    faces: Any = Sticking()

    writes = DEVIATOR
    written_in = True

    def start(self, i):
        """No neighbour yet."""
        return no_rate(i), outer(zero_like(i.position))

    def gather(self, total, i, j, pair):
        """Take a neighbour that holds, and what it spreads."""
        flow = take_neighbour(self.faces, total[0], j, pair)
        return flow, add(total[1], spread(self.order, self.level, i, j, pair))

    def finish_value(self, total, i, kernel):
        """ds/dt, Pa/s; 0 in what does not resist shear."""
        flow = jaumann_rate(linear_gradient(total[0], i), i.deviator, i.shear_modulus, i.position)
        return add(flow, total[1])

    def longest_step(self, scene):
        """Δt ≤ 0.15/(S h δ c), s, as that of the diffusion of density."""
        return diffusion_step(self.largest, scene)


class DeviatoricForce(NamedTuple):
    """The divergence of the deviatoric stress, symmetric in the pair.

    a_i = Σ_j m_j (s_i/ρ_i² + s_j/ρ_j²) ∇W_ij; a wall without slip shows the particle before it s_j/ρ_j² =
    s_i/ρ_i², of soil in proportion to the pressure (:func:`shown`), others what
    :class:`psph.physics.stress.faces.SmoothFace` says.  Gray, Monaghan & Swift
    (2001); with the pressure of :class:`psph.physics.fluid.pressure.SymmetricPressure` it is the force of the
    whole stress.
    """

    acts = (SOILS, UPDATED)

    column: Any = OwnPressure()

    conserves = ("momentum",)

    def in_scene(self, scene: Facts):
        """With corrected gradients, the form that has them."""
        plain = scene.physics.gradient_correction is None
        return (DeviatoricForce if plain else CorrectedDeviatoricForce)(column_of(scene))

    def push(self, i, j, pair):
        """Acceleration, m/s²."""
        own, other = shown(self.column, i, j, pair)
        both = add(scale(i.deviator, own), scale(j.deviator, other))
        return scale(times(both, pair.x_ij), pair.m_dw_r)


class CorrectedDeviatoricForce(NamedTuple):
    """The divergence of the deviatoric stress, symmetric in the pair, with corrected gradients.

    a_i = Σ_j m_j (s_i L_i/ρ_i² + s_j L_j/ρ_j²) ∇W_ij, with the L that the pressure has under
    :class:`psph.physics.fluid.correction.GradientCorrection`; walls as in :class:`DeviatoricForce`.
    """

    column: Any = OwnPressure()

    conserves = ("momentum",)

    def push(self, i, j, pair):
        """Acceleration, m/s²."""
        own, other = shown(self.column, i, j, pair)
        x = pair.x_ij
        at_i = times(i.deviator, add(x, times(i.gradient_correction, x)))
        at_j = times(j.deviator, add(x, times(j.gradient_correction, x)))
        return scale(add(scale(at_i, own), scale(at_j, other)), pair.m_dw_r)


@helper
def shown(column, i, j, pair):
    """1/ρ_i² and 1/ρ_j² as factors of s_i and s_j; a wall without slip shows what is before it that one's s.

    In proportion to the pressure (:func:`steepness`).  What does not resist shear has s = 0.
    """
    steep_i, steep_j = steepness(column, i, j, pair)
    own, other = i.specific_volume * i.specific_volume, j.specific_volume * j.specific_volume
    return own * (1.0 + j.no_slip * steep_j), other * (1.0 + i.no_slip * steep_i)
