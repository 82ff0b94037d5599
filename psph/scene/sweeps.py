"""What a rigid motion sweeps until the end of a run."""

import math
from collections.abc import Sequence
from functools import cache
from itertools import product
from typing import NamedTuple

import numpy as np

from psph.physics.motion import deforms, is_prescribed, moments
from psph.physics.rigid.pose import maps

MOMENTS = 1000
"""Times of a run at which a motion is looked at."""


class Sweep(NamedTuple):
    """What a motion does until the end of a run, as far as can be seen at some moments.

    ``lower``, ``upper`` of the box that it sweeps, the longest ``way`` of a point from where it was, m; the
    largest ``speed``, m/s, and ``acceleration``, m/s²; the largest ``jump`` of a velocity at the start, m/s.
    """

    lower: np.ndarray
    upper: np.ndarray
    way: float
    speed: float
    acceleration: float
    jump: float


@cache
def sweep(motion, lower: tuple[float, ...], upper: tuple[float, ...], end: float) -> Sweep:
    """Of all points in a box that move by ``motion``."""
    corners = list(product(*zip(lower, upper)))
    found = np.stack([maps(motion.pose(t), len(lower)) for t in moments(end, MOMENTS)])
    points = np.array(corners)
    x, v, a = (found[:, which, :, :1] + found[:, which, :, 1:] @ points.T for which in range(3))
    longest = (float(np.sqrt((z**2).sum(axis=1)).max()) for z in (x - points.T, v, a, v[:1]))
    way, speed, acceleration, jump = longest
    return Sweep(x.min(axis=(0, 2)), x.max(axis=(0, 2)), way, speed, acceleration, jump)


def farthest_way(motion, room: tuple[Sequence[float], Sequence[float]], end: float) -> float:
    """How far a point of a box, the ``room``, goes by a ``motion`` until the ``end``, s, at the most, m;
    infinite where the water has a part in that, or the motion deforms."""
    if not is_prescribed(motion):
        return 0.0
    if deforms(motion) or hasattr(motion, "corrected"):
        return math.inf
    return sweep(motion, *map(tuple, room), end).way
