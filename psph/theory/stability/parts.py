"""Terms that schemes add against instability, linear in small disturbances.

A remedy has those of these that it needs, each given the :class:`Uniform` that is disturbed:

- ``stress(uniform)``: a :class:`PressureTerm`, one more term of the symmetric pressure gradient,
- ``force(uniform, r)``: an attraction of pairs within the kernel's support, m/s² (sites,), so that
  a_a = −Σ_b f x_ab/r,
- ``damping(uniform, r)``: (along, any): a_a = −Σ_b (along r̂ r̂ᵀ + any) u_ab, 1/s (sites,) or 0,
- ``spreading(uniform, r)``: dρ_a/dt = −Σ_b spreading (ρ_a − ρ_b), 1/s (sites,), but for what a wall would
  give to the fluid,
- ``meeting(uniform, r)``: the same, but for what two wall particles would exchange,
- ``normalises``: gradients are divided by their first moment.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

SINGULARITY = 0.01
"""η² = 0.01 h² beside r², as in the viscosities of psph."""


class PressureTerm(NamedTuple):
    """The force −Σ_b m_b (s_a + s_b) w(r) ∇W: s = ``pressure``/ρ² at rest, ds/dρ = ``response``."""

    pressure: float
    response: float
    weight: Callable[[np.ndarray], np.ndarray] = np.ones_like


class NormalisedGradient(NamedTuple):
    """∇W/M₁ in momentum and continuity, M₁ = −1/d Σ V r W′ of the lattice at rest."""

    normalises = True


class LinearBackground(NamedTuple):
    """A constant p_b in the symmetric form, whatever the form of p itself; Pa.

    Morris, Fox & Zhu (1997), J. Comput. Phys. 136, 214.
    """

    pressure: float

    def stress(self, uniform):
        """p_b/ρ², which falls as ρ grows."""
        return PressureTerm(self.pressure, -2.0 * self.pressure / uniform.density**3)


class LinearArtificialStress(NamedTuple):
    """R (W/W(dx))⁴ beside p/ρ², R = −ε p/ρ² under tension and 0.01 p/ρ² under compression.

    Monaghan (2000), J. Comput. Phys. 159, 290, with its n = 4.
    """

    epsilon: float = 0.2

    def stress(self, uniform):
        """R as a part of the pressure."""
        part = -self.epsilon if uniform.pressure < 0.0 else 0.01
        [nearest] = uniform.weight(np.array([uniform.spacing]))
        return PressureTerm(
            part * uniform.pressure,
            part * uniform.response,
            lambda r: (uniform.weight(r) / nearest) ** 4,
        )


class PairForce(NamedTuple):
    """An attraction f(r) of pairs within the support, m/s² for r in m: say (2K/ρ²) m ψ′(r)."""

    attraction: Callable[[np.ndarray], np.ndarray]

    def force(self, uniform, r):
        """f(r)."""
        return self.attraction(r)


class LinearArtificialViscosity(NamedTuple):
    """Π = −α c h (u·x)/(r² + 0.01 h²)/ρ, for approach *and* recession.

    Monaghan (1992), Annu. Rev. Astron. Astrophys. 30, 543.  His switch, and psph's, lets it act on
    approaching pairs alone; that is not linear, however small a wave is, and about half of this.
    """

    alpha: float = 0.05

    def damping(self, uniform, r):
        """Along the pair."""
        return self.alpha * uniform.sound_speed * uniform.smoothing_length * _rub(uniform, r), 0.0


class LinearPairDamping(NamedTuple):
    """Π = −α c h (u·x)/r² ρ₀/ρ², for every pair: Antuono and others (2010)."""

    alpha: float = 0.02

    def damping(self, uniform, r):
        """Along the pair."""
        rest = uniform.density - uniform.pressure / uniform.sound_speed**2
        strength = self.alpha * uniform.sound_speed * uniform.smoothing_length * rest / uniform.density
        return -strength * uniform.volume * uniform.slope(r) / r, 0.0


class Viscosity(NamedTuple):
    """The fluid's own kinematic viscosity ν, m²/s, in the form of Morris, Fox & Zhu (1997).

    What psph adds to it, F_ij Gᵀx_ij (psph.physics.fluid.friction), is not in it: that damps waves of
    compression once more, and nothing at the shortest.
    """

    viscosity: float

    def damping(self, uniform, r):
        """In any direction."""
        return 0.0, 2.0 * self.viscosity * _rub(uniform, r)


class LinearDiffusion(NamedTuple):
    """dρ_a/dt = 2 δ h c Σ V (ρ_a − ρ_b) x·∇W/r²: Molteni & Colagrossi (2009)."""

    delta: float = 0.1

    def spreading(self, uniform, r):
        """Of density in the fluid, and to walls: from it, and from walls that bear a pressure."""
        strength = self.delta * uniform.smoothing_length * uniform.sound_speed
        return -2.0 * strength * uniform.volume * uniform.slope(r) / r


def _rub(uniform, r):
    """−V r W′/(r² + 0.01 h²), 1/m²."""
    singularity = SINGULARITY * uniform.smoothing_length**2
    return -uniform.volume * r * uniform.slope(r) / (r * r + singularity)


REMEDIES = {
    "normalised_gradient": NormalisedGradient,
    "background_pressure": LinearBackground,
    "artificial_stress": LinearArtificialStress,
    "artificial_viscosity": LinearArtificialViscosity,
    "pair_damping": LinearPairDamping,
    "viscosity": Viscosity,
    "density_diffusion": LinearDiffusion,
}
"""Those with a single parameter at most, by the name that the command line gives them."""
