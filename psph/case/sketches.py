"""Lines that show in a picture where something acts."""

import math
from itertools import product

from psph.case.keys import AXES, Place

RIM = 24
"""Points of a circle."""


def rectangle(lower: Place, upper: Place) -> tuple[Place, ...]:
    """The closed line around a rectangle between two corners, which are equal along one axis in 3D."""
    along = [d for d, (low, up) in enumerate(zip(lower, upper)) if low != up]
    if len(along) < 2:
        return lower, upper
    one, other = along[:2]

    def corner(*far: int) -> Place:
        return tuple(up if d in far else low for d, (low, up) in enumerate(zip(lower, upper)))

    return corner(), corner(one), corner(one, other), corner(other), corner()


def edges(lower: Place, upper: Place) -> list[tuple[Place, Place]]:
    """The edges of a box between two corners."""
    ends = list(product(*zip(lower, upper)))
    return [(a, b) for n, a in enumerate(ends) for b in ends[:n] if sum(x != y for x, y in zip(a, b)) == 1]


def ring(center: Place, axis: str, radius: float) -> tuple[Place, ...]:
    """The circle around a point across an axis; in 2D a line."""
    across = [d for d in range(len(center)) if d != AXES.index(axis)]
    angles = [math.tau * k / RIM for k in range(RIM + 1)] if len(across) > 1 else [0.0, math.pi]
    ways = (dict(zip(across, (math.cos(a), math.sin(a)))) for a in angles)
    return tuple(tuple(x + radius * way.get(d, 0.0) for d, x in enumerate(center)) for way in ways)
