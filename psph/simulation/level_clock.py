"""Where each level of sizes is in a step of its own: a coarse one takes several of those of the finest."""

from collections.abc import Sequence

import numpy as np

from psph.simulation.own_steps import OwnSteps
from psph.simulation.passes import Pass


class LevelClock:
    """Says which levels end a step of theirs with the step of the simulation that goes on, the finest's.

    Levels have a ``pace`` (levels,), how many of those steps one of theirs is, and groups a ``level``
    (groups,).  ``own`` is what compiled loops read.  At the start all levels end a step, of no length.
    """

    def __init__(self, pace: Sequence[int], level: np.ndarray):
        self.pace, self._level = np.array(pace), level
        self.own = OwnSteps(*np.zeros((len(OwnSteps._fields), len(level))))
        self.ends, self._done = np.ones(len(pace), bool), np.zeros(len(pace), np.int64)
        self._at_once = True

    def turn(self, steps: int, at_once: bool) -> None:
        """To the step after so many; what is slow is gathered ``at_once`` by levels that end one."""
        pace, after = self.pace.astype(float), 1 + steps % self.pace
        self.ends, self._done, self._at_once = after == self.pace, (steps + 1) // self.pace, at_once
        part, begun = after / pace, after > 1
        told = (
            np.where(begun, 0.0, pace),
            np.where(self.ends, pace, 0.0),
            after - 0.5 * pace,
            pace * (part + 0.75 * part**2) - np.where(begun, 0.5 * pace, 0.0),
            -pace * part**2,
            0.25 * pace * part**2,
        )
        for array, of_levels in zip(self.own, told):
            array[:] = of_levels[self._level]

    def every(self, steps: int) -> np.ndarray:
        """Which levels end the last of so many steps of theirs (levels,)."""
        return self.ends & (self._done % steps == 0)

    def due(self, one: Pass) -> np.ndarray:
        """Which levels need a pass (levels,)."""
        return self.ends if self._at_once and one.slow else self.every(one.every)
