"""Fluids as parts of a scene."""

from typing import Any

from psph.case import Case
from psph.scene.parts.part import Known, Part


class FluidPart(Part):
    """A fluid."""

    flows = True

    def shown(self, known: Known) -> dict[str, Any]:
        """Its density and viscosity, or the law of that."""
        rheology = self.table.rheology
        return super().shown(known) | {
            "viscosity": self.table.viscosity,
            "rheology": 1 + known.rheologies.index(rheology.law) if rheology else 0,
        }


def rheologies_of(case: Case) -> tuple[Any, ...]:
    """The different laws of viscosities that depend on the rate of strain (psph.physics.fluid.rheology)."""
    return tuple(dict.fromkeys(fluid.rheology.law for fluid in case.fluids.values() if fluid.rheology))
