"""Small waves: sound, and gravity waves on a free surface."""

import math
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from psph.theory.solutions.setting import Setting, Surroundings, whole_waves
from psph.theory.water_waves import frequency


class SoundWave(NamedTuple):
    """A plane sound wave that runs along x.

    u = U sin k(x − ct), p = ρcu: acoustics, to first order in U/c.  Lamb, Hydrodynamics (1932),
    §277.
    """

    speed: Annotated[float, Field(gt=0, description="amplitude U", json_schema_extra={"unit": "m/s"})]
    length: Annotated[float, Field(gt=0, description="wavelength", json_schema_extra={"unit": "m"})]

    up_to_a_constant = ()

    def unfit(self, setting: Surroundings) -> str | None:
        """What is wrong with the case for this solution, or None."""
        return whole_waves(setting, (0,), self.length)

    def top_speed(self, setting: Surroundings) -> float:
        """The largest speed, m/s."""
        return self.speed

    def velocity(self, x: np.ndarray, t: float, setting: Setting) -> np.ndarray:
        """u (n, dim) in m/s at ``x`` (n, dim) m and ``t`` s."""
        k = 2.0 * math.pi / self.length
        u = np.zeros_like(x)
        u[:, 0] = self.speed * np.sin(k * (x[:, 0] - setting.sound_speed * t))
        return u

    def pressure(self, x: np.ndarray, t: float, setting: Setting) -> np.ndarray:
        """p (n,) in Pa."""
        return setting.density * setting.sound_speed * self.velocity(x, t, setting)[:, 0]


class StandingWave(NamedTuple):
    """Water that sloshes between walls, or in a periodic domain, with a small amplitude.

    η = A cos kx sin ωt, ω² = gk tanh kH, from a flat surface in motion;
    u = Aω e^(−2νk²t) cos ωt/sinh kH (−cosh k(y + H) sin kx, sinh k(y + H) cos kx), y up from the
    surface.  Lamb, Hydrodynamics (1932), §228 and, for the friction, §348.  x counts from the
    crest on.
    """

    amplitude: Annotated[float, Field(gt=0, description="amplitude A", json_schema_extra={"unit": "m"})]
    length: Annotated[float, Field(gt=0, description="wavelength", json_schema_extra={"unit": "m"})]
    depth: Annotated[float, Field(gt=0, description="depth H of the water", json_schema_extra={"unit": "m"})]
    surface: Annotated[float, Field(description="y of the flat surface", json_schema_extra={"unit": "m"})] = (
        0.0
    )

    up_to_a_constant = ()

    def unfit(self, setting: Surroundings) -> str | None:
        """What is wrong with the case for this solution, or None."""
        if setting.dimensions != 2:
            return "is a flow in 2D; give space.dimensions = 2"
        if setting.gravity[0] or not setting.gravity[1] < 0.0:
            return "needs gravity along −y; give physics.gravity = [0.0, -9.81]"
        return None

    def frequency(self, setting: Surroundings) -> float:
        """ω, 1/s."""
        k = 2.0 * math.pi / self.length
        return frequency(k, self.depth, -setting.gravity[1])

    def top_speed(self, setting: Surroundings) -> float:
        """The largest speed, m/s."""
        k = 2.0 * math.pi / self.length
        return self.amplitude * self.frequency(setting) / math.tanh(k * self.depth)

    def velocity(self, x: np.ndarray, t: float, setting: Setting) -> np.ndarray:
        """u (n, dim) in m/s at ``x`` (n, dim) m and ``t`` s."""
        k, omega = 2.0 * math.pi / self.length, self.frequency(setting)
        a = self.amplitude * omega * math.cos(omega * t) / math.sinh(k * self.depth)
        a *= math.exp(-2.0 * setting.viscosity * k * k * t)
        kx, ky = k * x[:, 0], k * (x[:, 1] - self.surface + self.depth)
        return a * np.column_stack([-np.cosh(ky) * np.sin(kx), np.sinh(ky) * np.cos(kx)])
