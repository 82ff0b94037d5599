"""A stress that near neighbours feel and farther ones hardly do."""

from typing import Annotated, NamedTuple

from pydantic import Field

from psph.formula import where
from psph.physics.facts import Facts
from psph.physics.stress.repulsion import PrincipalStress
from psph.theory.stability import parts

COMPRESSED = 0.01
"""R over p/ρ² where both pressures are positive, against lines of particles (Monaghan 2000)."""


class ArtificialStress(NamedTuple):
    """Near neighbours repel in a fluid under tension, in proportion to its pressure.

    a_i = −Σ_j m_j R_ij (W_ij/W(dx))⁴ ∇W_ij, R_ij = R_i + R_j, R_i = ε|p_i|/ρ_i² where p_i < 0, else
    0; and R_ij = 0.01 (p_i/ρ_i² + p_j/ρ_j²) where both pressures are positive.  Monaghan (2000),
    J. Comput. Phys. 159, 290, with its n = 4; for stresses in solids Gray, Monaghan & Swift (2001),
    Comput. Methods Appl. Mech. Eng. 190, 6641.  It conserves momentum and angular momentum, but no
    energy: what a pair gains depends on the pressure around it.
    """

    conserves = ("momentum", "angular momentum")

    epsilon: Annotated[
        float,
        Field(ge=0, description="ε: R over |p|/ρ² under tension", json_schema_extra={"unit": "1"}),
    ] = 0.2

    def in_scene(self, scene: Facts):
        """With the kernel's weight of a neighbour one spacing away; for stresses, where there are any."""
        inverse_near = 1.0 / float(scene.kernel.w(scene.spacing))
        if any(one.shear_modulus for one in scene.species):
            return PrincipalStress(self.epsilon, inverse_near)
        return NeighbourStress(self.epsilon, inverse_near)

    @staticmethod
    def conflicts(physics, kernel):
        """It is made for one form of the pressure gradient."""
        if physics.pressure_gradient != "symmetric":
            yield (
                'works only with physics.pressure_gradient = "symmetric", and here it is '
                f'"{physics.pressure_gradient}"; use "symmetric", or remove this key'
            )


class NeighbourStress(NamedTuple):
    """Near neighbours repel in a fluid under tension, in proportion to its pressure.

    See :class:`ArtificialStress`; ``inverse_near`` is 1/W(dx), m^d.
    """

    conserves = ("momentum", "angular momentum")

    epsilon: float
    inverse_near: float

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        v_i, v_j = i.specific_volume, j.specific_volume
        own, other = i.pressure * v_i * v_i, j.pressure * v_j * v_j
        pulled = -self.epsilon * (min(own, 0.0) + min(other, 0.0))
        pressed = where(min(own, other) > 0.0, COMPRESSED * (own + other), 0.0)
        nearness = pair.w * self.inverse_near
        return -(pulled + pressed) * nearness**4 * pair.m_dw_r

    def linear(self, scene: Facts):
        """Its part in linear theory."""
        return parts.LinearArtificialStress(self.epsilon)
