"""The region without fluid: behind the face of a wall, and beyond a side that walls close."""

from collections.abc import Container
from functools import cached_property

import numpy as np

from psph.physics.motion import Fixed
from psph.scene.layout import NONE
from psph.scene.scene import Scene

FIXED = Fixed()

AT_ONCE = 1 << 15
"""Points that are processed together: their arrays fit into the processor's cache."""


class WallRegion:
    """The walls of a scene that move together, by ``motion``, where they stood at the start; continued
    outwards where they close a whole side of its particles.

    Of walls whose motion deforms them it knows nothing: where they stood, fluid may be.
    """

    def __init__(self, scene: Scene, motion=FIXED):
        self.scene, self.layout, self.lattice = scene, scene.layout, scene.layout.lattice
        self._still = np.zeros(NONE + 1, bool)
        for number, own in enumerate(scene.census.motions):
            drawn = scene.layout.parts[number].drawn  # others stand in the same place once more
            self._still[number] = drawn and own == motion and type(own) is type(motion)

    @property
    def groups(self) -> tuple[int, ...]:
        """The numbers of these walls."""
        return tuple(np.flatnonzero(self._still).tolist())

    def deep(
        self, position: np.ndarray, depth: float | np.ndarray, once: Container[int] = frozenset()
    ) -> np.ndarray:
        """True where a point of ``position`` (n, dim) lies ``depth`` spacings, (n,) or for all, behind every
        face.

        A point that is inside, and so are the points so far away along each axis, both ways.  Along the
        axes ``once`` periods do not count: points there are taken where they are.
        """
        outside = np.zeros(len(position), bool)
        if not self._still.any():
            return outside
        far = np.broadcast_to(depth * self.scene.spacing, len(position))
        for first in range(0, len(position), AT_ONCE):
            part = slice(first, first + AT_ONCE)
            outside[part] = self._deep(position[part], far[part], once)
        return outside

    @cached_property
    def closed(self) -> tuple[tuple[bool, bool], ...]:
        """For each axis whether walls close its lower and its upper side: every site there is one."""
        return tuple(
            (False, False) if period is not None else (self._all_wall(d, 0), self._all_wall(d, -1))
            for d, period in enumerate(self.scene.layout.periods)
        )

    def _deep(self, position: np.ndarray, depth: np.ndarray, once: Container[int]) -> np.ndarray:
        outside = self._inside(position, once)
        near, depth = position[outside], depth[outside]  # few: the rest is far from any wall's inside
        held = np.ones(len(near), bool)
        for d in range(self.scene.dimensions):
            for away in (-depth, depth):
                beside = near.copy()
                beside[:, d] += away
                held &= self._inside(beside, once)
        outside[outside] = held
        return outside

    def _inside(self, position: np.ndarray, once: Container[int]) -> np.ndarray:
        """True at points (n, dim) in a wall, or beyond a side that walls close."""
        grid = [x.copy() for x in position.T]  # unit stride
        grid = [x if d in once else self.scene.layout.folded(d, x) for d, x in enumerate(grid)]
        outside = self._still[self.layout.held(grid, grid[0].shape)]
        low = [x < least for x, least in zip(grid, self.lattice.lower)]
        high = [x > most for x, most in zip(grid, self.lattice.upper)]
        # What is above an open top has jumped over a wall: it is not behind it.
        within = np.ones(len(position), bool)
        for d, (lower, upper) in enumerate(self.closed):
            within &= (lower | ~low[d]) & (upper | ~high[d])
        for d, (lower, upper) in enumerate(self.closed):
            outside |= within & (lower & low[d] | upper & high[d])
        return outside

    def _all_wall(self, d: int, side: int) -> bool:
        """Whether the outermost sites at this end of axis ``d`` are all wall."""
        grid = self.lattice.grid(0, self.lattice.planes)
        grid[d] = grid[d][[side]]
        held = self.layout.held(grid, np.broadcast_shapes(*(x.shape for x in grid)))
        return bool(self._still[held].all())
