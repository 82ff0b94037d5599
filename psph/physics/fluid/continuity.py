"""How density follows the flow."""

from typing import NamedTuple

from psph.physics.facts import Facts


class Continuity(NamedTuple):
    """Density changes by the divergence of the velocity.

    dρ_i/dt = Σ_j m_j u_ij·∇W_ij.  SSPH paper, eq. (5); Monaghan (1994), J. Comput. Phys. 110, 399.
    """

    def density_rate(self, i, j, pair):
        """One neighbour's share of dρ_i/dt, kg/(m^d s)."""
        return pair.u_dot_x * pair.m_dw_r

    def linear(self, scene: Facts):
        """Linear theory includes it as it is."""
        return None
