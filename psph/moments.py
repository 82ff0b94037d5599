"""Sums of a smoothing kernel over the row, square or cube lattice on which the particles start."""

import math
from functools import lru_cache
from itertools import accumulate, product

import numpy as np

from psph.smoothing import Normalised


def normalised(kernel, spacing: float, dimensions: int) -> Normalised:
    """``kernel`` normalised on the lattice of ``spacing``, m."""
    return Normalised(kernel, -dimensions / first_moment(kernel, spacing, dimensions))


def first_moment(kernel, spacing: float, dimensions: int) -> float:
    """Σ dx^d r W′ over the lattice of ``spacing`` m; about −dimensions."""
    return moments_below_a_surface(kernel, spacing, dimensions)[-1]


def moments_below_a_surface(kernel, spacing: float, dimensions: int) -> list[float]:
    """Σ dx^d r W′ over the part of that lattice that the first, second ... row below a plane surface has."""
    rows = [0.0] * (_reach(kernel, spacing) + 1)
    for *level, height in sites_around(kernel, spacing, dimensions):
        r = math.hypot(*level, height) * spacing
        rows[max(height, 0)] += r * kernel.dw(r) * spacing**dimensions
    return [*map(float, accumulate(rows))]


def seam_shares(kernel, spacing: float, dimensions: int) -> list[float]:
    """What two halves of a plane wall exchange along it over what presses them: k_n, n = 1, 2 ... rows.

    Under the pressure p particles of one half and fluid before the other push each other apart with
    2p Σ ab (−∂W/∂b) a length of the seam, over the sites a spacings across and b > 0 along; n rows below the
    face are pressed with 2p Σ min(a, n) (−∂W/∂a).  The first over the second.
    """
    if dimensions == 1:
        return []
    along, pressed = 0.0, [0.0] * _reach(kernel, spacing)
    for *level, height in sites_around(kernel, spacing, dimensions):
        if height > 0:
            distance = math.hypot(*level, height)
            slope = -kernel.dw(distance * spacing) / distance
            along += height * max(level[0], 0) * level[0] * slope
            for row in range(height):
                pressed[row] += height * slope
    return [along / total for total in accumulate(pressed)]


HALVED_TO = 1e-9
"""How near a smoothing length comes to its own, over that of the bulk."""


@lru_cache
def fastest_smoothing(kernel, spacing: float, dimensions: int) -> float:
    """The largest Σ dx^d (−W′/r) (1 − cos k·x) over the same lattice and all wave vectors k, 1/m².

    A field f that changes at 2ν Σ_j V_j (f_i − f_j) W′/r loses the wave it loses fastest at 2ν times this.
    """
    sites, weights, waves = _waves(kernel, spacing, dimensions)
    return float((weights * (1.0 - np.cos(waves @ sites.T))).sum(axis=1).max())


@lru_cache
def fastest_braking(kernel, spacing: float, dimensions: int) -> float:
    """The largest eigenvalue of Σ dx^d (−W′/r) r̂ r̂ᵀ (1 − cos k·x) over the same waves, 1/m².

    Velocities that change at ν Σ_j V_j (u_ij·r̂) r̂ W′/r lose the wave they lose fastest at ν times this.
    """
    sites, weights, waves = _waves(kernel, spacing, dimensions)
    along = sites / np.linalg.norm(sites, axis=1)[:, None]
    sums = np.einsum("kr,ri,rj->kij", weights * (1.0 - np.cos(waves @ sites.T)), along, along)
    return float(np.linalg.eigvalsh(sums).max())


@lru_cache
def fastest_wave(kernel, spacing: float, dimensions: int) -> float:
    """The largest |Σ dx^d ∇W sin k·x| over the same waves, 1/m: over c the frequency of the fastest sound."""
    sites, weights, waves = _waves(kernel, spacing, dimensions)
    gradients = np.sin(waves @ sites.T) @ (weights[:, None] * sites * spacing)
    return float(np.linalg.norm(gradients, axis=1).max())


WAVES = 13
"""Wave numbers along an axis, from 0 to the shortest wave."""


def _waves(kernel, spacing: float, dimensions: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Sites (n, d) in spacings, their dx^d (−W′/r) (n,), 1/m², and wave vectors (waves, d), rad a spacing."""
    sites = np.array([*sites_around(kernel, spacing, dimensions)], float)
    radii = np.linalg.norm(sites, axis=1) * spacing
    weights = np.array([-kernel.dw(r) / r for r in radii]) * spacing**dimensions
    return sites, weights, np.array([*product(np.linspace(0.0, np.pi, WAVES), repeat=dimensions)])


def sites_around(kernel, spacing: float, dimensions: int):
    """Where the neighbours of a particle on a lattice are, in spacings."""
    reach = _reach(kernel, spacing)
    return (site for site in product(range(-reach, reach + 1), repeat=dimensions) if any(site))


def _reach(kernel, spacing: float) -> int:
    return math.ceil(kernel.support / (kernel.inverse_h * spacing))


@lru_cache
def length_at_a_face(kernel, smoothing: float, dimensions: int) -> float:
    """h/dx of a particle in the plane face of a lattice that has but half of its neighbours: where
    h^d Σ_j W(r_ij, h), itself included, is ``smoothing``^d; ``kernel`` with h = 1 m.
    """
    fewest, most = smoothing, 2.0 * smoothing  # in one dimension a half has twice the length
    reach = math.ceil(kernel.support * most)
    sites = product(range(reach + 1), *(range(-reach, reach + 1) for _ in range(1, dimensions)))
    away = np.array([math.hypot(*site) for site in sites])
    while most - fewest > HALVED_TO * smoothing:
        h = 0.5 * (fewest + most)
        seen = away[away < kernel.support * h]
        few = sum(kernel.w(r / h) for r in seen.tolist()) < smoothing**dimensions
        fewest, most = (h, most) if few else (fewest, h)
    return fewest
