"""Friction along pairs that a smooth flow does not feel."""

from typing import Annotated, Any, NamedTuple

from pydantic import Field

from psph.engine.jit import call_by_type
from psph.fields import SYMMETRIC, StrainRate
from psph.fields import Field as Declared
from psph.formula import helper, where
from psph.physics.damping.matter import FluidsUnderTension, Matter, SeveralFluids, alike, matter_of
from psph.physics.facts import Facts
from psph.physics.fluid.correction import ROUGH, half_disorder, needs_correction
from psph.physics.fluid.strain import linear_rate, no_rate, rate_weight, take_rate
from psph.physics.fluid.viscosity import braking_step, inverse_square, lighter, slower
from psph.vectors import add, dot, times

NEAR = 0.7
"""Distance in spacings below which two particles are in disorder, and all of their motion is damped."""

AT_WALLS = 0.02
"""Speed of approach over the speed of sound that a wall does not damp."""


AT_OTHERS = 0.1
"""The same of another fluid: pairs of rows that slide along each other approach at up to their difference."""


class Whole(NamedTuple):
    """All that flows is seen in a mirror as what goes on behind the plane."""

    def flows(self, i, j):
        """1 where j flows on with i, else 0."""
        return j.is_fluid

    def lies(self, i, j):
        """1 where j counts as a part of what is around i, else 0."""
        return 1.0


class EndingAtPlanes(NamedTuple):
    """Soil ends at a mirror as at a wall: where it slides on one that holds it, that is no disorder.

    Its image moves the other way there; the number of its law is negative (psph.fields.Numbered).
    """

    def flows(self, i, j):
        """1 where j flows on with i, else 0."""
        return where(i.strength * j.strength < 0.0, 0.0, j.is_fluid)

    lies = Whole.lies


class EndingAtOthers(NamedTuple):
    """A fluid ends at one of another ``matter`` as at a free surface: both slide along each other, and
    that is no disorder; what approaches the other is damped as before a wall."""

    matter: Matter

    def flows(self, i, j):
        """1 where j flows on with i, else 0."""
        return j.is_fluid * alike(self.matter, i, j)

    def lies(self, i, j):
        """1 where j counts as a part of what is around i, else 0."""
        return 1.0 - i.is_fluid * j.is_fluid * (1.0 - alike(self.matter, i, j))


flows, lies = call_by_type("flows"), call_by_type("lies")
"""(images, i, j) → 1 or 0: see :class:`Whole`."""


@helper
def unfelt(images, i, j):
    """The speed of approach that what does not flow on with i does not damp, m/s."""
    return (AT_WALLS + (AT_OTHERS - AT_WALLS) * (1.0 - lies(images, i, j))) * slower(i, j)


def images_of(scene: Facts):
    """What flows on with what in a scene."""
    if scene.strengths:
        return EndingAtPlanes()
    matter = matter_of(scene)
    return EndingAtOthers(matter) if isinstance(matter, SeveralFluids | FluidsUnderTension) else Whole()


class ReconstructedDamping(NamedTuple):
    """Numerical friction along a pair, on its motion relative to the linear flow around: it damps disorder.

    a_i = α c h Σ_j ρ₀ m_j/(ρ_i ρ_j) s′/max(r², 0.01 h²) ∇W_ij, as :class:`PairDamping
    <psph.physics.fluid.viscosity.PairDamping>`, with s′ = s − g for its s = u_ij·x_ij: the flow that is
    linear between the two, g = ½ x_ij·(E_i + E_j)·x_ij clipped between 0 and s, is not felt, so that
    0 ≤ s′/s ≤ 1 and each pair only loses energy; g = 0 where r < 0.7 dx.  E_i = sym(−Σ_j V_j u_ij ∇W_ijᵀ M⁻¹)
    is the rate of strain of the step before: the sum over fluid neighbours, M = −Σ_j V_j x_ij ∇W_ijᵀ over all
    of them, so that it is exact for a linear flow up to a free surface, and smaller beside a wall.
    Frontiere, Raskin & Owen (2017), J. Comput. Phys. 332, 160, for a viscosity on approach.  In disorder and
    at a surface, as :class:`LocalPotential <psph.physics.order.potential.LocalPotential>` sees it with
    t = 0.2, α rises to ``in_disorder`` where that is larger: psph's own.  A wall damps what approaches it at
    more than 0.02 c, the excess alone, and nothing else; so does a fluid of another density, at 0.1 c, and
    counts in no sum.  It conserves momentum and angular momentum.
    """

    conserves = ("momentum", "angular momentum")

    alpha: Annotated[float, Field(ge=0, description="coefficient α", json_schema_extra={"unit": "1"})] = 0.05
    in_disorder: Annotated[
        float,
        Field(
            ge=0, description="α in disorder and at a surface, where larger", json_schema_extra={"unit": "1"}
        ),
    ] = 0.0

    def in_scene(self, scene: Facts):
        """The form that knows the spacing."""
        more = max(self.in_disorder - self.alpha, 0.0)
        return BesideLinearFlow(self.alpha, (NEAR * scene.spacing) ** 2, more, images_of(scene))

    @staticmethod
    def conflicts(physics, kernel):
        """The rate of strain takes corrected gradients."""
        yield from needs_correction(physics)


