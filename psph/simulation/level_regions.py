"""Where regions with finer particles have gone: with what carries them, or with the front of the fluid.

They go where new lists are made, and stay there until the next ones: who leads and who follows changes then
alone.
"""

import numpy as np

from psph.case.keys import AXES
from psph.parallel.reductions import largest
from psph.physics.rigid.pose import PLACE
from psph.scene.levels import STRAYS, Levels
from psph.scene.shapes import bounds
from psph.work import Rank

LEAPS = 1.25
"""Supports of the finest level by which a region goes at once after a front that leaps, as where water comes
in ahead of it: a little more than a particle strays until new lists are made.  Had it gone farther than its
margin, coarse particles would follow finer ones that are still to be born, and nobody would lead."""


class GoingAlong:
    """The regions of the ``levels`` of a scene on a rank, which moves them."""

    def __init__(self, rank: Rank, levels: Levels):
        layout, pose_of = rank.scene.layout, rank.plan.materials.pose_of
        self._levels, self._comm, self._periods = levels, rank.domain.comm, layout.periods
        finest = levels.support(levels.count - 1)
        self._farthest, self._leap = STRAYS * finest, LEAPS * finest
        self._maps = np.zeros((0, 0, 0, 0))
        self._carried, self._fronts = [], []
        leads = [n for n, one in enumerate(rank.scene.species) if one.is_fluid and one.mobile]
        for number, one in enumerate(layout.case.space.refine):
            if one.moves_with:
                middle = 0.5 * np.sum(bounds(one.shape), axis=0)
                self._carried.append((number, pose_of[layout.names.index(one.moves_with)], middle))
            elif one.front:
                axis, way = AXES.index(one.front[0]), 1.0 if one.front.endswith("upper") else -1.0
                census = rank.scene.census
                ends = census.highest if way > 0.0 else census.lowest
                self._fronts.append((number, axis, way, way * (way * ends[leads, axis]).max()))

    def meet(self, maps: np.ndarray) -> None:
        """Get the maps of all rigid motions."""
        self._maps = maps

    @property
    def hold(self) -> bool:
        """Whether what carries regions has not gone far since they were moved; the same on every rank."""
        moved = self._levels.moved
        gone = [self._with(row, middle) - moved[number] for number, row, middle in self._carried]
        return all(np.sqrt((self._nearest(way) ** 2).sum()) < self._farthest for way in gone)

    def move(self, fluid: np.ndarray) -> None:
        """Have them where they belong now, with the ``fluid`` that leads at these places (n, dim), m;
        collective where one goes with a front."""
        moved = self._levels.moved
        for number, row, middle in self._carried:
            moved[number] = self._nearest(self._with(row, middle))
        ends = [(way * fluid[:, axis]).max(initial=-np.inf) for _, axis, way, _ in self._fronts]
        for (number, axis, way, begun), end in zip(self._fronts, largest(self._comm, ends) if ends else ()):
            left = way * end - begun - moved[number, axis]
            moved[number, axis] += np.clip(left, -self._leap, self._leap) if np.isfinite(left) else 0.0

    def _with(self, row: int, middle: np.ndarray) -> np.ndarray:
        """How far a point at the ``middle``, m (dim,), at the start has gone with a rigid motion."""
        place = self._maps[row, PLACE]
        return place[:, 0] + sum(place[:, 1 + e] * x for e, x in enumerate(middle)) - middle

    def _nearest(self, way: np.ndarray) -> np.ndarray:
        """The same way but for whole periods."""
        return np.array([x if p is None else x - p * np.rint(x / p) for x, p in zip(way, self._periods)])
