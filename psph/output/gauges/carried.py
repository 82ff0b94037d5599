"""Points of gauges that go with what they are fixed to."""

from typing import NamedTuple

import numpy as np


class Carrier(NamedTuple):
    """The wall or body of a ``group``, which carries points along as it moves and turns."""

    group: int

    def places(self, simulation, points: np.ndarray) -> np.ndarray:
        """Where ``points`` (n, dim) have come that were there at the start, m, the same on every rank.

        Each is at X + R (x₀ − c) by the pose of what carries it (psph.physics.rigid.pose).
        """
        return simulation.engine.poses.carried(simulation.plan.materials.pose_of[self.group], points)

    def taken_back(self, simulation, places: np.ndarray) -> np.ndarray:
        """Where ``places`` (n, dim) were at the start if they went along, m: those of the nearest images."""
        poses, row = simulation.engine.poses, simulation.plan.materials.pose_of[self.group]
        return poses.taken_back(row, poses.beside(row, places, simulation.domain.periods))
