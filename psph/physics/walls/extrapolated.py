"""Walls whose pressure follows from that of the fluid before them."""

from typing import Any, NamedTuple

from psph.acts import FLOWING
from psph.engine.jit import call_by_type
from psph.fields import PRESSURE
from psph.physics.facts import Facts
from psph.physics.motion import is_prescribed
from psph.physics.walls.conditions import EXTRAPOLATED
from psph.physics.walls.slip import NO_FLUID
from psph.vectors import along, dot


class Floating(NamedTuple):
    """All before walls is fluid: its pressure grows by its weight."""

    def share(self, j):
        """Of its weight in the growth of its pressure."""
        return 1.0


class Leaning(NamedTuple):
    """Before walls is soil: across gravity it presses by K₀, and its pressure is the mean of its stresses."""

    def share(self, j):
        """Of its weight in the growth of its pressure."""
        return (1.0 + 2.0 * j.rest_coefficient) / 3.0


share = call_by_type("share")
"""(leaning, j) → the share of its weight by which the pressure of j grows downwards."""


class ExtrapolatedWall(NamedTuple):
    """A wall bears the pressure of the fluid before it, continued into the wall by the weight of the fluid.

    p_w = Σ_f (p_f + ρ_f g·x_wf) W_wf / Σ_f W_wf over the fluid, 0 where none is in reach, and ρ_w = ρ(p_w)
    by the wall's equation of state; of a soil (1 + 2K₀)/3 of its weight, by which its mean stress grows, and
    the rest of its stress in proportion.  Adami, Hu & Adams (2012), J. Comput. Phys. 231, 7057, eqs. (27) and
    (28); of a wall that moves g − a_w stands for g.  It is gathered before the forces, from the pressures of
    the same step: one of the step before would feed the waves that a wall reflects.
    """

    acts = (*FLOWING, EXTRAPOLATED)

    writes = PRESSURE
    tells = "extrapolated"

    def in_scene(self, scene: Facts):
        """The form that knows gravity, and where such a wall or the frame moves its acceleration too."""
        gravity = tuple(g or None for g in scene.gravity)
        leaning = Leaning() if scene.strengths else Floating()
        moving = any(one.extrapolated and is_prescribed(one.motion) for one in scene.species)
        if moving or scene.frame is not None:
            return ExtrapolatedInMotion(gravity, leaning)
        return ExtrapolatedUnderGravity(gravity, leaning)


def _has_sum(self, i):
    """Above 0 in such a wall: there are no sums for other particles."""
    return i.extrapolated


def _start(self, i):
    """No fluid yet: Σ W and Σ p W."""
    return 0.0, 0.0


def _finish_value(self, total, i, kernel):
    """p_w in such a wall, Pa; the pressure that it has in all other particles."""
    return i.pressure + i.extrapolated * (total[1] / max(total[0], NO_FLUID) - i.pressure)


class ExtrapolatedUnderGravity(NamedTuple):
    """A wall bears the pressure of the fluid before it, continued into the wall by the weight of the fluid.

    The form of :class:`ExtrapolatedWall` in a scene; ``gravity`` in m/s², None on an axis without.
    """

    gravity: tuple[float | None, ...]
    leaning: Any = Floating()

    writes = PRESSURE
    """In other particles it stays as it is."""
    tells = "extrapolated"
    """Particles with a 1 here take their density from this pressure."""

    def gather(self, total, i, j, pair):
        """Take a fluid neighbour j into both."""
        w = j.is_fluid * pair.w
        weight = share(self.leaning, j) * along(pair.x_ij, self.gravity)
        p = j.pressure + weight / j.specific_volume
        return total[0] + w, total[1] + p * w

    def linear(self, scene: Facts):
        """Linear theory includes it as it is."""
        return None

    has_sum, start, finish_value = _has_sum, _start, _finish_value


class ExtrapolatedInMotion(NamedTuple):
    """A wall bears the pressure of the fluid before it, continued into the wall by weight and acceleration.

    The form of :class:`ExtrapolatedWall` where such a wall moves, or the frame of reference: in the place of
    g stands g − a_w of the wall, with what the frame adds to g.
    """

    gravity: tuple[float | None, ...]
    leaning: Any = Floating()

    writes = PRESSURE
    tells = "extrapolated"

    def gather(self, total, i, j, pair):
        """Take a fluid neighbour j into both."""
        w = j.is_fluid * pair.w
        pull = along(pair.x_ij, self.gravity) + dot(pair.x_ij, i.apparent)
        weight = share(self.leaning, j) * pull
        return total[0] + w, total[1] + (j.pressure + weight / j.specific_volume) * w

    has_sum, start, finish_value = _has_sum, _start, _finish_value
