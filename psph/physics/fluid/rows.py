"""What the rows of a lattice bear below a surface, at rest under their own weight."""

from typing import Any

import numpy as np

from psph.moments import sites_around
from psph.physics.facts import Facts

ROWS = 24
"""Rows below a surface that are solved for: below the fifth they bear their depth to 0.1 %."""

BELOW = 6
"""Rows that are told: those below bear their depth."""


def pressures_of_rows(scene: Facts) -> np.ndarray:
    """p/(ρ g dx) at the depths 0, ½, 1½ … dx below a surface of a ``scene``'s fluid at rest (BELOW + 1,).

    Corrected gradients of the symmetric pressure fade at a surface, and the first rows of a lattice bear
    less than ρ g times their depth there: by 0.12, 0.12 and 0.05 of ρ g dx in 2D, whatever dx is.  Two
    spacings side by side differ by as much, though nothing moves.  Empty where the scene has no such
    gradients, no weight or no surface.

    The balance Σ_j V (p_i L_i + p_j L_j) ∇W = ρ g of rows makes that alternate (0.07, 0.20, 0.00); what
    damps the noise of the density takes the mean over neighbouring rows, which keeps the sum.  Still water
    has these 0.11, 0.12, 0.05 within 0.02 from 0.1 s to 8 s, at h/dx 1.2 and 1.4.
    """
    physics = scene.physics
    corrected = physics.gradient_correction is not None and physics.pressure_gradient == "symmetric"
    if not (corrected and any(scene.gravity) and scene.has_free_surface):
        return np.zeros(0)
    push, along, across = _sums_of_rows(scene.kernel, scene.spacing, scene.dimensions)
    missing = _depths(ROWS) - _balanced(push, _corrections(along, across, scene))
    mean = np.convolve(np.append(missing[0], missing), [0.25, 0.5, 0.25], mode="valid")
    found = np.append(0.0, _depths(BELOW) - np.append(mean[: BELOW - 1], 0.0))
    return found if (np.diff(found) > 0.0).all() else np.zeros(0)


def _depths(rows: int) -> np.ndarray:
    return np.arange(rows) + 0.5


def _sums_of_rows(kernel: Any, spacing: float, dimensions: int) -> np.ndarray:
    """Of the row n spacings below a particle, or above it for n < 0, for n from −reach on: the sums of
    −dx^d W′/r times x, x² and y², x the way down and y across (3, rows), in spacings."""
    sites = np.array([*sites_around(kernel, spacing, dimensions)])
    distance = np.linalg.norm(sites, axis=1)
    share = np.array([-kernel.dw(r * spacing) / r for r in distance]) * spacing ** (dimensions + 1)
    down, across = sites[:, -1], sites[:, 0] if dimensions > 1 else np.zeros(len(sites))
    row = down - down.min()
    return np.stack([np.bincount(row, share * part) for part in (down, down**2, across**2)])


def _corrections(along: np.ndarray, across: np.ndarray, scene: Facts) -> np.ndarray:
    """L of each row along the depth, as :class:`~psph.physics.fluid.correction.GradientCorrection` has."""
    reach = len(along) // 2
    there = [np.arange(-reach, reach + 1) >= -row for row in range(ROWS)]
    own = np.array([along[rows].sum() for rows in there])
    rest = np.array([across[rows].sum() for rows in there]) ** (scene.dimensions - 1)
    return 1.0 + (rest - own * rest) / np.maximum(own * rest, scene.physics.gradient_correction.least)


def _balanced(push: np.ndarray, corrections: np.ndarray) -> np.ndarray:
    """p/(ρ g dx) of the first ROWS rows where all forces are in balance; those below bear their depth."""
    reach = len(push) // 2
    square, right = np.zeros((ROWS, ROWS)), np.ones(ROWS)
    for row in range(ROWS):
        for other in range(max(row - reach, 0), row + reach + 1):
            share = push[other - row + reach]
            square[row, row] += share * corrections[row]
            if other < ROWS:
                square[row, other] += share * corrections[other]
            else:
                right[row] -= share * corrections[-1] * (other + 0.5)
    return np.linalg.solve(square, right)
