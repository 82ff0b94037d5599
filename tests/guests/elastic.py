"""A guest: an effect with an evolved tensor.  A soft solid: its deviatoric stress follows the flow.

dS_i/dt = 2G (ε̇_i − tr ε̇_i/d) with ε̇_i = −Σ_j V_j (u_ij ∇W_ijᵀ + ∇W_ij u_ijᵀ)/2, and
a_i = Σ_j m_j (S_i/ρ_i² + S_j/ρ_j²) ∇W_ij.  Gray, Monaghan & Swift (2001), without the rotation terms.
"""

from typing import Annotated, NamedTuple

from pydantic import Field

from psph.engine.jit import register_jitable
from psph.fields import SYMMETRIC, Stress
from psph.fields import Field as Declared
from psph.physics.catalogue import Catalogue, Entry
from psph.vectors import add, less_diagonal, outer, scale, subtract, times, zero_like


@register_jitable
def trace(m, like):
    """The sum of the diagonal of a symmetric matrix."""
    if len(like) == 1:
        return m[0]
    if len(like) == 2:
        return m[0] + m[-1]
    return m[0] + m[3 % len(m)] + m[-1]


class Elasticity(NamedTuple):
    """A soft solid resists shear in proportion to what it was sheared by."""

    shear_modulus: Annotated[
        float, Field(ge=0, description="shear modulus G", json_schema_extra={"unit": "Pa"})
    ]

    writes = Declared("stress", "Pa", "deviatoric stress", SYMMETRIC, saved=True, evolves=True, image=Stress)

    def start(self, i):
        """No neighbour yet."""
        return outer(zero_like(i.position))

    def gather(self, total, i, j, pair):
        """Add −V_j (u_ij x_ijᵀ + x_ij u_ijᵀ)/2 W′/r."""
        both = outer(add(pair.u_ij, pair.x_ij))
        less = outer(subtract(pair.u_ij, pair.x_ij))  # a bᵀ + b aᵀ = ((a+b)(a+b)ᵀ − (a−b)(a−b)ᵀ)/2
        return add(total, scale(subtract(both, less), -0.25 * j.specific_volume * pair.m_dw_r))

    def finish_value(self, total, i, kernel):
        """dS/dt, Pa/s."""
        mean = trace(total, i.position) / len(i.position)
        return scale(less_diagonal(total, mean, i.position), 2.0 * self.shear_modulus)

    def push(self, i, j, pair):
        """What S_i and S_j do, m/s²."""
        v_i, v_j = i.specific_volume, j.specific_volume
        both = add(scale(i.stress, v_i * v_i), scale(j.stress, v_j * v_j))
        return scale(times(both, pair.x_ij), pair.m_dw_r)


CATALOGUE = Catalogue(effects=(Entry("physics.elasticity", Elasticity),))
