"""A drop that is stretched."""

from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from psph.theory.solutions.setting import Setting, Surroundings

TOLERANCE = 1e-11
"""Of the shape over time, relative."""


class EllipticDrop(NamedTuple):
    """A circular drop of radius R that is stretched along y into an ellipse, in free space.

    u = A (−x, y) with da/dt = −aA, dA/dt = A² (a⁴ − 1)/(a⁴ + 1); aR and R/a are the semi-axes.
    p = ρ/2 [(A² − A′)(a²R² − x²) − (A² + A′) y²].  Monaghan (1994), J. Comput. Phys. 110, 399.
    """

    rate: Annotated[
        float,
        Field(gt=0, description="rate A of stretching at the start", json_schema_extra={"unit": "1/s"}),
    ]
    radius: Annotated[
        float, Field(gt=0, description="radius R at the start", json_schema_extra={"unit": "m"})
    ]

    up_to_a_constant = ()

    def unfit(self, setting: Surroundings) -> str | None:
        """What is wrong with the case for this solution, or None."""
        if setting.dimensions != 2:
            return "is a flow in 2D; give space.dimensions = 2"
        if any(setting.gravity) or setting.viscosity:
            return "is a flow without gravity and friction; remove both"
        return None

    def top_speed(self, setting: Surroundings) -> float:
        """The largest speed, at the start, m/s."""
        return self.rate * self.radius

    def shape(self, t: float) -> tuple[float, float]:
        """a and A in 1/s at ``t`` s."""
        from scipy.integrate import solve_ivp  # late: it takes a while, and few cases need it

        def change(_, state):
            a, rate = state
            return -a * rate, rate * rate * (a**4 - 1.0) / (a**4 + 1.0)

        if not t:
            return 1.0, self.rate
        end = solve_ivp(change, (0.0, t), (1.0, self.rate), rtol=TOLERANCE, atol=0.0, method="DOP853")
        return tuple(end.y[:, -1])

    def velocity(self, x: np.ndarray, t: float, setting: Setting) -> np.ndarray:
        """u (n, dim) in m/s at ``x`` (n, dim) m and ``t`` s."""
        return self.shape(t)[1] * x * np.array([-1.0, 1.0])

    def pressure(self, x: np.ndarray, t: float, setting: Setting) -> np.ndarray:
        """p (n,) in Pa."""
        a, rate = self.shape(t)
        slope = rate * rate * (a**4 - 1.0) / (a**4 + 1.0)
        along, across = rate * rate - slope, rate * rate + slope
        inside = along * ((a * self.radius) ** 2 - x[:, 0] ** 2) - across * x[:, 1] ** 2
        return 0.5 * setting.density * inside