class BesideLinearFlow(NamedTuple):
    """Numerical friction along a pair, on its motion relative to the linear flow around: it damps disorder.

    The form of :class:`ReconstructedDamping` in a scene; ``near2`` is (0.7 dx)², m², ``more`` what α gains
    in disorder; ``images`` say what a mirror shows.
    """

    conserves = ("momentum", "angular momentum")
    held = True

    alpha: float
    near2: float
    more: float = 0.0
    images: Any = Whole()

    writes = Declared("strain", "1/s", "rate of strain of the fluid", SYMMETRIC, image=StrainRate)
    lagged = True
    slow = True

    def start(self, i):
        """No neighbour yet."""
        return no_rate(i)

    def gather(self, total, i, j, pair):
        """Take the velocity of a fluid neighbour, and the place of any."""
        weight, images = rate_weight(j, pair), self.images
        return take_rate(total, pair, pair.u_ij, weight * flows(images, i, j), weight * lies(images, i, j))

    def finish_value(self, total, i, kernel):
        """E_i, 1/s."""
        return linear_rate(total, i)

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        h, v_i, v_j = i.smoothing_length, i.specific_volume, j.specific_volume
        s = pair.u_dot_x
        g = 0.5 * dot(pair.x_ij, times(add(i.strain, j.strain), pair.x_ij))
        g = min(max(g, min(s, 0.0)), max(s, 0.0))
        rest = s - where(pair.r2 > self.near2, g, 0.0)
        approach = min(s + unfelt(self.images, i, j) * pair.r, 0.0)
        felt = where(i.is_fluid * flows(self.images, i, j) > 0.0, rest, approach)
        alpha = self.alpha + self.more * (half_disorder(ROUGH, i) + half_disorder(ROUGH, j))
        strength = alpha * h * slower(i, j) * (v_i * lighter(i, j))
        return strength * v_j * (felt * inverse_square(pair, h)) * pair.m_dw_r

    def longest_step(self, scene):
        """That of :class:`psph.physics.fluid.viscosity.PairDamping`, of the largest α, s."""
        return braking_step(self.alpha + self.more, scene)

    def held_apart(self, scene: Facts):
        """Rates of fluid neighbours may serve for several steps.  Those of walls act in each: held, they
        would push on what has bounced off."""
        if all(one.is_fluid for one in scene.species):
            return (self,)
        return InFluid(*self), AtWalls(self.alpha, self.more, self.images)


along_pair = helper(BesideLinearFlow.radial)
"""(effect, i, j, pair) → 1/s², of any pair."""


class InFluid(NamedTuple):
    """Numerical friction along a pair of fluid neighbours, on its motion relative to the linear flow around.

    The part of :class:`BesideLinearFlow` whose rates may serve for several steps.
    """

    conserves = ("momentum", "angular momentum")
    held = True

    alpha: float
    near2: float
    more: float
    images: Any

    writes, lagged, slow = BesideLinearFlow.writes, True, True
    start, gather = BesideLinearFlow.start, BesideLinearFlow.gather
    finish_value, longest_step = BesideLinearFlow.finish_value, BesideLinearFlow.longest_step

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        return where(i.is_fluid * flows(self.images, i, j) > 0.0, along_pair(self, i, j, pair), 0.0)


class AtWalls(NamedTuple):
    """Numerical friction along a pair of a fluid and a wall, where they approach at more than 0.02 c.

    The part of :class:`BesideLinearFlow` that acts in every step.
    """

    conserves = ("momentum", "angular momentum")

    alpha: float
    more: float
    images: Any

    longest_step = BesideLinearFlow.longest_step

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        h, v_i, v_j = i.smoothing_length, i.specific_volume, j.specific_volume
        approach = min(pair.u_dot_x + unfelt(self.images, i, j) * pair.r, 0.0)
        felt = where(i.is_fluid * flows(self.images, i, j) > 0.0, 0.0, approach)
        alpha = self.alpha + self.more * (half_disorder(ROUGH, i) + half_disorder(ROUGH, j))
        strength = alpha * h * slower(i, j) * (v_i * lighter(i, j))
        return strength * v_j * (felt * inverse_square(pair, h)) * pair.m_dw_r
