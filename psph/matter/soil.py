"""Soils: what they add to a scene (psph.kinds).  Their stress is that of effects (psph.physics.stress)."""

from collections.abc import Container, Iterator, Mapping

import numpy as np

from psph.kinds import Kind
from psph.physics.stress.deviator import DEVIATOR
from psph.scene.soils import soil_faults, soil_lines, soil_warnings
from psph.scene.stressed import Layer, deviator_of, layers_of, started


class Soils(Kind):
    """Soils, which share the pair loop with what flows."""

    name = "soils"

    @classmethod
    def layers(cls, census) -> Mapping[int, Layer]:
        """Ground under its own weight (psph.scene.stressed)."""
        return layers_of(census)

    def faults(self) -> Iterator[str]:
        """Soils that start pressed together beyond any law."""
        yield from soil_faults(self.scene)

    def warnings(self) -> Iterator[str]:
        """Numbers of theirs that are likely a slip."""
        yield from soil_warnings(self.scene)

    def starts(
        self, fields: Container[str], species: np.ndarray, position: np.ndarray
    ) -> Iterator[tuple[str, np.ndarray]]:
        """The stress of their weight."""
        if DEVIATOR.name in fields:
            deviator = deviator_of(started(self.scene.starts.layers), species, position)
            yield DEVIATOR.name, deviator
            yield f"predicted_{DEVIATOR.name}", deviator

    def lines(self, plan, dt: float) -> Iterator[tuple[str, str]]:
        """Strength and waves of each."""
        yield from (("matter", line) for line in soil_lines(self.scene))
