"""Values between particles."""

import numpy as np


def interpolated(
    position: np.ndarray, values: np.ndarray, at: np.ndarray, spacing: float
) -> np.ndarray:
    """Values of particles at other places, averaged by the squares of (1 − r/2dx)₊.

    Where no particle is that near, the nearest one's value.
    """
    from scipy.spatial import cKDTree

    tree = cKDTree(position)
    distance, who = tree.query(at, k=4 ** position.shape[1], distance_upper_bound=2.0 * spacing)
    share = np.maximum(1.0 - distance / (2.0 * spacing), 0.0) ** 2
    near = share.sum(axis=1) > 0.0
    padded = np.concatenate([values, values[:1]])  # where there are fewer, the share is zero
    share[near] /= share[near].sum(axis=1, keepdims=True)
    found = np.einsum("nk,nk...->n...", share, padded[who])
    found[~near] = values[tree.query(at[~near])[1]]
    return found
