"""How orderly particles lie: distances, pieces, voids, noise."""

import numpy as np

APART = 1.5
"""Spacings beyond which particles are in different pieces."""

HOLLOW = 1.0
"""A place is empty where no particle is nearer than so many spacings; on a cubic lattice 0.87."""

FINE = 3
"""Places in a spacing that are looked at in search of voids."""

MOST_PLACES = 4_000_000
"""Beyond it no voids are looked for: the particles are all over the place."""

AROUND, ENOUGH = 1.6, 6
"""Spacings around a particle, and how many there make up its surroundings."""


def tree_of(scene, position: np.ndarray):
    """A tree of places that knows the scene's periods."""
    from scipy.spatial import cKDTree

    if not any(scene.layout.periods):
        return cKDTree(position)
    periods = [period or 0.0 for period in scene.layout.periods]
    return cKDTree(_wrapped(scene, position), boxsize=periods)


def _wrapped(scene, position: np.ndarray) -> np.ndarray:
    """Places from the lower corner on, within the periods."""
    away = position - np.array(scene.layout.lower)
    for d, period in enumerate(scene.layout.periods):
        if period:
            away[:, d] %= period
            away[away[:, d] >= period, d] = 0.0
    return away


def _asked(scene, position: np.ndarray) -> np.ndarray:
    return _wrapped(scene, position) if any(scene.layout.periods) else position


def nearest(scene, position: np.ndarray) -> np.ndarray:
    """Distance of each particle (n, dim) to the one that is nearest, m (n,)."""
    tree = tree_of(scene, position)
    return tree.query(_asked(scene, position), k=2)[0][:, 1]


def pieces(scene, position: np.ndarray) -> int:
    """Groups of particles with gaps between them."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    pairs = tree_of(scene, position).query_pairs(APART * scene.spacing, output_type="ndarray")
    n = len(position)
    graph = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(n, n))
    return int(connected_components(graph, directed=False)[0])


def voids(scene, every: np.ndarray, fluid: np.ndarray) -> float:
    """Enclosed empty space over that of the ``fluid``; ``every``: walls too.  NaN: too wide."""
    from scipy.ndimage import label

    dx = scene.spacing
    ends = [
        (low, low + period) if period else (x.min() - 2.0 * dx, x.max() + 2.0 * dx)
        for x, low, period in zip(fluid.T, scene.layout.lower, scene.layout.periods)
    ]
    counts = [max(round(FINE * (up - low) / dx), 1) for low, up in ends]
    if np.prod(np.array(counts, float)) > MOST_PLACES:
        return float("nan")
    axes = [low + (np.arange(n) + 0.5) * (up - low) / n for n, (low, up) in zip(counts, ends)]
    places = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(counts))
    empty = tree_of(scene, every).query(_asked(scene, places))[0] > HOLLOW * dx
    parts, _ = label(empty.reshape(counts))
    outside = {0}
    for axis, period in enumerate(scene.layout.periods):
        if not period:
            outside |= set(np.take(parts, (0, -1), axis=axis).ravel().tolist())
    enclosed = np.count_nonzero(~np.isin(parts, list(outside)))
    return enclosed / (FINE ** len(counts) * len(fluid))


def checkerboard(scene, frame: dict, fluid: dict) -> float:
    """rms of p minus its mean over the nearest sites, walls among them, Pa; surfaces left out."""
    tree, places = tree_of(scene, frame["position"]), _asked(scene, fluid["position"])
    noise = []
    for own, near in zip(fluid["pressure"], tree.query_ball_point(places, AROUND * scene.spacing)):
        if len(near) > ENOUGH:
            others = (frame["pressure"][near].sum() - own) / (len(near) - 1)
            noise.append(own - others)
    return float(np.sqrt(np.mean(np.square(noise)))) if noise else 0.0
