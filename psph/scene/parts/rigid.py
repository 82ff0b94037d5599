"""Walls and rigid bodies as parts of a scene: what flows and what is elastic runs into them."""

from typing import Any

from psph.case.angles import cosines
from psph.scene.parts.part import Known, Part


class RigidPart(Part):
    """What keeps its form."""

    jitter = 0.0
    keeps_form = True
    rigid = True

    @property
    def fitted(self) -> bool:
        """As its table says."""
        return self.table.fitted

    def own(self, known: Known) -> dict[str, Any]:
        """What it sets to the fluid before it; beside elastic solids the largest of their moduli."""
        wetting, wetting_range = cosines(self.table.contact_angle)
        return super().own(known) | {
            "no_slip": self.table.no_slip,
            "condition": self.table.condition,
            "wave_modulus": max(known.wave_moduli, default=0.0),
            "wetting": wetting,
            "wetting_range": wetting_range,
        }


class WallPart(RigidPart):
    """A wall with particles."""

    is_wall = True
    looks = "wall"

    @property
    def displaces(self) -> bool:
        """Whether it takes the place of what flows where both are."""
        return self.table.displaces


class BodyPart(RigidPart):
    """A rigid body."""

    looks = "rigid body"
    displaces = True
