"""Friction along pairs that a smooth flow does not feel."""

from typing import Annotated, Any, NamedTuple

import numpy as np
from pydantic import Field

from psph.engine.jit import call_by_type
from psph.fields import SYMMETRIC, VECTOR, StrainRate, Turned
from psph.fields import Field as Declared
from psph.formula import helper, where
from psph.physics.damping.matter import FluidsUnderTension, Matter, OneMatter, SeveralFluids, alike, matter_of
from psph.physics.facts import Facts
from psph.physics.fluid.correction import ROUGH, half_disorder, needs_correction
from psph.physics.fluid.rheology import thickest
from psph.physics.fluid.strain import linear_rate, no_rate, rate_weight, take_rate
from psph.physics.fluid.viscosity import braking_step, inverse_square, lighter, slower
from psph.vectors import add, dot, scale, subtract, times, zero_like

STRAIN = Declared("strain", "1/s", "rate of strain of the fluid", SYMMETRIC, image=StrainRate)
FACING = Declared("facing", "1", "unit normal of what a fluid ends at, 0 without", VECTOR, image=Turned)

NEAR = 0.7
"""Distance in spacings below which two particles are in disorder, and all of their motion is damped."""

AT_WALLS = 0.02
"""Speed of approach over the speed of sound that a wall does not damp."""

AT_OTHERS = 0.1
"""The same of another fluid: pairs of rows that slide along each other approach at up to their difference."""

NO_NORMAL = 1e-12
"""Square of h times a sum over what the fluid ends at, below which there is none."""


class Whole(NamedTuple):
    """All that flows is seen in a mirror as what goes on behind the plane."""

    def flows(self, i, j):
        """1 where j flows on with i, else 0."""
        return j.is_fluid

    def is_other(self, i, j):
        """1 where i and j are fluids that part, else 0."""
        return 0.0


class EndingAtOthers(NamedTuple):
    """A fluid ends at one of another ``matter`` as at a free surface: both slide along each other, and
    that is no disorder; what approaches the other is damped as before a wall."""

    matter: Matter

    def flows(self, i, j):
        """1 where j flows on with i, else 0."""
        return j.is_fluid * alike(self.matter, i, j)

    def is_other(self, i, j):
        """1 where i and j are fluids that part, else 0."""
        return i.is_fluid * j.is_fluid * (1.0 - alike(self.matter, i, j))


class WithStrengths(NamedTuple):
    """Soils flow on with each other; water ends at them, and at water of another ``matter``, as
    :class:`EndingAtOthers`.  Soil ends at a mirror that holds it as at a wall: where it slides on it, that is
    no disorder.

    Its image moves the other way there; the number of its law is negative (psph.fields.Continued).
    """

    matter: Matter

    def flows(self, i, j):
        """1 where j flows on with i, else 0."""
        held = where(i.strength * j.strength < 0.0, 1.0, _apart(self.matter, i, j))
        return j.is_fluid * (1.0 - held)

    def is_other(self, i, j):
        """1 where i and j are fluids, or a soil and a fluid, that part, else 0."""
        return i.is_fluid * j.is_fluid * _apart(self.matter, i, j)


@helper
def _apart(matter, i, j):
    """0 of two soils, 1 of soil and water, and of waters where they are of two matters."""
    either, both = abs(i.strength) + abs(j.strength), abs(i.strength * j.strength)
    return where(both > 0.0, 0.0, where(either > 0.0, 1.0, 1.0 - alike(matter, i, j)))


flows, is_other = call_by_type("flows"), call_by_type("is_other")
"""(images, i, j) → 1 or 0: see :class:`Whole`."""


def images_of(scene: Facts):
    """What flows on with what in a scene."""
    matter = _parting(scene)
    if scene.strengths:
        return WithStrengths(matter)
    return Whole() if isinstance(matter, OneMatter) else EndingAtOthers(matter)


def _parting(scene: Facts) -> Matter:
    """Which fluids part, whatever is beside them: walls, solids and soils do not make them several."""
    matter = matter_of(scene)
    if isinstance(matter, FluidsUnderTension):
        return matter
    fluids = {(one.density, one.wave_speed) for one in scene.species if one.is_fluid}
    return SeveralFluids() if len(fluids) > 1 else OneMatter()


@helper
def along_pair(effect, felt, i, j, pair):
    """Coefficient of x_ij in the acceleration by a ``felt`` s′ of u_ij·x_ij, m²/s: 1/s²."""
    alpha = effect.alpha + effect.more * (half_disorder(ROUGH, i) + half_disorder(ROUGH, j))
    strength = alpha * i.smoothing_length * slower(i, j) * (i.specific_volume * lighter(i, j))
    spread = inverse_square(pair, i.smoothing_length)
    return strength * j.specific_volume * (felt * spread) * pair.m_dw_r


