"""Water at rest."""

import math
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from psph.rows import projected
from psph.theory.solutions.setting import Setting, Surroundings


class Hydrostatic(NamedTuple):
    """Still water under gravity: pressure grows with depth.

    p = ρ₀ g·(x − x_s), x_s the surface, p = 0 above it; u = 0.  Archimedes; Lamb, Hydrodynamics
    (1932), §1.
    """

    surface: Annotated[
        float,
        Field(description="height of the surface against gravity", json_schema_extra={"unit": "m"}),
    ]

    up_to_a_constant = ()

    def unfit(self, setting: Surroundings) -> str | None:
        """What is wrong with the case for this solution, or None."""
        if not any(setting.gravity):
            return "is the pressure under gravity; give physics.gravity"
        return None

    def top_speed(self, setting: Surroundings) -> float:
        """Nothing moves, m/s."""
        return 0.0

    def pressure(self, x: np.ndarray, t: float, setting: Setting) -> np.ndarray:
        """p (n,) in Pa at ``x`` (n, dim) m; the same at all times."""
        pull = math.hypot(*setting.gravity)
        depth = self.surface + projected(x, setting.gravity) / pull
        return setting.density * pull * np.maximum(depth, 0.0)
