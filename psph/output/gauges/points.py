"""Fields at a point and over a sensor, and how far the fluid reaches: the probes as gauges."""

import math
from typing import NamedTuple

import numpy as np

from psph.output.gauges.carried import Carrier
from psph.output.probes import FieldProbe, Front


class PointGauge(NamedTuple):
    """What a ``probe`` (psph.output.probes) measures, ``every`` so many s."""

    probe: FieldProbe | Front
    every: float

    def columns(self, scene) -> list[str]:
        """Their names, without the time."""
        return self.probe.columns(scene.dimensions)

    def row(self, simulation) -> np.ndarray:
        """The values, the same on every rank."""
        return self.probe.sample(simulation)


class CarriedPoints(NamedTuple):
    """The same of a probe that a ``carrier`` takes along; ``start`` (n, dim), m, are its points at first."""

    probe: FieldProbe
    every: float
    carrier: Carrier
    start: np.ndarray

    def columns(self, scene) -> list[str]:
        """Their names, without the time."""
        return self.probe.columns(scene.dimensions)

    def row(self, simulation) -> np.ndarray:
        """The values, the same on every rank."""
        self.probe.points = self.carrier.places(simulation, self.start)
        return self.probe.sample(simulation)


def disc(center, axis: int, diameter: float, spacing: float) -> np.ndarray:
    """Points (n, dim) of a disc around ``center`` across ``axis``, at most a ``spacing`` apart: middles of
    equal squares (in 2D of equal lengths) that lie in the disc."""
    count = max(1, math.ceil(diameter / spacing - 1e-9))
    along = diameter * ((np.arange(count) + 0.5) / count - 0.5)
    others = [d for d in range(len(center)) if d != axis]
    grid = np.meshgrid(*[along] * len(others), indexing="ij")
    offsets = np.zeros((count ** len(others), len(center)))
    offsets[:, others] = np.column_stack([x.ravel() for x in grid]) if others else offsets[:, others]
    near = (offsets**2).sum(axis=1) <= (0.5 * diameter) ** 2
    return np.array(center) + offsets[near]
