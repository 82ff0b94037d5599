"""A liquid thread under its surface tension."""

import cmath
import math
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from psph.theory.solutions.layers import swung
from psph.theory.solutions.setting import Setting, Surroundings, whole_waves


class LiquidThread(NamedTuple):
    """A small wave along a liquid thread in 3D: it grows where it is longer than the girth, else it swings.

    The thread lies along x through y = z = 0; its surface is a cylinder at the start and moves at V cos kx:
    η = V e^(−βt) cos kx sin(δt)/δ, β = 3νk²/2, δ² = −ω² − β², ω² = σ/(ρR³) kR (1 − k²R²) I₁(kR)/I₀(kR),
    u = ∇φ, φ ∝ I₀(kr) cos kx.  Rayleigh (1878), Proc. London Math. Soc. 10, 4; the friction is that of long
    waves, Weber (1931), Z. angew. Math. Mech. 11, 136.
    """

    speed: Annotated[
        float,
        Field(gt=0, description="speed V of the surface at the start", json_schema_extra={"unit": "m/s"}),
    ]
    length: Annotated[float, Field(gt=0, description="wavelength", json_schema_extra={"unit": "m"})]
    radius: Annotated[
        float, Field(gt=0, description="radius R of the thread", json_schema_extra={"unit": "m"})
    ]

    up_to_a_constant = ()

    def unfit(self, setting: Surroundings) -> str | None:
        """What is wrong with the case for this solution, or None."""
        if setting.dimensions != 3:
            return "is a flow in 3D; give space.dimensions = 3"
        if not setting.surface_tension:
            return "lives by surface tension; give surface_tension of the fluid"
        if any(setting.gravity):
            return "is a flow without gravity; remove it"
        return whole_waves(setting, (0,), self.length)

    def roots(self, setting: Surroundings) -> tuple[float, complex]:
        """β and δ, 1/s: where δ is imaginary the wave grows at |δ| − β."""
        from scipy.special import iv  # late: few cases need it

        k = 2.0 * math.pi / self.length
        kr, brake = k * self.radius, 1.5 * setting.viscosity * k * k
        growth = setting.surface_tension / (setting.density * self.radius**3)
        growth *= kr * (1.0 - kr * kr) * iv(1, kr) / iv(0, kr)
        return brake, cmath.sqrt(-growth - brake * brake)

    def top_speed(self, setting: Surroundings) -> float:
        """The largest speed at the start, m/s."""
        from scipy.special import iv

        kr = 2.0 * math.pi / self.length * self.radius
        return self.speed * max(1.0, iv(0, kr) / iv(1, kr))

    def displacement(self, t: float, setting: Surroundings) -> tuple[float, float]:
        """η in m and its rate in m/s at a crest and ``t`` s."""
        brake, delta = self.roots(setting)
        moved, rate = swung(delta, t)
        faded = self.speed * math.exp(-brake * t)
        return faded * moved.real, faded * (rate - brake * moved).real

    def velocity(self, x: np.ndarray, t: float, setting: Setting) -> np.ndarray:
        """u (n, dim) in m/s at ``x`` (n, dim) m and ``t`` s."""
        from scipy.special import iv

        k, r = 2.0 * math.pi / self.length, np.hypot(x[:, 1], x[:, 2])
        a = self.displacement(t, setting)[1] / iv(1, k * self.radius)
        outward = a * iv(1, k * r) * np.cos(k * x[:, 0]) / np.maximum(r, 1e-300)
        return np.column_stack(
            [-a * iv(0, k * r) * np.sin(k * x[:, 0]), outward * x[:, 1], outward * x[:, 2]]
        )
