"""The paddles of a simulation that take up waves that come back, and the levels that they answer to."""

import math
from dataclasses import asdict

import numpy as np

from psph.output.gauges.level import LevelGauge
from psph.output.gauges.make import PER_SPACING
from psph.physics.rigid.absorption import Absorbing, Correction
from psph.physics.rigid.pose import Pose, in_space, maps
from psph.vectors import Vector, add, dot, scale
from psph.work import Work


class Face:
    """Where the level before a paddle is measured, of those of some ``groups`` of a scene that go one way.

    On a line from the paddle's lower end to its upper one, before the middle of its width, as far before its
    face as the kernel reaches, so that no wall is in the way.
    """

    def __init__(self, scene, groups: list[int], heading: Vector):
        half = 0.5 * scene.spacing
        self._low = in_space(tuple((scene.census.lowest[groups].min(axis=0) - half).tolist()))
        self._high = in_space(tuple((scene.census.highest[groups].max(axis=0) + half).tolist()))
        self._dimensions, self._heading = scene.dimensions, heading
        self.ahead = scene.kernel.support / scene.kernel.inverse_h
        middle = scale(add(self._low, self._high), 0.5)
        face = sum(max(w * a, w * b) for w, a, b in zip(heading, self._low, self._high))
        self._before = add(middle, scale(heading, face - dot(heading, middle) + self.ahead))
        height = self._high[self._dimensions - 1] - self._low[self._dimensions - 1]
        self._parts = math.ceil(height / scene.spacing * PER_SPACING)

    def gauge(self, moved: float) -> LevelGauge:
        """What measures the level of water before the paddle when that has ``moved`` so many m."""
        place = add(self._before, scale(self._heading, moved))[: self._dimensions - 1]
        low, high = (end[self._dimensions - 1] for end in (self._low, self._high))
        return LevelGauge("", math.inf, (*place, low), (*place, high), self._parts)


class Paddles(Work):
    """The paddles that answer to the water (psph.physics.rigid.absorption).

    ``rows`` are their places among the rigid motions of a ``plan``.  Their ``corrections`` are the same on
    every rank, since levels are sums of whole numbers.  The level at rest is that of the start.
    """

    name = "paddles"

    def __init__(self, scene, plan):
        self.rows = [row for row, motion in enumerate(plan.materials.rigid) if isinstance(motion, Absorbing)]
        self._dimensions = scene.dimensions
        self._motions = [plan.materials.rigid[row] for row in self.rows]
        self.corrections = [Correction() for _ in self.rows]
        self._rest: list[float] = []
        groups = ([n for n, one in enumerate(scene.species) if one.motion == m] for m in self._motions)
        self._faces = [Face(scene, own, m.heading) for own, m in zip(groups, self._motions)]

    def poses(self, time: float) -> list[Pose]:
        """Where they are at ``time``, s."""
        return [motion.corrected(time, own) for motion, own in zip(self._motions, self.corrections)]

    def maps(self, time: float) -> np.ndarray:
        """The maps of each at ``time``, s (paddles, 3, dim, 1 + dim)."""
        return np.array([maps(pose, self._dimensions) for pose in self.poses(time)])

    def drift(self, time: float, dt: float) -> None:
        """A step of ``dt`` s."""
        for motion, own in zip(self._motions, self.corrections):
            own.advance(motion.absorption, dt)

    def answer(self, simulation, time: float, dt: float) -> None:
        """To the levels at ``time``, s, the end of a step of ``dt`` s, or the start; collective."""
        moved = [dot(m.heading, p.translation) for m, p in zip(self._motions, self.poses(time))]
        levels = [face.gauge(way).row(simulation)[1] for face, way in zip(self._faces, moved)]
        self._rest = self._rest or levels
        told = zip(self._motions, self.corrections, self._faces, moved, levels, self._rest)
        for motion, own, face, way, level, rest in told if dt > 0.0 else ():
            surplus = motion.surplus(time, way + face.ahead, level - rest)
            own.answer(motion.absorption, surplus, dt)

    def state(self) -> dict:
        """What the next steps rest on."""
        return {"levels_at_rest": self._rest, "corrections": [asdict(own) for own in self.corrections]}

    def restore(self, state: dict) -> None:
        """Go on from there."""
        self._rest = state["levels_at_rest"]
        self.corrections = [Correction(**own) for own in state["corrections"]]
