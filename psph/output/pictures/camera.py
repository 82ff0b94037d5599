"""A camera before a box: where it stands, and where on the picture it sees a point."""

import math
from typing import NamedTuple

import numpy as np

AZIMUTH, ELEVATION, ANGLE = -24.0, 22.0, 24.0
"""Degrees: to the left of the front, above the ground, and of view from the bottom to the top."""
ROUNDS = 12
"""Times that the camera moves back and aside until the box just fits."""


class Camera(NamedTuple):
    """It stands at ``eye`` (3,), m, with axes of unit length to its ``right``, ``up`` and ``ahead``.

    ``aspect`` is the width of its picture over the height.
    """

    eye: np.ndarray
    right: np.ndarray
    up: np.ndarray
    ahead: np.ndarray
    aspect: float

    def seen(self, points: np.ndarray) -> np.ndarray:
        """Where points (n, 3) are on the picture, (n, 2): 0 at the left and the bottom, 1 opposite."""
        offset = points - self.eye
        depth = (offset @ self.ahead) * math.tan(math.radians(ANGLE / 2))
        across, high = offset @ self.right / (depth * self.aspect), offset @ self.up / depth
        return 0.5 + 0.5 * np.stack([across, high], axis=1)


def directions(up: int, sense: int, across: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The unit vectors (3,) to the right, upwards and ahead of somebody in front of a scene.

    ``up`` is an axis and ``sense`` -1 where it points down; ``across`` is the axis that runs across.
    """
    upwards, right = np.zeros(3), np.zeros(3)
    upwards[up], right[across] = sense, 1.0
    return right, upwards, np.cross(upwards, right)


def before(
    lower: np.ndarray,
    upper: np.ndarray,
    axes: tuple[np.ndarray, np.ndarray, np.ndarray],
    aspect: float | None,
) -> Camera:
    """The camera that sees a box, m, from the left, the front and above; ``axes``: :func:`directions`.

    Without ``aspect``, the picture is as wide as the box asks for.
    """
    right, upwards, front = axes
    turn, tilt = math.radians(AZIMUTH), math.radians(ELEVATION)
    level = math.cos(turn) * front - math.sin(turn) * right
    ahead = math.cos(tilt) * level - math.sin(tilt) * upwards
    beside = np.cross(ahead, upwards) / math.cos(tilt)
    axes = (beside, np.cross(beside, ahead), ahead)
    points = corners_of(lower, upper)
    middle = (lower + upper) / 2
    distance = 2.0 * float(np.linalg.norm(upper - lower)) / math.tan(math.radians(ANGLE / 2))
    camera = Camera(middle - distance * ahead, *axes, aspect or 1.0)
    for _ in range(ROUNDS):
        seen = camera.seen(points)
        low, high = seen.min(axis=0), seen.max(axis=0)
        if aspect is None:
            width, height = high - low
            camera = camera._replace(aspect=camera.aspect * float(width / height))
            seen = camera.seen(points)
            low, high = seen.min(axis=0), seen.max(axis=0)
        half = distance * math.tan(math.radians(ANGLE / 2))
        off = (low + high - 1.0) * half
        distance *= float((high - low).max())
        middle = middle + off[0] * camera.aspect * camera.right + off[1] * camera.up
        camera = camera._replace(eye=middle - distance * ahead)
    return camera


def corners_of(lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
    """The eight corners of a box, (8, 3)."""
    return np.array(np.meshgrid(*zip(lower, upper), indexing="ij")).reshape(3, -1).T
