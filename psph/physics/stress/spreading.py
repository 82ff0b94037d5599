"""The noise of an evolved stress spreads between neighbours of one soil, and its smooth part stays."""

from typing import NamedTuple

import numpy as np

from psph.acts import SOILS
from psph.engine.jit import call_by_type
from psph.fields import SLOPES, Turned
from psph.fields import Field as Declared
from psph.formula import helper, where
from psph.physics.facts import Facts
from psph.physics.fluid.correction import ROUGH, half_disorder
from psph.physics.fluid.strain import FEWEST
from psph.vectors import (
    add,
    adjugate,
    by_dimension,
    determinant,
    dot,
    dyad,
    outer,
    scale,
    subtract,
    zero_like,
)

STRESS_SLOPES = Declared(
    "stress_slopes", "Pa/m", "derivatives of the deviatoric stress along each axis", SLOPES, image=Turned
)

slopes_along = by_dimension(
    lambda m, a: (m[0] * a[0],),
    lambda m, a: (
        m[0] * a[0] + m[3] * a[1],
        m[1] * a[0] + m[4] * a[1],
        m[2] * a[0] + m[5] * a[1],
    ),
    lambda m, a: (
        m[0] * a[0] + m[6] * a[1] + m[12] * a[2],
        m[1] * a[0] + m[7] * a[1] + m[13] * a[2],
        m[2] * a[0] + m[8] * a[1] + m[14] * a[2],
        m[3] * a[0] + m[9] * a[1] + m[15] * a[2],
        m[4] * a[0] + m[10] * a[1] + m[16] * a[2],
        m[5] * a[0] + m[11] * a[1] + m[17] * a[2],
    ),
)
"""(m, a) → the derivative along a vector a of a symmetric matrix that has the slopes m (psph.fields)."""

by_inverse = by_dimension(
    lambda m, n, a: slopes_along(m, n),
    lambda m, n, a: slopes_along(m, (n[0], n[1])) + slopes_along(m, (n[1], n[2])),
    lambda m, n, a: (
        slopes_along(m, (n[0], n[1], n[2]))
        + slopes_along(m, (n[1], n[3], n[4]))
        + slopes_along(m, (n[2], n[4], n[5]))
    ),
)
"""(m, n, a) → slopes m times the symmetric matrix n; ``a`` is any vector of the dimension."""


@helper
def of_one_soil(i, j):
    """1 between particles of one soil, else 0; an image in a mirror that holds or bears it is of none."""
    weaker, stronger = min(i.strength, j.strength), max(i.strength, j.strength)
    return where(weaker > 0.0, 1.0, 0.0) * where(stronger > weaker, 0.0, 1.0)


@helper
def of_level_ground(level, i, j, pair):
    """s⁰(x_i) − s⁰(x_j), Pa: what weight asks of level ground at rest."""
    loosely = 1.0 - 0.5 * (i.rest_coefficient + j.rest_coefficient)
    depth = 0.5 * (i.rest_density + j.rest_density) * loosely * dot(pair.x_ij, level[0])
    return scale(level[1], depth)


@helper
def of_slopes(i, j, pair):
    """½(∇s_i + ∇s_j)·x_ij, Pa."""
    return scale(slopes_along(add(i.stress_slopes, j.stress_slopes), pair.x_ij), 0.5)


class LevelGround(NamedTuple):
    """The stress of level ground at rest stays, and no other: of soils with water in their pores."""

    def smooth(self, level, i, j, pair):
        """What stays of s_i − s_j, Pa."""
        return of_level_ground(level, i, j, pair)


class AnyOrder(NamedTuple):
    """All that is smooth stays."""

    def smooth(self, level, i, j, pair):
        """What stays of s_i − s_j, Pa."""
        return of_slopes(i, j, pair)


class SeenOrder(NamedTuple):
    """What is smooth stays where particles are in order, as
    :class:`psph.physics.fluid.correction.GradientCorrection` sees it; in disorder, of soil that flows, and at
    surfaces that of level ground."""

    def smooth(self, level, i, j, pair):
        """What stays of s_i − s_j, Pa."""
        share = 1.0 - half_disorder(ROUGH, i) - half_disorder(ROUGH, j)
        known = scale(of_level_ground(level, i, j, pair), 1.0 - share)
        return add(scale(of_slopes(i, j, pair), share), known)


