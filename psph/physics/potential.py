"""A force between neighbours that keeps their order and bears no pressure."""

from itertools import product
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from psph.smoothing import WendlandC2

NEAR, FAR = 0.8, 1.17
"""Ranges of the repelling and of the attracting part, as smoothing lengths in spacings."""

NEAR_NORM = (2.0, 10.0 / np.pi, 15.0 / np.pi)
"""Makes the integral of the repelling part one in 1D, 2D and 3D, times range^-d."""

SOUND_OVER_SPEED = 10.0
"""Speed of sound over the largest speed that a weakly compressible flow should have."""


class PairPotential(NamedTuple):
    """Near neighbours repel, farther ones attract: pairs keep their distance, at no pressure.

    a_i = −(2K/ρ₀²) Σ_j m_j ψ′(r) x_ij/r, ψ = S − κL, S = (1 − r/1.6dx)³₊, L = Wendland C2 with
    h = 1.17 dx, both with integral 1; κ makes the virial Σ r ψ′ of the starting lattice zero.
    K = f ρ₀ (c/10)² is constant: a repulsion that follows the local pressure pumps energy (as the
    artificial stress of Monaghan 2000, J. Comput. Phys. 159, 290, does).  A potential, so momentum,
    angular momentum and energy are conserved.
    """

    strength: Annotated[
        float,
        Field(
            ge=0, description="f: K over ρ₀U², U = c/10 the largest speed",
            json_schema_extra={"unit": "1"},
        ),
    ] = 0.02

    def in_scene(self, scene):
        """The potential of the scene's lattice."""
        return neutral_potential(self.strength, scene.spacing, scene.dimensions)


class NeutralPotential(NamedTuple):
    """Near neighbours repel, farther ones attract: see :class:`PairPotential`.

    ``near``, ``far``: inverse ranges, 1/m; ``repulsion``, ``attraction``: coefficients of S′/r and
    L′/r, times 2K/(ρ₀c²).
    """

    near: float
    far: float
    repulsion: float
    attraction: float

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        r = np.sqrt(pair.r2)
        a, b = max(1.0 - r * self.near, 0.0), max(1.0 - r * self.far, 0.0)
        force = self.repulsion * (a * a) / r - self.attraction * (b * b * b)
        c = i.sound_speed
        return c * c / i.rest_density * j.mass * force


def neutral_potential(strength: float, dx: float, dimensions: int) -> NeutralPotential:
    """The potential whose virial vanishes on the row, square or cube lattice of spacing dx, m."""
    range_near, h_far = 2.0 * NEAR * dx, FAR * dx
    peak = NEAR_NORM[dimensions - 1] / range_near**dimensions
    wendland = WendlandC2.norm[dimensions - 1] / h_far**dimensions
    scale = 2.0 * strength / SOUND_OVER_SPEED**2
    whole = NeutralPotential(
        near=1.0 / range_near, far=0.5 / h_far, repulsion=scale * 3.0 * peak / range_near,
        attraction=scale * 5.0 * wendland / h_far**2,
    )
    reach = range(-3, 4)
    sites = (k for k in product(reach, repeat=dimensions) if any(k))
    r = np.array([np.hypot.reduce(k) for k in sites]) * dx
    a, b = np.maximum(1.0 - r * whole.near, 0.0), np.maximum(1.0 - r * whole.far, 0.0)
    repelling, attracting = whole.repulsion * r @ a**2, whole.attraction * r**2 @ b**3
    return whole._replace(attraction=whole.attraction * float(repelling / attracting))
