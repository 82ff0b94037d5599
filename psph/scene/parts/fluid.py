"""Fluids as parts of a scene."""

from dataclasses import dataclass
from typing import Any

from psph.case.matter import RELAXED
from psph.scene.parts.part import Known, Part


@dataclass(frozen=True)
class FluidPart(Part):
    """A fluid; ``tensions`` in N/m are its surface tension and those between it and each fluid, in their
    order."""

    tensions: tuple[float, ...] = ()

    flows = True

    @property
    def relaxes(self) -> bool:
        """As its table says."""
        return self.table.start == RELAXED

    @property
    def rheology(self) -> Any:
        """As its table says."""
        return self.table.rheology.law if self.table.rheology else None

    @property
    def own_sound_speed(self) -> float | None:
        """As its table says."""
        return self.table.sound_speed

    def shown(self, known: Known) -> dict[str, Any]:
        """Its density and viscosity, or the law of that."""
        return super().shown(known) | {
            "viscosity": self.table.viscosity,
            "rheology": 1 + known.rheologies.index(self.rheology) if self.rheology else 0,
        }

    def own(self, known: Known) -> dict[str, Any]:
        """Its number among fluids, which come first, and its tensions."""
        return {"fluid": 1 + self.number, "tensions": self.tensions}
