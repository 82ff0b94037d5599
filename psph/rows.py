"""Sums over the components of each row of an array, of the same bits in however many rows."""

from collections.abc import Sequence

import numpy as np


def projected(rows: np.ndarray, direction: Sequence[float]) -> np.ndarray:
    """x·n of each row x of ``rows`` (n, dim), (n,).

    In the order of the axes: a product of matrices is rounded by how many rows there are, which differs
    with the number of ranks.
    """
    total = rows[:, 0] * direction[0]
    for axis in range(1, len(direction)):
        total += rows[:, axis] * direction[axis]
    return total
