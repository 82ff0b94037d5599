"""Laws by which a viscosity depends on the rate of strain: mud, paste, polymer, grains.

Each gives the apparent viscosity η in Pa s of a rate γ̇ = √(2D:D) in 1/s, and of the pressure; ``largest`` is
the highest that it gives, which the time step has to stand.
"""

import math
from typing import NamedTuple

import numpy as np

from psph.engine.jit import call_by_number
from psph.physics.facts import Facts

STILL = 1e-30
"""1/s: smaller rates count as this one, so that no law divides by zero and none needs a branch."""

apparent_viscosity = call_by_number("viscosity")
"""(laws, number, rate, pressure, own) → η, Pa s; ``own`` is ρν of a fluid without such a law."""


def power(base: float, exponent: float) -> float:
    """base^exponent of a base that is not negative; infinite where it is too large for a number."""
    try:
        return base**exponent
    except (OverflowError, ZeroDivisionError):
        return math.inf


def thickest(scene: Facts) -> float:
    """The largest kinematic viscosity that a fluid may have, m²/s; 0 without fluids."""
    fluids = (one for one in scene.species if one.is_fluid)
    return max(
        (
            scene.rheologies[one.rheology - 1].largest / one.density if one.rheology else one.viscosity
            for one in fluids
        ),
        default=0.0,
    )


class Newtonian(NamedTuple):
    """The viscosity of a fluid without such a law, beside others that have one."""

    def viscosity(self, rate, pressure, own):
        """η = ρν, Pa s."""
        return own


class HerschelBulkley(NamedTuple):
    """A paste that flows above its yield stress, by a power of the rate.

    η = Kγ̇^(n−1) + τ_y (1 − e^(−mγ̇))/γ̇, no more than ``largest``.  Herschel & Bulkley (1926), Kolloid-Z. 39,
    291; below the yield a creep in the place of rest, Papanastasiou (1987), J. Rheol. 31, 385.  With n = 1 it
    is Bingham's, with τ_y = 0 a power law.  ``yield_stress`` τ_y in Pa, ``consistency`` K in Pa sⁿ,
    ``exponent`` n, ``regularisation`` m in s, ``largest`` in Pa s.
    """

    yield_stress: float
    consistency: float
    exponent: float
    regularisation: float
    largest: float

    def viscosity(self, rate, pressure, own):
        """η, Pa s."""
        rate = max(rate, STILL)
        flowing = self.consistency * rate ** (self.exponent - 1.0)
        yielding = self.yield_stress * (-np.expm1(-self.regularisation * rate) / rate)
        return min(flowing + yielding, self.largest)

    def rate_under(self, stress: float) -> float:
        """The rate at which it flows under a shear stress in Pa, 1/s, without cap and creep; 0 below its
        yield."""
        return power(max(stress - self.yield_stress, 0.0) / self.consistency, 1.0 / self.exponent)

    def creep_under(self, stress: float, limit: float) -> float:
        """The rate at which it creeps under a stress below its ``limit`` τ_y, Pa: −ln(1 − τ/τ_y)/m, 1/s."""
        return -math.log1p(-stress / limit) / self.regularisation

    def speed_between(self, pull: float, half: float) -> float:
        """The speed in the middle between plates 2 ``half`` m apart under ``pull`` Pa/m along them, m/s: with
        the rate γ̇ at the plates, γ̇ (half − τ_y/pull) n/(n + 1), and 0 without a flow."""
        flowing = max(half - self.yield_stress / pull, 0.0)
        return self.rate_under(pull * half) * flowing * self.exponent / (self.exponent + 1.0)


class Cross(NamedTuple):
    """A viscosity that passes from one value at rest to another in fast shear.

    η = η_∞ + (η₀ − η_∞)/(1 + (λγ̇)ⁿ).  Cross (1965), J. Colloid Sci. 20, 417.  ``at_rest`` η₀ and ``in_shear``
    η_∞ in Pa s, ``time`` λ in s, ``exponent`` n.
    """

    at_rest: float
    in_shear: float
    time: float
    exponent: float

    @property
    def largest(self) -> float:
        """The larger of the two, Pa s."""
        return max(self.at_rest, self.in_shear)

    def viscosity(self, rate, pressure, own):
        """η, Pa s."""
        return self.in_shear + (self.at_rest - self.in_shear) / (1.0 + (self.time * rate) ** self.exponent)


class Granular(NamedTuple):
    """Dry grains: friction that grows with the inertial number, times the pressure.

    η = [μ_s + (μ₂ − μ_s)/(1 + I₀/I)] p/√(γ̇² + γ₀²), no more than ``largest``; I = γ̇d/√(p/ρ_s), p ≥ 0.  Jop,
    Forterre & Pouliquen (2006), Nature 441, 727.  ``friction`` μ_s, ``fast_friction`` μ₂, ``inertial_number``
    I₀, ``diameter`` d in m and ``grain_density`` ρ_s in kg/m³ of a grain, ``least_rate`` γ₀ in 1/s,
    ``largest`` in Pa s.
    """

    friction: float
    fast_friction: float
    inertial_number: float
    diameter: float
    grain_density: float
    least_rate: float
    largest: float

    def speed_on_slope(self, slope: float, weight: float, depth: float) -> float:
        """The speed on top of a layer ``depth`` m thick on a ``slope`` tan θ, m/s; ``weight`` ρg cos θ in
        Pa/m across it.  u = (2I/3d)√(weight/ρ_s) depth^(3/2), Bagnold's profile; without end from μ₂ on."""
        if slope >= self.fast_friction:
            return math.inf
        inertial = self.inertial_on(slope)
        return 2.0 / 3.0 * inertial / self.diameter * math.sqrt(weight / self.grain_density) * depth**1.5

    def inertial_on(self, slope: float) -> float:
        """I under a shear stress of ``slope`` times the pressure, below μ₂; 0 up to μ_s."""
        return self.inertial_number * max(slope - self.friction, 0.0) / (self.fast_friction - slope)

    def rate_under(self, stress: float, pressure: float) -> float:
        """The rate at which it flows under a shear stress and a pressure in Pa, I√(p/ρ_s)/d in 1/s, without
        cap and creep; 0 up to a friction of μ_s, without end from μ₂ on."""
        slope = stress / pressure
        if slope >= self.fast_friction:
            return math.inf
        return self.inertial_on(slope) / self.diameter * math.sqrt(pressure / self.grain_density)

    def creep_under(self, stress: float, limit: float) -> float:
        """The rate at which γ₀ lets it creep under a stress below its ``limit`` μ_s p, Pa, 1/s."""
        part = stress / limit
        return self.least_rate * part / math.sqrt(1.0 - part * part)

    def viscosity(self, rate, pressure, own):
        """η, Pa s."""
        pressure = max(pressure, 0.0)
        # 1/(1 + I₀/I) with I = fast/slow; no more than rounding where both are zero.
        fast = rate * self.diameter + STILL
        slow = np.sqrt(pressure / self.grain_density)
        more = (self.fast_friction - self.friction) * (fast / (fast + self.inertial_number * slow))
        stress = (self.friction + more) * pressure
        return min(stress / np.sqrt(rate * rate + self.least_rate * self.least_rate), self.largest)
