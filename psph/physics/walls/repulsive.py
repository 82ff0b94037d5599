"""Walls whose particles repel the fluid."""

from typing import NamedTuple

from psph.acts import FLOWING
from psph.physics.facts import SOUND_OVER_SPEED, Facts
from psph.physics.walls.conditions import REPULSIVE

CORE = 1.0 / 3.0
"""Distance Δ over the spacing at which the repulsion would be infinite."""

NEAREST = 0.1
"""Floor of r − Δ over the spacing."""


class RepulsiveWall(NamedTuple):
    """The particles of a wall repel those of the fluid.

    a_i = K Σ_w x_iw/[r (r − Δ)] w(r/h), w(q) = (1.77/32) (1 + 5q/2 + 2q²) (2 − q)⁵ for q < 2, K = U²/2
    with the largest speed U to come: gH for a fall through H.
    Monaghan & Kajtar (2009), Comput. Phys. Commun. 180, 1811, eqs. (3.1), (4.2), for a wall particle as
    heavy as one of the fluid.  Their walls are one row with a third of the spacing Δ; here a wall stands on
    the lattice of the fluid, keeps their Δ = dx/3, r − Δ is at least 0.1 dx, and it fills the fluid's support
    at its rest density, without pressure.
    """

    acts = (*FLOWING, REPULSIVE)

    def in_scene(self, scene: Facts):
        """The repulsion that fits the scene's speed and spacing."""
        dx, speed = scene.spacing, scene.expected_speed or scene.sound_speed / SOUND_OVER_SPEED
        return Repulsion(0.5 * speed**2, CORE * dx, NEAREST * dx, 1.0 / scene.smoothing_length)


class Repulsion(NamedTuple):
    """The particles of a wall repel those of the fluid.

    The form of :class:`RepulsiveWall` in a scene: ``strength`` K in m²/s², ``core`` Δ and ``nearest`` in m,
    ``inverse_h`` in 1/m.
    """

    strength: float
    core: float
    nearest: float
    inverse_h: float

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        q = pair.r * self.inverse_h
        left = max(2.0 - q, 0.0)
        w = (1.77 / 32.0) * (1.0 + q * (2.5 + 2.0 * q)) * (left * left) * (left * left) * left
        return (
            self.strength
            * i.is_fluid
            * j.repulsive
            * w
            * pair.inverse_r
            / max(pair.r - self.core, self.nearest)
        )

    def linear(self, scene: Facts):
        """Linear theory knows no walls."""
        return None
