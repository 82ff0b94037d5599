"""How density follows the flow."""

from typing import NamedTuple

from psph.formula import where
from psph.physics.facts import Facts
from psph.physics.fluid.several import VolumeContinuity, facing_of, several


class Continuity(NamedTuple):
    """Density changes by the divergence of the velocity.

    dρ_i/dt = Σ_j m_j u_ij·∇W_ij.  SSPH paper, eq. (5); Monaghan (1994), J. Comput. Phys. 110, 399.
    """

    def in_scene(self, scene: Facts):
        """Where elastic solids stand in a fluid, and for several fluids, the form that knows them."""
        if several(scene):
            return VolumeContinuity(facing_of(scene))
        bonded = any(one.bonded is not None for one in scene.species)
        return ContinuityBesideBonded() if bonded and any(one.is_fluid for one in scene.species) else self

    def density_rate(self, i, j, pair):
        """One neighbour's share of dρ_i/dt, kg/(m^d s)."""
        return pair.u_dot_x * pair.m_dw_r

    def linear(self, scene: Facts):
        """Linear theory includes it as it is."""
        return None


class ContinuityBesideBonded(NamedTuple):
    """Density changes by the divergence of the velocity, and that of a solid by what the fluid does alone.

    As :class:`Continuity`, without pairs of an elastic solid with itself, another solid or a wall.  The
    pressure that a solid shows acts between it and the fluid alone, so only their motion may change it.  With
    the strain of the solid in it, it does work on the fluid that nothing pays for: a solid softer than the
    fluid, λ + 2μ below ρ_f c², then shakes ever faster, whatever the step.
    """

    def density_rate(self, i, j, pair):
        """One neighbour's share of dρ_i/dt, kg/(m^d s)."""
        beside = where(min(i.solid, j.solid) > 0.0, max(i.solid, j.solid), 0.0)
        return pair.u_dot_x * pair.m_dw_r * where(beside > 1.0, 0.0, 1.0)

    def linear(self, scene: Facts):
        """Linear theory knows of no solids in a fluid."""
        return None
