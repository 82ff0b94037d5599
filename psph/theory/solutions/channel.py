"""Flow between two plates, from its start on."""

import math
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from psph.theory.solutions.setting import Setting, Surroundings

TERMS = 200
"""Of the series; the last is below 1e-7 of the first from νt/L² = 2e-5 on."""

Low = Annotated[float, Field(description="y of the lower plate", json_schema_extra={"unit": "m"})]
High = Annotated[float, Field(description="y of the upper plate", json_schema_extra={"unit": "m"})]


def _unfit(solution, setting: Surroundings) -> str | None:
    if setting.dimensions == 1:
        return "is a flow in 2D or 3D; give space.dimensions = 2"
    if not solution.lower < solution.upper:
        return f"has plates at {solution.lower:g} and {solution.upper:g} m; let lower be below upper"
    if not setting.viscosity:
        return "is driven by friction; give the fluid a viscosity"
    if setting.periods[0] is None:
        return 'is periodic along x; add "x" to space.periodic'
    return None


def _along_x(speed: np.ndarray, setting: Setting) -> np.ndarray:
    u = np.zeros((len(speed), setting.dimensions))
    u[:, 0] = speed
    return u


class Poiseuille(NamedTuple):
    """Flow along x between plates at rest, driven by gravity along x.

    u = F/(2ν) y(L − y) − Σₙ 4FL²/(νπ³m³) sin(πmy/L) e^(−m²π²νt/L²), m = 2n + 1, F = gₓ, y from the
    lower plate on.  Morris, Fox & Zhu (1997), J. Comput. Phys. 136, 214, eq. (26).
    """

    lower: Low
    upper: High

    up_to_a_constant = ()

    def unfit(self, setting: Surroundings) -> str | None:
        """What is wrong with the case for this solution, or None."""
        if not setting.gravity[0] or any(setting.gravity[1:]):
            return "is driven along x; give physics.gravity = [g, 0]"
        return _unfit(self, setting)

    def top_speed(self, setting: Surroundings) -> float:
        """The largest speed, at the end, m/s."""
        return abs(setting.gravity[0]) * (self.upper - self.lower) ** 2 / (8.0 * setting.viscosity)

    def velocity(self, x: np.ndarray, t: float, setting: Setting) -> np.ndarray:
        """u (n, dim) in m/s at ``x`` (n, dim) m and ``t`` s."""
        gap, nu, force = self.upper - self.lower, setting.viscosity, setting.gravity[0]
        y = (x[:, 1] - self.lower) / gap
        m = 2.0 * np.arange(TERMS) + 1.0
        decay = 8.0 / (math.pi * m) ** 3 * np.exp(-((math.pi * m) ** 2) * nu * t / gap**2)
        start = _series(y, m, decay)
        return _along_x(force * gap**2 / (2.0 * nu) * (y * (1.0 - y) - start), setting)


class Couette(NamedTuple):
    """Flow along x between a lower plate at rest and an upper one that moves at full speed from the start.

    u = U y/L + Σₙ 2U/(nπ) (−1)ⁿ sin(nπy/L) e^(−n²π²νt/L²).  Morris, Fox & Zhu (1997), J. Comput.
    Phys. 136, 214, eq. (24).
    """

    lower: Low
    upper: High
    speed: Annotated[
        float, Field(description="speed U of the upper plate", json_schema_extra={"unit": "m/s"})
    ]

    up_to_a_constant = ()

    def unfit(self, setting: Surroundings) -> str | None:
        """What is wrong with the case for this solution, or None."""
        if any(setting.gravity):
            return "is driven by a plate; remove physics.gravity"
        return _unfit(self, setting)

    def top_speed(self, setting: Surroundings) -> float:
        """The largest speed, m/s."""
        return abs(self.speed)

    def velocity(self, x: np.ndarray, t: float, setting: Setting) -> np.ndarray:
        """u (n, dim) in m/s at ``x`` (n, dim) m and ``t`` s."""
        gap = self.upper - self.lower
        y = (x[:, 1] - self.lower) / gap
        n = np.arange(1.0, TERMS + 1.0)
        sign = np.where(n % 2, -1.0, 1.0)
        decay = np.exp(-((math.pi * n) ** 2) * setting.viscosity * t / gap**2)
        start = _series(y, n, 2.0 * sign / (math.pi * n) * decay)
        return _along_x(self.speed * (y + start), setting)


def _series(y: np.ndarray, waves: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Σ_n w_n sin(nπy), (n,): term by term, since a product of matrices is rounded by its number of rows."""
    found = np.zeros(len(y))
    for n, w in zip(waves.tolist(), weights.tolist()):
        found += w * np.sin(math.pi * n * y)
    return found
