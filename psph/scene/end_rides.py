"""Planes of open ends that move along their axis with a wall."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from psph.case.ends import OpenEnd
from psph.case.keys import AXES
from psph.physics.motion import is_rigid, moments, told_of
from psph.physics.rigid.pose import maps
from psph.scene.sweeps import MOMENTS

STRAY = 1e-9
"""Spacings by which a wall that carries a plane may leave the axis."""


class Ride(NamedTuple):
    """Where a plane along an ``axis`` stands: ``at`` m at first, then as far on as its wall, which goes by a
    ``motion``; None where it is still."""

    at: float
    axis: int
    motion: Any

    def place(self, time: float) -> float:
        """At a ``time``, s, m."""
        return self.at if self.motion is None else self.at + self._along(time, 0)

    def pace(self, time: float) -> float:
        """How fast it goes along the axis, m/s."""
        return 0.0 if self.motion is None else self._along(time, 1)

    def _along(self, time: float, which: int) -> float:
        return float(maps(self.motion.pose(time), 1 + self.axis)[which, self.axis, 0])


def ride_of(scene, end: OpenEnd) -> Ride:
    """How the plane of an end moves."""
    return Ride(end.at, end.axis, end.on and _motion(scene, end))


def _motion(scene, end: OpenEnd):
    keys = [part.key for part in scene.layout.parts]
    return told_of(scene.census.motions[keys.index(f"walls.{end.on}")])


def ride_faults(scene, name: str, end: OpenEnd) -> Iterator[str]:
    """A wall that cannot carry a plane: it turns, leaves the axis, or how it goes is not told beforehand."""
    if end.on is None:
        return
    motion, dimensions = _motion(scene, end), scene.layout.dimensions
    if is_rigid(motion):
        found = [maps(motion.pose(t), dimensions)[0] for t in moments(scene.case.time.end, MOMENTS)]
        way = np.array(found) - np.eye(dimensions, 1 + dimensions, 1)
        way[:, end.axis, 0] = 0.0
        if abs(way).max() <= STRAY * scene.spacing:
            return
    yield (
        f"ends.{name}.on: {end.on}: the motion of this wall is not one along {AXES[end.axis]} alone that is "
        "told beforehand; name a wall whose is, or remove on"
    )
