"""How far regions with finer particles may go, by what carries them."""

import math
from typing import NamedTuple

import numpy as np

from psph.case.forms import Ball, Box, Cylinder, Disc
from psph.case.keys import AXES
from psph.physics.motion import is_rigid, moments
from psph.physics.rigid.pose import PLACE, maps
from psph.scene.shapes import bounds
from psph.scene.sweeps import MOMENTS

ROUND = (Ball, Box, Cylinder, Disc)
"""Forms that are nearest to a point where their middle is, as they go along axes."""


class Way(NamedTuple):
    """The ``middle`` of a region, and its ``least`` and ``most`` displacement along each axis, m (dim,)."""

    middle: np.ndarray
    least: np.ndarray
    most: np.ndarray

    def back(self, points: np.ndarray) -> np.ndarray:
        """``points`` (n, dim), m, less the way after which the region is nearest to each of them."""
        return points - np.clip(points - self.middle, self.least, self.most)


def way_of(layout, one) -> Way:
    """Of a region of a case: any where a body may turn, or its form is not one of ROUND along the axes."""
    middle = 0.5 * np.sum(bounds(one.shape), axis=0)
    least, most = np.zeros((2, layout.dimensions))
    if not one.moves:
        return Way(middle, least, most)
    free = _free_axes(layout, one)
    if free is None or not _is_round(one.shape):
        return Way(middle, least - math.inf, most + math.inf)
    if one.moves_with in layout.case.walls:
        least, most = _swept(layout, one.moves_with, middle)
    least[free], most[free] = -math.inf, math.inf
    return Way(middle, least, most)


def _free_axes(layout, one) -> list[int] | None:
    """The axes along which nobody knows how far a region goes; None: it may go anywhere."""
    if one.front:
        return [AXES.index(one.front[0])]
    carrier = layout.case.boundaries[one.moves_with]
    if hasattr(carrier, "freed"):
        freed = carrier.freed(layout.dimensions)
        return None if carrier.motion or set(freed) - set(AXES) else [AXES.index(axis) for axis in freed]
    motion = _motion(layout, one.moves_with)
    return None if not is_rigid(motion) or hasattr(motion, "corrected") else []


def _motion(layout, name: str):
    return layout.parts[layout.names.index(name)].motion


def _swept(layout, name: str, middle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The least and the most that a point at the ``middle`` goes with a wall until the end of the run."""
    motion, end = _motion(layout, name), layout.case.time.end
    found = np.stack([maps(motion.pose(t), len(middle))[PLACE] for t in moments(end, MOMENTS)])
    ways = found[:, :, 0] + found[:, :, 1:] @ middle - middle
    return ways.min(axis=0), ways.max(axis=0)


def _is_round(shape) -> bool:
    """Whether a shape is one of ROUND as drawn, its axis along one of the scene."""
    plain = not (shape.is_placed or shape.intersection) and isinstance(shape.form, ROUND)
    return plain and getattr(shape.form, "axis", AXES[0]) in AXES
