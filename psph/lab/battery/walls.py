"""Particles that are where no fluid can be."""

import numpy as np

from psph.scene.shapes import bounds, inside

DEEP = 0.5
"""Spacings inside a wall from which on a particle counts as lost."""


def lost(scene, position: np.ndarray) -> int:
    """How many fluid particles at ``position`` (n, dim) are inside a wall, or beyond all walls.

    Above the walls, against gravity, a particle may come back.
    """
    gone = ~np.isfinite(position).all(axis=1)
    walls = [wall.shape for wall in scene.case.walls.values()]
    if not walls:
        return int(gone.sum())
    for shape in walls:
        gone |= _deep(shape, position, DEEP * scene.spacing)
    lower, upper = (np.array(ends) for ends in zip(*map(bounds, walls)))
    lower, upper = lower.min(axis=0), upper.max(axis=0)
    open_above, open_below = (np.array(scene.layout.up) > 0.0), (np.array(scene.layout.up) < 0.0)
    gone |= ((position > upper) & ~open_above).any(axis=1)
    gone |= ((position < lower) & ~open_below).any(axis=1)
    return int(gone.sum())


def _deep(shape, position: np.ndarray, depth: float) -> np.ndarray:
    """Whether the places so far away along each axis lie in the shape too."""
    found = inside(shape, position.T, 0.0)
    for step in depth * np.eye(position.shape[1]):
        for side in (-1.0, 1.0):
            found = found & inside(shape, (position + side * step).T, 0.0)
    return found
