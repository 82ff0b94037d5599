"""A floating sphere in a round tank that is let go above its place at rest, by potential flow.

The surface is taken where it is at rest, the sphere where it floats; its buoyancy is that of the depth to which
it sinks.  By Green's third identity the potential of the water, the same all round the axis, obeys
c φ = ∫(G ∂φ/∂n − φ ∂G/∂n) ds, with G that of a ring and panels on which φ and ∂φ/∂n are constant.  What the
walls and the floor send back is in it, and so is what the water remembers of its motion.
"""

import math

import numpy as np
from scipy.special import ellipe, ellipkm1

G = 9.81


def let_go(radius, tank, depth, lift, end, ratio=0.5, panel=0.06, dt=0.01):
    """Times, s, and heights of the sphere above its place at rest, m; ``lift`` is the height at the start.

    ``ratio`` is its density over that of the water, one half: it floats in the middle.
    """
    ends, free, body = _boundary(radius, tank, depth, panel)
    middle, along = ends.mean(axis=1), ends[:, 1] - ends[:, 0]
    length = np.hypot(*along.T)
    out = np.stack([along[:, 1], -along[:, 0]], axis=1) / length[:, None]
    single, double = _influences(ends, middle, along, out, length)
    # Known: φ on the surface, ∂φ/∂n elsewhere, V n_z on the body.
    unknown = double.copy()
    unknown[:, free] = -single[:, free]
    given = np.column_stack([-double[:, free], single[:, body] @ out[body, 1]])
    found = np.linalg.solve(unknown, given)
    lifted, pushed = found[free][:, :-1], found[free][:, -1]
    push = (out[:, 1] * 2.0 * math.pi * middle[:, 0] * length)[body]
    of_surface, added = push @ found[body][:, :-1], push @ found[body][:, -1]
    mass = ratio * 4.0 / 3.0 * math.pi * radius**3
    n = np.count_nonzero(free)

    def rate(y):
        potential, level, height, speed = y[:n], y[n:-2], y[-2], y[-1]
        buoyancy = -G * math.pi * (radius**2 * height - height**3 / 3.0)
        force = buoyancy + G * (of_surface @ level)
        return np.concatenate(
            [-G * level, lifted @ potential + pushed * speed, [speed, force / (mass + added)]]
        )

    y, heights = np.zeros(2 * n + 2), [lift]
    y[-2] = lift
    for _ in range(round(end / dt)):
        k1 = rate(y)
        k2 = rate(y + 0.5 * dt * k1)
        k3 = rate(y + 0.5 * dt * k2)
        y = y + dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + rate(y + dt * k3))
        heights.append(y[-2])
    return dt * np.arange(len(heights)), np.array(heights)


def _boundary(radius, tank, depth, panel):
    """Panels (n, 2, 2) anticlockwise around the water, and which are of the surface, which of the body."""
    turns = np.linspace(0.0, -0.5 * math.pi, max(round(1.5 * radius / panel), 12) + 1)
    round_it = radius * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    parts = [
        _line((0.0, -depth), (tank, -depth), 2.0 * panel),
        _line((tank, -depth), (tank, 0.0), 1.5 * panel),
        _line((tank, 0.0), (radius, 0.0), panel),
        np.stack([round_it[:-1], round_it[1:]], axis=1),
    ]
    which = np.repeat(np.arange(4), [len(one) for one in parts])
    return np.concatenate(parts), which == 2, which == 3


def _line(first, last, size):
    """Panels along a straight line."""
    first, last = np.array(first), np.array(last)
    t = np.linspace(0.0, 1.0, max(round(np.hypot(*(last - first)) / size), 1) + 1)[:, None]
    x = first + (last - first) * t
    return np.stack([x[:-1], x[1:]], axis=1)


def _influences(ends, middle, along, out, length):
    """∫G ds, and ∫∂G/∂n ds + c on the diagonal, of each panel at the middle of each (n, n)."""
    n = len(ends)
    single, double = np.zeros((n, n)), np.zeros((n, n))
    s, weight = np.polynomial.legendre.leggauss(8)
    for at, w in zip(s, weight):
        g, dg = _ring(middle[:, None], (middle + 0.5 * at * along)[None], out[None])
        single += 0.5 * w * length * g
        double += 0.5 * w * length * dg
    fine, w = np.polynomial.legendre.leggauss(16)
    u = 0.5 * (fine + 1.0)
    ends_twice = np.concatenate([-0.5 * u**2, 0.5 * u**2])  # denser where r = 0
    pieces = ((np.arange(8)[:, None] + u) / 8.0).ravel() - 0.5
    for i in range(n):
        for j, at, share in (
            (i, ends_twice, 0.5 * np.tile(u * w, 2)),
            *((j, pieces, np.tile(w, 8) / 16.0) for j in (i - 1, i + 1) if 0 <= j < n),
        ):
            g, dg = _ring(middle[i], middle[j] + at[:, None] * along[j], out[j])
            single[i, j], double[i, j] = length[j] * (share @ g), length[j] * (share @ dg)
    double[np.diag_indices(n)] -= double.sum(axis=1)  # φ = 1 everywhere has no ∂φ/∂n
    return single, double


def _ring(x, y, out):
    """∫1/r and ∂/∂n of it over the ring through ``y``, by complete elliptic integrals, times its radius."""
    r, z, a, b = x[..., 0], x[..., 1], y[..., 0], y[..., 1]
    far, near = (a + r) ** 2 + (b - z) ** 2, (a - r) ** 2 + (b - z) ** 2
    first, second = ellipkm1(near / far), ellipe(1.0 - near / far)
    by_a = 2.0 / (a * np.sqrt(far)) * ((r**2 - a**2 + (z - b) ** 2) / near * second - first)
    by_b = -4.0 * (b - z) * second / (np.sqrt(far) * near)
    return a * 4.0 * first / np.sqrt(far), a * (by_a * out[..., 0] + by_b * out[..., 1])
