"""The curl of a fluid's velocity, from the particles of a frame."""

from collections.abc import Sequence

import numpy as np

from psph.output.interpolation import folded

BLOCK = 20_000
"""Particles whose neighbours are held at once."""
ALONE = 1e-3
"""Smallest over largest eigenvalue of the matrix of moments below which neighbours do not span the space."""


def vorticity(
    position: np.ndarray,
    velocity: np.ndarray,
    volume: np.ndarray,
    reach: np.ndarray,
    periods: Sequence[float],
) -> np.ndarray:
    """ω = ∇×u in 1/s of particles at ``position`` (n, dim): (n,) out of the plane in 2D, (n, 3) in 3D.

    ∇u_i = Σ_j V_j (u_j − u_i) ⊗ M⁻¹ ∇W_ij with M = Σ_j V_j x_ji ⊗ ∇W_ij, exact in a linear field at a
    surface too: Bonet & Lok (1999), Comput. Methods Appl. Mech. Eng. 180, 97.  W is Wendland's C2 of the
    support ``reach`` in m, of each where it is (n,), ``volume`` (n,) in m^dim, ``periods`` in m, 0 where an
    axis does not repeat.  NaN where the neighbours do not span the space, as in spray.
    """
    from scipy.spatial import cKDTree

    lengths, reach = np.asarray(periods, float), np.broadcast_to(reach, len(position))
    sound = np.isfinite(position).all(axis=1)
    gradient = np.full((len(position), position.shape[1], position.shape[1]), np.nan)
    sound = np.flatnonzero(sound)
    sound = sound[np.argsort(reach[sound], kind="stable")]  # those of a block see about as far
    x, u, v, reach = folded(position[sound], lengths), velocity[sound], volume[sound], reach[sound]
    gradients = np.empty((len(x), *gradient.shape[1:]))
    tree = cKDTree(x, boxsize=lengths)
    for first in range(0, len(x), BLOCK):
        rows = slice(first, first + BLOCK)
        far = reach[rows]
        most = tree.query_ball_point(x[rows], far.max(), return_length=True).max(initial=1)
        distance, who = tree.query(x[rows], k=int(most) + 1, distance_upper_bound=far.max())
        near = distance < far[:, None]
        who = np.where(near, who, 0)
        away = x[who] - x[rows, None]
        away -= np.where(lengths > 0, np.round(away / np.where(lengths > 0, lengths, 1.0)) * lengths, 0.0)
        slope = np.where(near, v[who] * np.maximum(1.0 - distance / far[:, None], 0.0) ** 3, 0.0)
        weights = slope[..., None] * away  # -W'/r x_ji, but for a factor that M takes out again
        moments = np.einsum("nka,nkb->nab", away, weights, optimize=True)
        turned = np.einsum("nka,nkb->nab", u[who] - u[rows, None], weights, optimize=True)
        gradients[rows] = turned @ _inverse(moments)
    gradient[sound] = gradients
    if position.shape[1] == 2:
        return gradient[:, 1, 0] - gradient[:, 0, 1]
    pairs = ((2, 1), (0, 2), (1, 0))
    return np.stack([gradient[:, a, b] - gradient[:, b, a] for a, b in pairs], axis=1)


def _inverse(moments: np.ndarray) -> np.ndarray:
    """M⁻¹ of symmetric matrices (n, dim, dim); NaN where M is all but singular."""
    sizes = np.linalg.eigvalsh(moments)
    good = sizes[:, 0] > ALONE * sizes[:, -1]
    inverses = np.full_like(moments, np.nan)
    inverses[good] = np.linalg.inv(moments[good])
    return inverses
