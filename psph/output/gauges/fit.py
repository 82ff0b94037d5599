"""Values at a point of matter, by the straight function that fits the particles around it."""

import numpy as np

from psph.parallel.reductions import exact_sums

REACH = 2.5
"""Spacings from the point within which particles count."""


def nearest(away: np.ndarray, periods) -> np.ndarray:
    """Differences (n, dim) of places, m, to the nearest image along axes with ``periods`` in m."""
    for axis, period in enumerate(periods):
        if period is not None:
            away[:, axis] -= period * np.rint(away[:, axis] / period)
    return away


def fitted(comm, away: np.ndarray, reach: float, values: np.ndarray) -> np.ndarray:
    """The values (k,) at a point, of those (n, k) of this rank's particles ``away`` (n, dim) m from it.

    f = a + G x is fitted to the particles within ``reach`` m with the weights (1 − (|x|/reach)²)²: so a point
    on a face is not half a spacing off.  NaN where no particle is that near.  The same on every rank.
    """
    d, k = away.shape[1], values.shape[1]
    weight = np.maximum(1.0 - (away**2).sum(axis=1) / reach**2, 0.0) ** 2
    basis = np.column_stack([np.ones(len(away)), away / reach])
    squares = weight[:, None, None] * basis[:, :, None] * basis[:, None, :]
    right = weight[:, None, None] * basis[:, :, None] * values[:, None, :]
    flat = (table.reshape(len(away), (1 + d) * table.shape[2]) for table in (squares, right))
    sums = exact_sums(comm, np.column_stack([*flat]))
    matrix, right_sides = sums[: (1 + d) ** 2].reshape(1 + d, 1 + d), sums[(1 + d) ** 2 :].reshape(1 + d, k)
    if not matrix[0, 0] > 0.0:
        return np.full(k, np.nan)
    return np.linalg.lstsq(matrix, right_sides, rcond=1e-9)[0][0]