smooth = call_by_type("smooth")
"""(order, level, i, j, pair) → what stays of the difference of the stresses of two particles, Pa."""


def order_of(scene: Facts):
    """How a scene tells order: by the type of its answer the loops are compiled."""
    if any(getattr(law, "pores", 0.0) for law in scene.strengths):
        return LevelGround()
    return AnyOrder() if scene.physics.gradient_correction is None else SeenOrder()


def levelled(scene: Facts):
    """(g in m/s², −(n nᵀ − ⅓ 1) with n along g): the deviator of level ground at rest by (1 − K₀) ρg·x."""
    g = np.array(scene.gravity)
    size = np.sqrt(g @ g) or 1.0
    shape = np.eye(len(g)) / 3.0 - np.outer(g, g) / size**2
    return tuple(g.tolist()), tuple(shape[np.triu_indices(len(g))].tolist())


@helper
def spread(order, level, i, j, pair):
    """2δhc V_j W′/r [s_i − s_j less what is smooth of it], Pa/s, between particles of one soil."""
    mixing = (i.stress_diffusion + j.stress_diffusion) * i.smoothing_length * i.sound_speed
    rough = subtract(subtract(i.deviator, j.deviator), smooth(order, level, i, j, pair))
    return scale(rough, of_one_soil(i, j) * mixing * j.specific_volume * pair.m_dw_r)


class StressSlopes(NamedTuple):
    """Between neighbours the noise of a soil's stress spreads, and what is smooth stays.

    ds_i/dt += 2δhc Σ_j V_j [s_i − s_j − ½(∇s_i + ∇s_j)·x_ij] W′/r between particles of one soil, in disorder
    and at surfaces with the slopes of level ground at rest under its weight; with
    ∇s_i = −Σ_j V_j (s_i − s_j) ∇W_ijᵀ M⁻¹, M = −Σ_j V_j x_ij ∇W_ijᵀ over these, of some steps before: 0
    where s is linear, up to a surface.  Antuono, Colagrossi, Marrone & Molteni (2010), Comput. Phys. Commun.
    181, 532, do so with the density.  Without the slopes (Feng, Fourtakas, Rogers & Lombardi 2021, Adv. Water
    Resour. 156, 104030) the stress of any load fades, and what rests on soil sinks for ever.  The sum is that
    of :class:`psph.physics.stress.deviator.DiffusedDeviatorRate`.
    """

    acts = (SOILS,)

    writes = STRESS_SLOPES
    lagged = True
    slow = True

    def in_scene(self, scene: Facts):
        """Where a soil asks for it."""
        if not any(one.stress_diffusion for one in scene.species):
            return None
        return None if isinstance(order_of(scene), LevelGround) else self

    def why_absent(self, scene: Facts):
        """What it lacks."""
        if any(one.stress_diffusion for one in scene.species):
            return (
                "there is water in pores of soil, whose stress would drift: that of level ground stays alone"
            )
        return "no soil has stress_diffusion"

    def start(self, i):
        """No neighbour yet."""
        return dyad(zero_like(i.position), zero_like(i.deviator)), outer(zero_like(i.position))

    def gather(self, total, i, j, pair):
        """Add −V_j (s_i − s_j) ∇W_ijᵀ and −V_j x_ij ∇W_ijᵀ."""
        weight = -of_one_soil(i, j) * j.specific_volume * pair.m_dw_r
        change = scale(dyad(pair.x_ij, subtract(i.deviator, j.deviator)), weight)
        return add(total[0], change), add(total[1], scale(outer(pair.x_ij), weight))

    def finish_value(self, total, i, kernel):
        """∇s_i, Pa/m; fades where det M < 0.1."""
        changes, place = total
        size = max(determinant(place, i.position), FEWEST)
        return by_inverse(changes, scale(adjugate(place, i.position), 1.0 / size), i.position)
