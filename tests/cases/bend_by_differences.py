"""Steady flow round a bend by finite differences: incompressible, on an even staggered grid.

A channel of width 1 along x turns by a right angle into one along y.  Poiseuille's flow with a mean of 1 comes in,
p = 0 where it goes out.  Central differences, Euler's steps, and a pressure that leaves no divergence, until nothing
changes.
"""

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu


def bend(cells, nu, inlet=3, outlet=4, end=40.0):
    """Pressure (nx, ny), NaN in the walls, and velocities (nx, ny) in the middle of cells, ``cells`` across.

    The legs are ``inlet`` long, with the corner, and ``outlet`` beyond it.
    """
    d, nx, ny = 1.0 / cells, inlet * cells, (1 + outlet) * cells
    wet = np.zeros((nx, ny), bool)
    wet[:, :cells] = wet[-cells:] = True
    open_u, open_v = wet[1:] & wet[:-1], wet[:, 1:] & wet[:, :-1]
    number = np.where(wet, np.cumsum(wet).reshape(wet.shape) - 1, -1)
    first = np.concatenate([number[:-1][open_u], number[:, :-1][open_v]])
    second = np.concatenate([number[1:][open_u], number[:, 1:][open_v]])
    n = np.count_nonzero(wet)
    links = sp.coo_matrix((np.ones(len(first)), (first, second)), (n, n))
    links = links + links.T
    held = np.zeros((nx, ny))
    held[-cells:, -1] = 2.0  # half a cell from the end
    factor = splu((sp.diags(np.asarray(links.sum(axis=1)).ravel() + held[wet]) - links).tocsc())
    u, v, p = np.zeros((nx + 1, ny)), np.zeros((nx, ny + 1)), np.zeros((nx, ny))
    s = (np.arange(cells) + 0.5) * d
    u[0, :cells] = 6.0 * s * (1.0 - s)
    u[0, :cells] /= u[0, :cells].mean()
    dt = min(0.2 * d * d / nu, 0.3 * d, 0.7 * nu)
    for step in range(round(end / dt)):
        was = v[-cells:, -1].copy()
        u[1:-1] += dt * np.where(open_u, _rate_of_u(u, v, d, nu, open_u), 0.0)
        v[:, 1:-1] += dt * np.where(open_v, _rate_of_u(v.T, u.T, d, nu, open_v.T).T, 0.0)
        v[-cells:, -1] = v[-cells:, -2]
        gained = (u[1:] - u[:-1] + v[:, 1:] - v[:, :-1])[wet] * -d / dt
        p[wet] = factor.solve(gained)
        u[1:-1] -= dt * np.where(open_u, np.diff(p, axis=0) / d, 0.0)
        v[:, 1:-1] -= dt * np.where(open_v, np.diff(p, axis=1) / d, 0.0)
        v[-cells:, -1] += dt * 2.0 * p[-cells:, -1] / d
        if step > 100 and abs(v[-cells:, -1] - was).max() < 1e-7 * dt:
            break
    return np.where(wet, p, np.nan), 0.5 * (u[1:] + u[:-1]), 0.5 * (v[:, 1:] + v[:, :-1])


def _rate_of_u(u, v, d, nu, inside):
    """−u·∇u + ν∇²u on the inner faces of ``u``; beyond a wall the velocity is the opposite."""
    here = u[1:-1]
    below, above = np.pad(here[:, :-1], ((0, 0), (1, 0))), np.pad(here[:, 1:], ((0, 0), (0, 1)))
    dry = ~inside
    below = np.where(np.pad(dry[:, :-1], ((0, 0), (1, 0)), constant_values=True), -here, below)
    above = np.where(np.pad(dry[:, 1:], ((0, 0), (0, 1)), constant_values=True), -here, above)
    east, west = u[2:] + here, u[:-2] + here
    side = 0.5 * (v[1:] + v[:-1])
    flux = 0.25 * (east**2 - west**2) + 0.5 * (side[:, 1:] * (above + here) - side[:, :-1] * (below + here))
    return -flux / d + nu * (u[2:] + u[:-2] + below + above - 4.0 * here) / (d * d)
