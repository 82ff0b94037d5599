"""A small wave between two layers: it swings, grows under gravity, or feeds on their shear."""

import cmath
import math
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from psph.theory.solutions.setting import Setting, Surroundings

LEAST = 1e-12
"""Of |δ| t: below it sin(δt)/δ is t."""


def swung(delta: complex, t: float) -> tuple[complex, complex]:
    """sin(δt)/δ in s and its rate, cos δt, at ``t`` s: t where δ is 0."""
    return (cmath.sin(delta * t) / delta if abs(delta) * t > LEAST else t), cmath.cos(delta * t)


class InterfacialWave(NamedTuple):
    """A small wave between two layers without friction: it swings, or grows under gravity or by their shear.

    The first fluid of the case lies below, the second above; they flow at U₁ and U₂ along x.  The interface
    is flat at the start and moves at V cos kx: η = V Re e^(ik(x − ct)) sin(δt)/δ, where ω = kc ± δ are the
    roots of ρ₁ (ω − kU₁)² coth kh₁ + ρ₂ (ω − kU₂)² coth kh₂ = gk (ρ₁ − ρ₂).  Lamb, Hydrodynamics (1932),
    §§231, 232.  Where δ is imaginary η grows: Rayleigh–Taylor, Kelvin–Helmholtz.  x counts from a crest on.
    """

    speed: Annotated[
        float,
        Field(gt=0, description="speed V of the interface at the start", json_schema_extra={"unit": "m/s"}),
    ]
    length: Annotated[float, Field(gt=0, description="wavelength", json_schema_extra={"unit": "m"})]
    depths: Annotated[
        tuple[Annotated[float, Field(gt=0)], Annotated[float, Field(gt=0)]],
        Field(description="of the layers below and above", json_schema_extra={"unit": "m"}),
    ]
    flows: Annotated[
        tuple[float, float],
        Field(description="speeds U along x of the layers", json_schema_extra={"unit": "m/s"}),
    ] = (0.0, 0.0)
    surface: Annotated[
        float, Field(description="y of the flat interface", json_schema_extra={"unit": "m"})
    ] = 0.0

    up_to_a_constant = ()

    def unfit(self, setting: Surroundings) -> str | None:
        """What is wrong with the case for this solution, or None."""
        if setting.dimensions != 2:
            return "is a flow in 2D; give space.dimensions = 2"
        if len(setting.densities) != 2:
            return "is of two fluids, and no more; give the lower one, then the upper"
        if setting.viscosity:
            return "is a flow without friction; remove the fluid's viscosity"
        if setting.gravity[0]:
            return "needs gravity along y, or none; give physics.gravity = [0.0, -9.81]"
        return None

    def roots(self, setting: Surroundings) -> tuple[complex, complex]:
        """kc and δ, 1/s: the wave swings at δ in a frame that moves at c."""
        k = 2.0 * math.pi / self.length
        one, other = (rho / math.tanh(k * h) for rho, h in zip(setting.densities, self.depths))
        below, above = (k * flow for flow in self.flows)
        whole, mean = one + other, (one * below + other * above) / (one + other)
        weight = -setting.gravity[1] * k * (setting.densities[0] - setting.densities[1])
        return mean, cmath.sqrt((weight - one * other * (below - above) ** 2 / whole) / whole)

    def top_speed(self, setting: Surroundings) -> float:
        """The largest speed at the start, m/s."""
        k = 2.0 * math.pi / self.length
        return max(abs(flow) + self.speed / math.tanh(k * h) for flow, h in zip(self.flows, self.depths))

    def displacement(self, t: float, setting: Surroundings) -> tuple[complex, complex]:
        """η in m and its rate in m/s at x = 0 and ``t`` s, as complex amplitudes of e^(ikx)."""
        mean, delta = self.roots(setting)
        moved, rate = swung(delta, t)
        turned = self.speed * cmath.exp(-1j * mean * t)
        return turned * moved, turned * (rate - 1j * mean * moved)

    def velocity(self, x: np.ndarray, t: float, setting: Setting) -> np.ndarray:
        """u (n, dim) in m/s at ``x`` (n, dim) m and ``t`` s: of the fluid that is there by η."""
        k = 2.0 * math.pi / self.length
        wave, y = np.exp(1j * k * x[:, 0]), x[:, 1] - self.surface
        height, rate = self.displacement(t, setting)
        sides = []
        for way, flow, depth in zip((1.0, -1.0), self.flows, self.depths):
            w = (rate + 1j * k * flow * height) * wave / math.sinh(k * depth)
            off = k * np.maximum(depth + way * y, 0.0)
            sides.append((flow + way * (1j * w).real * np.cosh(off), w.real * np.sinh(off)))
        return np.where(y < (height * wave).real, *map(np.array, sides)).T
