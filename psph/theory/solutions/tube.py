"""Shocks of ideal gases."""

from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from psph.theory.riemann import GasState, Riemann, riemann
from psph.theory.solutions.setting import Setting, Surroundings

LATE = 1e-300
"""Before this time, s, everything is as it began."""


def of_side(what: str, unit: str, **bounds):
    """The type of a number of the gas on one side."""
    return Annotated[float, Field(description=what, json_schema_extra={"unit": unit}, **bounds)]


class ShockTube(NamedTuple):
    """Two states of an ideal gas that meet across x at the start, and the waves that leave from there.

    A fan or a shock on either side, and a contact (psph.theory.riemann).  Toro (2009), Riemann Solvers and
    Numerical Methods for Fluid Dynamics, ch. 4.  Until a wave comes to an end of the domain.
    """

    left_density: of_side("density of the gas below at", "kg/m^d", gt=0)
    left_pressure: of_side("its pressure", "Pa", gt=0)
    right_density: of_side("density of the gas above at", "kg/m^d", gt=0)
    right_pressure: of_side("its pressure", "Pa", gt=0)
    left_velocity: of_side("velocity of the gas below at along x", "m/s") = 0.0
    right_velocity: of_side("that of the gas above", "m/s") = 0.0
    at: of_side("where they meet", "m") = 0.0
    gamma: of_side("adiabatic index γ", "1", gt=1, le=10) = 1.4

    compressible = True
    up_to_a_constant = ()

    @property
    def waves(self) -> Riemann:
        """What leaves from where they meet.  Raises ValueError where that leaves a vacuum."""
        left = GasState(self.left_density, self.left_pressure, self.left_velocity)
        right = GasState(self.right_density, self.right_pressure, self.right_velocity)
        return riemann(left, right, self.gamma)

    def unfit(self, setting: Surroundings) -> str | None:
        """What is wrong with the numbers, or None."""
        if not setting.lower[0] < self.at < setting.upper[0]:
            return f"at = {self.at:g} m is outside the domain; give a place in it"
        try:
            self.top_speed(setting)
        except ValueError as error:
            return str(error)
        return None

    def top_speed(self, setting: Surroundings) -> float:
        """The largest speed, m/s."""
        return max(map(abs, (self.left_velocity, self.right_velocity, self.waves.velocity)))

    def velocity(self, x: np.ndarray, t: float, setting: Setting) -> np.ndarray:
        """u (n, dim) in m/s at ``x`` (n, dim) m and ``t`` s."""
        u = np.zeros_like(x)
        u[:, 0] = self._at(x, t)[2]
        return u

    def pressure(self, x: np.ndarray, t: float, setting: Setting) -> np.ndarray:
        """p (n,) in Pa."""
        return self._at(x, t)[1]

    def density(self, x: np.ndarray, t: float, setting: Setting) -> np.ndarray:
        """ρ (n,) in kg/m^d."""
        return self._at(x, t)[0]

    def _at(self, x: np.ndarray, t: float) -> tuple[np.ndarray, ...]:
        return self.waves.at((x[:, 0] - self.at) / max(t, LATE))
