"""Ideal gases as parts of a scene."""

from psph.case import Case
from psph.particles.reach import Reach
from psph.physics.gas.state import OfHeat
from psph.scene.parts.part import Part


class GasPart(Part):
    """An ideal gas, whose particles have sizes of their own; its table has a pressure."""

    @property
    def moves_freely(self) -> bool:
        """Yes."""
        return True

    @property
    def wave_speed(self) -> float:
        """Of sound at the start."""
        return self.table.sound_speed

    @property
    def own_sound_speed(self) -> float:
        """The same."""
        return self.table.sound_speed

    @property
    def law_key(self) -> str:
        """By its adiabatic index."""
        return f"{self.key}.gamma"

    def law(self, case: Case) -> OfHeat:
        """Its pressure comes from its heat."""
        return OfHeat(self.table.gamma)

    def reach(self, whole: Reach, spacing: float, contact: bool) -> Reach:
        """That of the scene's spacing, at the start."""
        return whole
