"""Matter with moduli as parts of a scene: what soils and elastic solids have in common."""

import math
from typing import Any

from psph.case import Case
from psph.physics.stress.bulk import Hooke
from psph.scene.parts.part import Known, Part

NEVER = 1e30
"""Stands for a tension that leaves no strength where the strength is that of no pressure, Pa."""


class HookeanPart(Part):
    """Matter that obeys Hooke's law where it does not yield."""

    @property
    def largest_tension(self) -> float:
        """The largest mean tension that it bears, Pa."""
        return math.inf

    def law(self, case: Case):
        """Its pressure is linear in its density, by its bulk modulus."""
        return Hooke(self.table.bulk_modulus, self.largest_tension)

    @property
    def law_key(self) -> str:
        """By its moduli."""
        return f"{self.key}.young"

    def shown(self, known: Known) -> dict[str, Any]:
        """Its density and the speed of its pressure waves."""
        return super().shown(known) | {"wave_speed": self.table.wave_speed}

    def own(self, known: Known) -> dict[str, Any]:
        """Its shear modulus."""
        return super().own(known) | {"shear_modulus": self.table.shear_modulus}


class StressedPart(HookeanPart):
    """Such matter whose neighbours are those of the present, and whose deviatoric stress evolves."""

    flows = True
    bears_stress = True

    @property
    def wave_speed(self) -> float:
        """By its moduli."""
        return self.table.wave_speed

    def own(self, known: Known) -> dict[str, Any]:
        """Its strength does not depend on pressure."""
        return super().own(known) | {"cone_tip": NEVER}
