"""Values between particles."""

from collections.abc import Sequence

import numpy as np


def interpolated(
    position: np.ndarray,
    values: np.ndarray,
    at: np.ndarray,
    spacing: float | np.ndarray,
    periods: Sequence[float | None],
) -> np.ndarray:
    """Values of particles at other places, averaged by the squares of (1 − r/2dx)₊.

    ``position`` and ``at`` are (n, dim) in m, ``spacing`` is dx, or that of each particle (n,); r is
    the distance to the nearest image, ``periods`` a length in m or None for each axis.  Where no
    particle is that near, the nearest one's value.
    """
    from scipy.spatial import cKDTree

    lengths = np.array([period or 0.0 for period in periods])  # 0: the axis does not repeat
    tree = cKDTree(folded(position, lengths), boxsize=lengths)
    reach = 2.0 * np.append(np.broadcast_to(spacing, len(position)), np.max(spacing))  # one more: nobody
    distance, who = tree.query(at, k=4 ** position.shape[1], distance_upper_bound=reach[-1])
    share = np.maximum(1.0 - distance / reach[who], 0.0) ** 2
    near = share.sum(axis=1) > 0.0
    padded = np.concatenate([values, values[:1]])  # where there are fewer, the share is zero
    share[near] /= share[near].sum(axis=1, keepdims=True)
    averages = np.einsum("nk,nk...->n...", share, padded[who])
    averages[~near] = values[tree.query(at[~near])[1]]
    return averages


def folded(position: np.ndarray, lengths: np.ndarray) -> np.ndarray:
    """Positions from 0 to below the length along each axis that has one."""
    folded = position.copy()
    for x, length in zip(folded.T, lengths):
        if length:
            x -= length * np.floor(x / length)
            x[x >= length] = 0.0  # rounding may land on the upper edge
    return folded
