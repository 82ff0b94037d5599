"""Remedy: dissipation of a Riemann problem between the two particles of a pair.

A case beside this file says ``use = ["riemann_dissipation.py"]``.
"""

from typing import Annotated, NamedTuple

from pydantic import Field

from psph.formula import where
from psph.physics.catalogue import Catalogue, Entry
from psph.physics.facts import Facts

STABLE = 0.075
"""cΔt/h must stay below.  The fastest mode of a lattice decays at Sc/h, S ≤ 4.3 over the kernels
(Wendland C2: 3.3); density, predicted with weights 7/4, −1, 1/4, is stable to a third a step."""


class RiemannDissipation(NamedTuple):
    """Each pair is a Riemann problem with limited dissipation: this damps noise.

    Beside the mean of both sides, p* = ½ β ρ̄ ΔU and U* = (p_i − p_j)/(2ρ̄c), ΔU = −u_ij·x_ij/r:
    a_i = −2 Σ_j m_j/(ρ_i ρ_j) p* ∇W_ij with the limiter β = min(η max(ΔU, 0), c), and
    dρ_i/dt = 2 ρ_i Σ_j m_j/ρ_j U* r W′/r.  Zhang, Hu & Adams (2017), J. Comput. Phys. 335, 605.
    Momentum and angular momentum are conserved.  Density takes the whole U*, as there, so that a
    still column spreads its pressure too; a wall meets the fluid as a fluid would, where theirs solve
    a problem of their own, and two wall particles exchange no density.
    """

    conserves = ("momentum", "angular momentum")

    eta: Annotated[float, Field(ge=0, description="η of the limiter", json_schema_extra={"unit": "1"})] = 3.0

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        closing = max(-pair.u_dot_x, 0.0) * pair.inverse_r
        limited = min(self.eta * closing, min(i.sound_speed, j.sound_speed))
        mean = 0.5 * (i.specific_volume + j.specific_volume)  # ρ̄/(ρ_i ρ_j)
        return -mean * limited * closing * pair.m_dw_r

    def density_rate(self, i, j, pair):
        """One neighbour's share of dρ_i/dt, kg/(m^d s)."""
        v_i, v_j = i.specific_volume, j.specific_volume
        jump = (i.pressure - j.pressure) / (min(i.sound_speed, j.sound_speed) * (v_i + v_j))
        met = where(i.is_fluid + j.is_fluid > 0.0, jump, 0.0)
        return 2.0 * v_j * v_j * met * pair.r * pair.m_dw_r

    def longest_step(self, scene):
        """Δt ≤ 0.075 h/c, s: see STABLE."""
        return STABLE * scene.smoothing_length / scene.sound_speed

    def linear(self, scene: Facts):
        """Its part in linear theory."""
        return Meeting()


class Meeting(NamedTuple):
    """dρ_a/dt = c Σ V (ρ_a − ρ_b) W′: what U* makes of the density (psph.theory.stability.parts).

    Their p* is limited, and of second order in small disturbances.
    """

    def meeting(self, uniform, r):
        """Of density between neighbours, one of them fluid."""
        return -uniform.sound_speed * uniform.volume * uniform.slope(r)


CATALOGUE = Catalogue(effects=(Entry("physics.riemann_dissipation", RiemannDissipation),))
