"""From a number of neighbours to a smoothing length."""

import math

from psph.smoothing import WendlandC2

KERNEL = "wendland-c2"
"""The kernel of every problem."""

BALL = {2: math.pi, 3: 4.0 / 3.0 * math.pi}
"""Volume of the unit ball."""


def reach(neighbours: int, dimensions: int) -> float:
    """Support in spacings that holds so many neighbours in the bulk."""
    return ((neighbours + 1) / BALL[dimensions]) ** (1.0 / dimensions)


def smoothing(neighbours: int, dimensions: int) -> float:
    """h/dx of the bench's kernel for so many neighbours in the bulk."""
    return reach(neighbours, dimensions) / WendlandC2.support
