"""Fluids as parts of a scene."""

from typing import Any

from psph.scene.parts.part import Known, Part


class FluidPart(Part):
    """A fluid."""

    flows = True

    @property
    def rheology(self) -> Any:
        """As its table says."""
        return self.table.rheology.law if self.table.rheology else None

    def shown(self, known: Known) -> dict[str, Any]:
        """Its density and viscosity, or the law of that."""
        return super().shown(known) | {
            "viscosity": self.table.viscosity,
            "rheology": 1 + known.rheologies.index(self.rheology) if self.rheology else 0,
        }
