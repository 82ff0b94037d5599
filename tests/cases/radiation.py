"""Small motions of a floating box in 2D by the linear theory of waves: added mass, damping and period.

The potential of the water around a box that swings with exp(−iωt) obeys φ_n = ω²φ/g at the surface, φ_n = ikφ far
away on both sides, where waves leave, and φ_n = n_x, n_y or (x × n)_z on the box. By Green's third identity, πφ = ∫(φ ∂ln
r/∂n − ln r φ_n) ds, with panels on which φ and φ_n are constant.
"""

import math

import numpy as np

from psph.theory.water_waves import wave_number

G = 9.81


def swing(beam, draught, depth, inertia, stiffness, rolls=False, panel=0.02) -> tuple[float, float]:
    """Period T, s, of a damped swing and the share of the critical damping.

    ``inertia`` and ``stiffness`` are over the density of water: heaving M and gB, rolling about the middle of
    the box's waterline.  Solves ω² (I + A(ω)) = C by repetition.
    """
    w = math.sqrt(stiffness / (2.0 * inertia))
    for _ in range(10):
        added, damping = _radiated(w, beam, draught, depth, rolls, panel)
        w = math.sqrt(stiffness / (inertia + added))
    share = damping / (2.0 * math.sqrt(stiffness * (inertia + added)))
    return 2.0 * math.pi / (w * math.sqrt(1.0 - share**2)), share


def responses(w, beam, draught, depth, mass, stiffness, panel=0.02) -> np.ndarray:
    """Complex amplitudes (3,) of sway, m, heave, m, and roll, rad, in waves along x with η = Re exp(i(kx − ωt)) m
    at the middle of the box.

    ``mass`` (3,) and ``stiffness`` (3, 3) are over the density of water, about the middle of the waterline:
    [−ω²(M + A) − iωB + C] ξ = X with the force X of waves that the box at rest scatters.
    """
    force, scattered = forces(w, beam, draught, depth, panel)
    return np.linalg.solve(stiffness - w * w * np.diag(mass) + 1j * w * force, scattered)


def _radiated(w, beam, draught, depth, rolls, panel):
    """Added mass and damping over the density of water."""
    force = forces(w, beam, draught, depth, panel)[0]
    one = force[2, 2] if rolls else force[1, 1]
    return one.imag / w, -one.real


def forces(w, beam, draught, depth, panel):
    """What the water pushes with, over its density, along x and y and about the middle of the waterline: at
    unit speeds of the box (3, 3), iωA − B, and on the box at rest in waves (3,)."""
    far, half = 8.0 * depth, 0.5 * beam
    sides = (  # around the water, anticlockwise
        ([(-far, -depth), (far, -depth)], 2.0 * panel),
        ([(far, -depth), (far, 0.0)], 2.0 * panel),
        ([(far, 0.0), (half, 0.0)], panel),
        ([(half, 0.0), (half, -draught), (-half, -draught), (-half, 0.0)], 0.25 * panel),
        ([(-half, 0.0), (-far, 0.0)], panel),
        ([(-far, 0.0), (-far, -depth)], 2.0 * panel),
    )
    parts = [panels(corners, size) for corners, size in sides]
    which = np.repeat(np.arange(len(parts)), [len(one) for one in parts])
    ends = np.concatenate(parts)
    middle, along = ends.mean(axis=1), ends[:, 1] - ends[:, 0]
    length = np.hypot(*along.T)
    along /= length[:, None]
    out = np.stack([along[:, 1], -along[:, 0]], axis=1)
    box = which == 3
    turning = middle[:, 0] * out[:, 1] - middle[:, 1] * out[:, 0]
    pushed = np.where(box, [out[:, 0], out[:, 1], turning], 0.0).T
    k = wave_number(w, depth, G)
    share = np.zeros(len(ends), complex)  # φ_n/φ
    share[(which == 2) | (which == 4)] = w * w / G
    share[(which == 1) | (which == 5)] = 1j * k
    size = -1j * G / w / math.cosh(k * depth) * np.exp(1j * k * middle[:, 0])
    high = k * (middle[:, 1] + depth)
    wave = size * np.cosh(high)
    slope = k * size * (1j * np.cosh(high) * out[:, 0] + np.sinh(high) * out[:, 1])
    doubled, single = influences(middle, ends, along, out, length)
    given = np.column_stack([pushed, np.where(box, -slope, 0.0)])
    potential = np.linalg.solve(doubled - single * share, single @ given)
    potential[:, 3] += wave
    force = 1j * w * (pushed * length[:, None]).T @ potential
    return force[:, :3], force[:, 3]


def panels(corners, size):
    """Ends (n, 2, 2) of panels along a polygon."""
    found = []
    for first, last in zip(map(np.array, corners), map(np.array, corners[1:])):
        t = np.linspace(0.0, 1.0, max(round(np.hypot(*(last - first)) / size), 1) + 1)[:, None]
        x = first + (last - first) * t
        found.append(np.stack([x[:-1], x[1:]], axis=1))
    return np.concatenate(found)


def influences(middle, ends, along, out, length):
    """∫∂ln r/∂n ds − π for the panel itself, and ∫ln r ds, of each panel at the middle of each."""
    to = ends[None] - middle[:, None, None]
    s, d = np.einsum("pqed,qd->epq", to, along), np.einsum("pqd,qd->pq", to[:, :, 0], out)
    seen = np.arctan2((s[1] - s[0]) * d, d * d + s[0] * s[1])
    np.fill_diagonal(seen, 0.0)
    logs = [one * np.log(np.maximum(np.hypot(one, d), 1e-300)) for one in s]
    single = logs[1] - logs[0] - (s[1] - s[0]) + d * seen
    np.fill_diagonal(single, length * (np.log(0.5 * length) - 1.0))
    return seen - math.pi * np.eye(len(middle)), single