@helper
def beside_flow(effect, i, j, pair):
    """u_ij·x_ij less what the linear flow around has of it, m²/s."""
    s = pair.u_dot_x
    g = 0.5 * dot(pair.x_ij, times(add(i.strain, j.strain), pair.x_ij))
    g = min(max(g, min(s, 0.0)), max(s, 0.0))
    return s - where(pair.r2 > effect.near2, g, 0.0)


@helper
def come_fast(images, i, j, pair):
    """The part of u_ij·x_ij, m²/s, that what does not flow on with i damps: the approach along its normal, or
    along the pair where that is slower, in excess of 0.02 c, of another fluid 0.1 c.  What slides along it
    does not approach it.  A wall has no normal; those of two fluids add up, and count up to four times."""
    normal = subtract(i.facing, j.facing)
    s = dot(pair.u_ij, normal) * dot(pair.x_ij, normal)
    unfelt = (AT_WALLS + (AT_OTHERS - AT_WALLS) * is_other(images, i, j)) * slower(i, j)
    return min(max(s, pair.u_dot_x) + unfelt * pair.r, 0.0)


class ReconstructedDamping(NamedTuple):
    """Numerical friction along a pair, on its motion relative to the linear flow around: it damps disorder.

    a_i = α c h Σ_j ρ₀ m_j/(ρ_i ρ_j) s′/max(r², 0.01 h²) ∇W_ij, as :class:`PairDamping
    <psph.physics.fluid.viscosity.PairDamping>`, with s′ = s − g for its s = u_ij·x_ij: the flow that is
    linear between the two, g = ½ x_ij·(E_i + E_j)·x_ij clipped between 0 and s, is not felt, so that
    0 ≤ s′/s ≤ 1 and each pair only loses energy; g = 0 where r < 0.7 dx.  E_i = sym(−Σ_j V_j u_ij ∇W_ijᵀ M⁻¹)
    is the rate of strain of the step before, M = −Σ_j V_j x_ij ∇W_ijᵀ, both over fluid neighbours: exact for
    a linear flow up to a free surface and a wall.  Frontiere, Raskin & Owen (2017), J. Comput. Phys. 332,
    160, for a viscosity on approach.  In disorder and at a surface, as :class:`LocalPotential
    <psph.physics.order.potential.LocalPotential>` sees it with t = 0.2, α rises to ``in_disorder`` where that
    is larger: psph's own; in a domain that one fluid fills, soils and tensions apart, no further than its own
    viscosity acts, unless walls take its pressure (sound between those grows).  A wall damps what approaches
    it along its normal at more than 0.02 c, the excess alone, and nothing else; so does a fluid of another
    density, at 0.1 c.  It conserves momentum and angular momentum.
    """

    conserves = ("momentum", "angular momentum")

    alpha: Annotated[float, Field(ge=0, description="coefficient α", json_schema_extra={"unit": "1"})] = 0.05
    in_disorder: Annotated[
        float,
        Field(
            ge=0,
            description="α in disorder and at a surface, where larger; where one fluid fills the domain no "
            "larger than its own viscosity acts, unless walls are extrapolated",
            json_schema_extra={"unit": "1"},
        ),
    ] = 0.0

    def in_scene(self, scene: Facts):
        """The form that knows the spacing, and how far α rises."""
        images = images_of(scene)
        filled = isinstance(images, Whole) and not scene.has_free_surface
        # Sound between walls that take the pressure of the fluid grows: what is capped there blows up.
        capped = filled and not any(one.extrapolated for one in scene.species)
        most = min(self.in_disorder, own_alpha(scene)) if capped else self.in_disorder
        more = max(most - self.alpha, 0.0)
        ends = isinstance(images, WithStrengths | EndingAtOthers) or not _all_flows(scene)
        form = DampingToEdges if ends else BesideLinearFlow
        return form(self.alpha, (NEAR * scene.spacing) ** 2, more, images)

    @staticmethod
    def conflicts(physics, kernel):
        """The rate of strain takes corrected gradients."""
        yield from needs_correction(physics)


def own_alpha(scene: Facts) -> float:
    """The α that acts as the most viscous fluid's own viscosity ν does: 2(d + 2) ν/(c h) in d dimensions."""
    return 2.0 * (scene.dimensions + 2) * thickest(scene) / (scene.sound_speed * scene.smoothing_length)


def _all_flows(scene: Facts) -> bool:
    """Whether all particles are of fluids."""
    return all(one.is_fluid for one in scene.species)


