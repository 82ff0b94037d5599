"""How long the lists of a step in two passes hold: told by where particles will be at its end."""

import math
from collections.abc import Sequence

import numpy as np

from psph.composition.reflections import Plane
from psph.parallel.domain import Domain
from psph.parallel.reductions import largest
from psph.parallel.skin import NEAR_PLANE, Bounds, Skin
from psph.particles.drift import HIGH, MOVED, NONE, bounding_boxes, largest_differences

BULGE = 0.25
"""Between the ends of a step of Δt two walls that accelerate, by formulas, leave the chords of their ways by
so much of aΔt² at the most, the one from the other."""


class Arrivals(Skin):
    """Keeps the lists of ``domain`` while no two neighbours differ by ``width`` m at the end of a step.

    At the middle of a step, where it is asked, the rest of each particle's way is known: the field
    ``coming``.  Ways are straight, so that a difference is largest at one of their ends.  Where nobody
    can have gone far enough it does not look.
    """

    remembered = ("width", "_served", "drifted", "_apart")

    def __init__(
        self,
        domain: Domain,
        width: float,
        planes: Sequence[Plane],
        bounds: Bounds | None,
        coming: str,
    ):
        super().__init__(domain, width, planes, bounds)
        self._coming = coming

    def renew(self) -> None:
        """The lists are new."""
        self._served = 1
        self.drifted = self._apart = 0.0

    def holds(self, dt: float, speed: float, acceleration: float, shift: float = 0.0) -> bool:
        """Whether the lists hold to the end of the step, before which particles go ``dt`` s with the largest
        ``speed``, ``acceleration`` and ``shift`` (m/s) of the scene; collective where it must look."""
        way = dt * (speed + shift + dt * acceleration)  # kicked by half a step, of which half may be over
        drifted, apart = self.drifted + way, self._apart + 2.0 * way
        if self._planes or not (apart < self.width and drifted < self.farthest):
            drifted, apart = self._look()
            apart += BULGE * acceleration * dt * dt
            if not (apart < self.width and drifted < self.farthest):
                return False
        self._served += 1
        self.drifted, self._apart = drifted, apart
        return True

    def _look(self) -> tuple[float, float]:
        """How far a particle will be from where it was listed, and two neighbours from how they were, m."""
        domain, store, grid = self.domain, self.domain.store, self.domain.grid
        position, listed, coming = (
            np.array(store.rows[name], np.int64) for name in ("position", "listed_position", self._coming)
        )
        low, high = bounding_boxes(
            *(store.data, position, listed, NONE, domain.starts, domain.planes),
            *(grid.counts, grid.reach, grid.periodic, coming),
        )
        self._meet_neighbours(low, high, grid.counts[1])
        mine = largest_differences(low, high, domain.planes, grid.counts[1], grid.of_counts, grid.periodic)
        apart2, _, drifted2, beyond = largest(domain.comm, [*mine, self._beyond_planes()]).tolist()
        return math.sqrt(drifted2), math.sqrt(apart2) + self._nearer * beyond

    def _meet_neighbours(self, low: np.ndarray, high: np.ndarray, rows: int) -> None:
        """The boxes of ghosts are those of their owners, which know where these go."""
        boxes = np.concatenate([low[MOVED], -high[MOVED]], axis=1)  # HIGH where empty
        below, above = self.domain.trade_planes(boxes[rows : 2 * rows], boxes[-2 * rows : -rows], HIGH)
        for lines, told in ((slice(None, rows), below), (slice(-rows, None), above)):
            low[MOVED, lines], high[MOVED, lines] = told[:, : low.shape[2]], -told[:, low.shape[2] :]

    def _beyond_planes(self) -> float:
        """How far this rank's particles come beyond one of the planes, m; of those that were before it when
        they were listed."""
        store, farthest = self.domain.store, 0.0
        for plane in self._planes:
            x, listed, coming = (
                store[name][plane.axis][store.inner] for name in ("position", "listed_position", self._coming)
            )
            way = plane.side * (x + coming - plane.at)
            near = (way > -NEAR_PLANE * self.domain.cutoff) & (plane.side * (listed - plane.at) <= 0.0)
            farthest = max(farthest, float(way[near].max(initial=0.0)))
        return farthest
