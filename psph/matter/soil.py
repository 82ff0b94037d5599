"""Soils: what they add to a scene (psph.kinds).  Their stress is that of effects (psph.physics.stress)."""

from collections.abc import Iterator

from psph.kinds import Kind
from psph.scene.soils import soil_lines


class Soils(Kind):
    """Soils, which share the pair loop with what flows."""

    name = "soils"

    def matter_lines(self) -> Iterator[str]:
        """Strength and waves of each."""
        yield from soil_lines(self.scene)
