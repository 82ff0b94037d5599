"""How elastic solids turn, for the fluid that sticks to them."""

from typing import NamedTuple

from psph.fields import MATRIX, Field, VelocityGradient
from psph.formula import where
from psph.physics.facts import Facts
from psph.physics.fluid.strain import linear_gradient, no_rate, rate_weight, take_rate
from psph.vectors import scale, subtract, transposed

OWN_TURN = Field(
    "own_turn",
    "1/s",
    "how an elastic solid turns to which the fluid sticks: the velocity of what turns with it and is r away "
    "differs by [ω] r",
    MATRIX,
    image=VelocityGradient,
)


class SolidTurn(NamedTuple):
    """An elastic solid knows how it turns, where a fluid sticks to it.

    [ω]_i = (G_i − G_iᵀ)/2, G_i = −Σ_j V_j u_ij ∇W_ijᵀ M⁻¹, M = −Σ_j V_j x_ij ∇W_ijᵀ over the particles of the
    same solid: exact where it turns as a whole.  It is that of the step before, and serves
    :class:`psph.physics.walls.slip.NoSlip` as the turn of a rigid wall does.
    """

    writes = OWN_TURN
    lagged = True

    def in_scene(self, scene: Facts):
        """Nothing where no friction acts."""
        return self if scene.rheologies or any(one.viscosity for one in scene.species) else None

    def start(self, i):
        """No neighbour yet."""
        return no_rate(i)

    def gather(self, total, i, j, pair):
        """Take a neighbour of the same solid."""
        weight = rate_weight(j, pair) * where(max(i.solid - j.solid, j.solid - i.solid) > 0.5, 0.0, 1.0)
        return take_rate(total, pair, pair.u_ij, weight, weight)

    def finish_value(self, total, i, kernel):
        """The components of [ω] of such a solid, 1/s; zeros in all else."""
        gradient = linear_gradient(total, i)
        spin = scale(subtract(gradient, transposed(gradient, i.position)), 0.5)
        return scale(spin, i.no_slip * where(i.shear_modulus > 0.0, 1.0, 0.0))
