"""Soils as parts of a scene."""

import math
from typing import Any

import numpy as np

from psph.scene.parts.hookean import NEVER, StressedPart
from psph.scene.parts.part import Known


class SoilPart(StressedPart):
    """A soil."""

    @property
    def largest_tension(self) -> float:
        """The largest mean tension that it bears, Pa."""
        return self.table.tip

    def strength(self, gravity: tuple[float, ...]):
        """The law that bounds its stress (psph.physics.stress.strength), under ``gravity`` in m/s²."""
        pull = math.hypot(*gravity)
        return self.table.law(tuple(-g / pull if pull else 0.0 for g in gravity), pull)

    def shown(self, known: Known) -> dict[str, Any]:
        """Beside waves how its stress spreads, and K₀."""
        return super().shown(known) | {
            "stress_diffusion": self.table.stress_diffusion,
            "rest_coefficient": self._rest_coefficient(known),
        }

    def own(self, known: Known) -> dict[str, Any]:
        """Its strength: the number of its law, and the mean tension at which shear strength is gone, Pa."""
        friction, cohesion, _ = self.table.pyramid
        return super().own(known) | {
            "strength": 1 + known.strengths.index(self.strength(known.gravity)),
            "cone_tip": cohesion / friction if friction else NEVER,
        }

    def _rest_coefficient(self, known: Known) -> float:
        """K₀ of the whole stress, that of the water in the pores with it."""
        soil, water = self.table, 0.0
        if soil.water_level is not None:
            axis, up = int(np.abs(known.gravity).argmax()), -np.array(known.gravity)
            up /= np.linalg.norm(up)
            ends = known.lowest[self.number], known.highest[self.number]
            low, high = np.sort([np.copysign(1.0, up[axis]) * end[axis] for end in ends])
            aside = np.delete(0.5 * (ends[0] + ends[1]) * up, axis).sum()  # of the level in mid-width
            level = (soil.water_level - aside) / abs(up[axis])
            wet = np.clip((level - low) / max(high - low, known.spacing), 0.0, 1.0)
            water = float(wet) * soil.water_density / soil.density
        return soil.at_rest + (1.0 - soil.at_rest) * water
