"""How long a step in two passes may be beside a free surface: linear theory of the default scheme on a lattice.

A slab of the square or cubic lattice between two surfaces, at rest, in units of its spacing, of the speed of sound
and of its density, and waves along it.  Sound, diffusion and friction are matrices here, written out from the formulas
of docs/theory.md and not by psph's loops, and a step is what psph/simulation/midway.py says of it.
"""

import itertools
from typing import NamedTuple

import numpy as np
import pytest

from psph.case.schemes import SCHEMES, STABLE
from psph.moments import fastest_wave
from psph.simulation.midway import AT_A_SURFACE
from psph.smoothing import kernel

SET = SCHEMES[STABLE]
H = SET["space.smoothing"]
LEAST = SET["physics.gradient_correction"]
DELTA = SET["physics.fourth_order_diffusion"]
ALPHA, ROUGH = SET["physics.reconstructed_damping"].values()
LEAD = SET["time.lead"]
DISORDER = SET["physics.local_potential"]["threshold"]
ROWS = 10
WAVES = 2.0 * np.pi * np.arange(7) / 12.0
USUAL = 2.0 * SET["time.cfl"]
"""h/c: the step in two passes of a filled domain."""


class Wave(NamedTuple):
    """What velocities do to densities, densities to velocities, and both to themselves, in a wave: matrices."""

    rate: np.ndarray
    push: np.ndarray
    diffusion: np.ndarray
    friction: np.ndarray


def pairs(dim: int):
    """The rows i and j of a slab's pairs, their x_ij, and W′/r of it: ∇W = f x_ij."""
    away = np.array([*itertools.product(range(-2, 3), repeat=dim)], float)
    away = away[(away != 0.0).any(axis=1)]
    i = np.repeat(np.arange(ROWS), len(away))
    d = np.tile(away, (ROWS, 1))
    j = i - d[:, -1].astype(int)
    kept = (j >= 0) & (j < ROWS) & (np.linalg.norm(d, axis=1) < 2.0 * H)
    i, j, d = i[kept], j[kept], d[kept]
    alpha = {2: 7.0 / (4.0 * np.pi * H**2), 3: 21.0 / (16.0 * np.pi * H**3)}[dim]
    return i, j, d, -5.0 * alpha / H**2 * (1.0 - 0.5 * np.linalg.norm(d, axis=1) / H) ** 3


def summed(shape, rows, columns, values) -> np.ndarray:
    """A matrix of sums over pairs."""
    matrix = np.zeros(shape, complex)
    np.add.at(matrix, (rows, columns), values)
    return matrix


def wave(dim: int, k) -> Wave:
    """The wave with the wave vector ``k`` along the slab."""
    i, j, d, f = pairs(dim)
    m = np.zeros((ROWS, dim, dim))
    np.add.at(m, i, -f[:, None, None] * d[:, :, None] * d[:, None, :])
    size = np.linalg.det(m)[:, None, None]
    less = (size * np.linalg.inv(m) - size * np.eye(dim)) / np.maximum(size, LEAST)
    half = np.minimum((less**2).sum((1, 2)) / (2.0 * DISORDER**2), 0.5)
    rough = half[i] + half[j]
    own, other = (f[:, None] * np.einsum("pab,pb->pa", less[n] + np.eye(dim), d) for n in (i, j))
    phase = np.exp(-1j * d[:, :-1] @ np.asarray(k))
    nv, n = dim * ROWS, ROWS
    rate, push, slope = np.zeros((n, nv), complex), np.zeros((nv, n), complex), np.zeros((nv, n), complex)
    spread = 2.0 * DELTA * H * f
    diffusion = summed((n, n), i, i, spread) - summed((n, n), i, j, spread * phase)
    braked = (ALPHA + (ROUGH - ALPHA) * rough) * H * f / (d**2).sum(1)
    friction = np.zeros((nv, nv), complex)
    for a in range(dim):
        u, w = dim * i + a, dim * j + a
        rate += summed((n, nv), i, u, own[:, a]) - summed((n, nv), i, w, own[:, a] * phase)
        push -= summed((nv, n), u, i, own[:, a]) + summed((nv, n), u, j, other[:, a] * phase)
        slope -= summed((nv, n), u, i, own[:, a]) - summed((nv, n), u, j, own[:, a] * phase)
        for b in range(dim):
            along = braked * d[:, a] * d[:, b]
            friction += summed((nv, nv), u, dim * i + b, along)
            friction -= summed((nv, nv), u, dim * j + b, along * phase)
    for a in range(dim):
        smooth = 0.5 * spread * (1.0 - rough) * d[:, a]
        both = summed((n, n), i, i, smooth) + summed((n, n), i, j, smooth * phase)
        diffusion -= both @ slope[a::dim]
    return Wave(rate, push, diffusion, friction)


def growth(waves: list[Wave], step: float, ahead: float) -> float:
    """The largest amplification of ``waves`` in a step of ``step`` h/c whose friction reads v½ + ``ahead`` Δt a."""
    found, dt = [], step * H
    for one in waves:
        nv, n = one.push.shape
        v, a, rho = slice(nv), slice(nv, 2 * nv), slice(2 * nv, None)
        now = np.eye(2 * nv + n)
        risen = dt * (one.rate @ now[v] + one.diffusion @ now[rho])
        pushed = one.push @ (now[rho] + risen + LEAD * risen) + one.friction @ (now[v] + ahead * dt * now[a])
        then = np.vstack([now[v] + dt * pushed, pushed, now[rho] + risen])
        found.append(np.abs(np.linalg.eigvals(then)).max())
    return max(found)


def longest(waves: list[Wave], ahead: float) -> float:
    """The longest step of h/c in which none of the ``waves`` grows."""
    low, high = 1.0, 1.5
    while high - low > 1e-3:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if growth(waves, middle, ahead) > 1.0 + 1e-6 else (middle, high)
    return low


@pytest.mark.parametrize("dim, at_middle, predicted", [(2, 1.173, 1.119), (3, 1.209, 1.167)])
def test_a_surface_bears_longer_steps_where_friction_reads_the_middle(dim, at_middle, predicted):
    """Corrected gradients make sound a quarter faster there than in the lattice, and diffusion and friction take the
    rest.  The control: with friction by predicted velocities a step bears less of what it has to."""
    waves = [wave(dim, k) for k in itertools.product(WAVES, repeat=dim - 1)]
    fastest = max(np.sqrt(np.abs(np.linalg.eigvals(one.push @ one.rate)).max()) for one in waves)
    inside = fastest_wave(kernel(SET["space.kernel"], H, dim), 1.0, dim)
    assert 1.2 * inside < fastest < 1.35 * inside
    assert longest(waves, 0.0) == pytest.approx(at_middle, abs=0.003)
    assert longest(waves, 0.5) == pytest.approx(predicted, abs=0.003)
    assert 1.06 * AT_A_SURFACE * USUAL < longest(waves, 0.0)
