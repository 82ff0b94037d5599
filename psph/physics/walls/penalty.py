"""Walls that push back what comes nearer than half a spacing."""

import math
from itertools import product
from typing import NamedTuple

from psph.acts import FLOWING
from psph.formula import where
from psph.physics.facts import Facts
from psph.physics.walls.conditions import PENALTY
from psph.physics.walls.slip import NO_FLUID
from psph.smoothing import weight
from psph.vectors import add, dot, scale, zero_like

LAYERS = 6
"""Of a flat wall, and spacings to each side, for the distance of a fluid at rest: more than any support."""


ONSET = 0.01
"""Depth over the spacing at which the whole damper acts.  With all of it from the first touch, rounding would
decide what brakes a particle that stands at d₀, as a lattice beside a wall does."""


STABLE = 0.7
"""ζΔt stays below."""


class PenaltyWall(NamedTuple):
    """A wall pushes back, along its normal, the fluid nearer than half a spacing to its face.

    a_i = [k (d₀ − d) − min((d₀ − d)/δ, 1) ζ u·n] n where d < d₀, δ = dx/100, D_i = Σ_w W_iw x_iw/Σ_w W_iw
    over the wall, d = |D|, n = D/d, u the mean of u_iw with the same weights; d₀ is d half a spacing before a
    flat wall, k = (c/dx)², ζ = c/dx: a spring with half of the damping that would end its swing.  psph's own
    form of a penalty: stiffness by depth along the normal, and a damper that sets in as the spring does.  The
    wall fills the fluid's support at its rest density, without pressure.
    """

    acts = (*FLOWING, PENALTY)

    def in_scene(self, scene: Facts):
        """The spring that fits the scene's sound, spacing and kernel."""
        rate = scene.sound_speed / scene.spacing
        rest = mean_distance(scene.kernel, scene.spacing, scene.dimensions)
        return Spring(rate * rate, rate, rest, ONSET * scene.spacing)


class Spring(NamedTuple):
    """A wall pushes back, along its normal, the fluid nearer than half a spacing to its face.

    The form of :class:`PenaltyWall` in a scene: ``stiffness`` k in 1/s², ``damping`` ζ in 1/s, ``rest`` d₀
    and ``onset`` δ in m.
    """

    stiffness: float
    damping: float
    rest: float
    onset: float

    def start(self, i):
        """No wall yet: Σ W, Σ W x and Σ W u."""
        return 0.0, zero_like(i.position), zero_like(i.position)

    def gather(self, total, i, j, pair):
        """Take a wall neighbour j into all three."""
        w = j.penalty * pair.w
        return total[0] + w, add(total[1], scale(pair.x_ij, w)), add(total[2], scale(pair.u_ij, w))

    def finish_acceleration(self, total, i):
        """[k (d₀ − d) − ζ u·n] n in the fluid where d < d₀, m/s²."""
        share = 1.0 / max(total[0], NO_FLUID)
        away, motion = scale(total[1], share), scale(total[2], share)
        d = max(math.sqrt(dot(away, away)), NO_FLUID)
        depth = where(total[0] > 0.0, max(self.rest - d, 0.0), 0.0) * i.is_fluid
        brake = min(depth / self.onset, 1.0) * (self.damping * dot(motion, away) / d)
        return scale(away, (self.stiffness * depth - brake) / d)

    def longest_step(self, scene):
        """Δt ≤ 0.7/ζ, s: a velocity that is predicted to first order is stable up to 1/ζ."""
        return STABLE / self.damping

    def linear(self, scene: Facts):
        """Linear theory knows no walls."""
        return None


def mean_distance(kernel, dx: float, dimensions: int) -> float:
    """|Σ W x|/Σ W half a spacing dx, m, before a flat wall on the lattice, m."""
    beside = [n * dx for n in range(-LAYERS, LAYERS + 1)]
    behind = [(n + 1) * dx for n in range(LAYERS)]
    weights = distance = 0.0
    for depth, *sides in product(behind, *[beside] * (dimensions - 1)):
        w = float(weight(kernel, math.hypot(depth, *sides)))
        weights, distance = weights + w, distance + w * depth
    return distance / weights