class BesideLinearFlow(NamedTuple):
    """Numerical friction along a pair, on its motion relative to the linear flow around: it damps disorder.

    The form of :class:`ReconstructedDamping` where all particles flow on with each other; ``near2`` is
    (0.7 dx)², m², ``more`` what α gains in disorder; ``images`` say what a mirror shows.
    """

    conserves = ("momentum", "angular momentum")
    held = True

    alpha: float
    near2: float
    more: float = 0.0
    images: Any = Whole()

    writes = STRAIN
    lagged = True
    slow = True

    def start(self, i):
        """No neighbour yet."""
        return no_rate(i)

    def gather(self, total, i, j, pair):
        """Take the velocity of a fluid neighbour, and its place."""
        weight = rate_weight(j, pair) * flows(self.images, i, j)
        return take_rate(total, pair, pair.u_ij, weight, weight)

    def finish_value(self, total, i, kernel):
        """E_i, 1/s."""
        return linear_rate(total, i)

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        return along_pair(self, beside_flow(self, i, j, pair), i, j, pair)

    @property
    def in_force(self) -> str:
        """The two α of the scene."""
        return f"alpha {self.alpha:.3g}, in disorder {self.alpha + self.more:.3g}"

    def longest_step(self, scene):
        """That of :class:`psph.physics.fluid.viscosity.PairDamping`, of the largest α, s."""
        return braking_step(self.alpha + self.more, scene)


class DampingToEdges(NamedTuple):
    """Numerical friction along a pair, on its motion relative to the linear flow around, or on its approach.

    The form of :class:`ReconstructedDamping` where fluids end at walls, bodies or other fluids.
    """

    conserves = ("momentum", "angular momentum")
    held = True

    alpha: float
    near2: float
    more: float = 0.0
    images: Any = Whole()

    writes = (STRAIN, FACING)
    lagged, slow = True, True
    longest_step, in_force = BesideLinearFlow.longest_step, BesideLinearFlow.in_force

    def start(self, i):
        """No neighbour yet."""
        return no_rate(i), zero_like(i.position)

    def gather(self, total, i, j, pair):
        """Take a fluid neighbour, as :class:`BesideLinearFlow` does, or the place of another."""
        weight, flowing = rate_weight(j, pair), flows(self.images, i, j)
        rate = take_rate(total[0], pair, pair.u_ij, weight * flowing, weight * flowing)
        return rate, add(total[1], scale(pair.x_ij, weight * (1.0 - flowing)))

    def finish_value(self, total, i, kernel):
        """E_i, 1/s, and the normal of what a fluid ends at; that is 0 elsewhere."""
        small = NO_NORMAL / (i.smoothing_length * i.smoothing_length)
        size = i.is_fluid / np.sqrt(max(dot(total[1], total[1]), small))
        return linear_rate(total[0], i) + scale(total[1], size)

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        within, fast = beside_flow(self, i, j, pair), come_fast(self.images, i, j, pair)
        felt = where(i.is_fluid * flows(self.images, i, j) > 0.0, within, fast)
        return along_pair(self, felt, i, j, pair)

    def held_apart(self, scene: Facts):
        """Rates of fluid neighbours may serve for several steps.  Those of walls act in each: held, they
        would push on what has bounced off."""
        return (self,) if _all_flows(scene) else (InFluid(*self), AtWalls(*self))


class InFluid(NamedTuple):
    """Numerical friction along a pair of fluid neighbours, on its motion relative to the linear flow around.

    The part of :class:`DampingToEdges` whose rates may serve for several steps.
    """

    conserves = ("momentum", "angular momentum")
    held = True

    alpha: float
    near2: float
    more: float
    images: Any

    writes, lagged, slow = DampingToEdges.writes, True, True
    start, gather = DampingToEdges.start, DampingToEdges.gather
    finish_value, longest_step = DampingToEdges.finish_value, DampingToEdges.longest_step
    in_force = BesideLinearFlow.in_force

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        within = along_pair(self, beside_flow(self, i, j, pair), i, j, pair)
        return where(i.is_fluid * flows(self.images, i, j) > 0.0, within, 0.0)


class AtWalls(NamedTuple):
    """Numerical friction along a pair of a fluid and a wall, where they approach at more than 0.02 c.

    The part of :class:`DampingToEdges` that acts in every step.
    """

    conserves = ("momentum", "angular momentum")

    alpha: float
    near2: float
    more: float
    images: Any

    longest_step = BesideLinearFlow.longest_step

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        fast = along_pair(self, come_fast(self.images, i, j, pair), i, j, pair)
        return where(i.is_fluid * flows(self.images, i, j) > 0.0, 0.0, fast)
