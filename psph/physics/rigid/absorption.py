"""Paddles that take up waves that come back, by the level of the water at their face."""

from dataclasses import dataclass
from typing import Any, NamedTuple

from psph.fields import WALL
from psph.physics.rigid.motion import MotionPart
from psph.physics.rigid.pose import Pose, combined
from psph.vectors import Vector, scale


class Absorption(NamedTuple):
    """How a paddle answers to waves that it does not make.

    Where the water at its face is higher than its own waves have it, by e, a wave comes back.  The paddle
    takes it up by going with the water, at the speed −γe beside that of its stroke (Schäffer & Klopman
    2000, J. Waterw. Port Coast. Ocean Eng. 126, 88), with γ = ω/(H/S) for waves of frequency ω, which is
    √(g/h) for long ones.  Of others the part |1 − α|/(1 + α) goes back once more, α = γ (H/S)/ω.
    ``wanted`` has the elevation η of its own waves, ``gain`` is γ, 1/s.  Over the ``memory``, s, it forgets a
    level that stays, and comes back to its stroke, from which it is never farther than ``reach``, m.
    """

    wanted: Any
    gain: float
    memory: float
    reach: float


class Absorbing(NamedTuple):
    """The wall is a piston that takes up waves that come back.

    ``pose`` is that of its stroke alone, its ``part`` of a motion; ``heading`` is the way of its waves, a
    unit vector.  How far it is from there is its :class:`Correction`.
    """

    part: MotionPart
    heading: Vector
    absorption: Absorption

    kind = WALL

    def pose(self, time: float) -> Pose:
        """The pose that its stroke has at ``time``, s."""
        return self.part.pose(time)

    def corrected(self, time: float, correction: "Correction") -> Pose:
        """The pose with its correction."""
        ways = (correction.shift, correction.speed, correction.change)
        shift, speed, change = (scale(self.heading, way) for way in ways)
        return combined(self.pose(time), Pose(translation=shift, velocity=speed, acceleration=change))

    def surplus(self, time: float, distance: float, level: float) -> float:
        """e, m, of a ``level`` above that at rest, ``distance`` m from the paddle's place at the start."""
        return level - self.absorption.wanted.elevation(self.part.schedule, time, distance)


@dataclass
class Correction:
    """What a paddle does beside its stroke: its ``shift``, m, ``speed``, m/s, and ``change`` of that, m/s².

    x ← x + Δt v with v = −γ (e − ē) − x/τ from the surplus e of the level at the end of the step before,
    and dē/dt = (e − ē)/τ: ``due`` is v of the next step, ``lasting`` ē, m.
    """

    shift: float = 0.0
    speed: float = 0.0
    change: float = 0.0
    due: float = 0.0
    lasting: float = 0.0

    def advance(self, absorption: Absorption, dt: float) -> None:
        """A step of ``dt`` s."""
        reach = absorption.reach
        shift = min(max(self.shift + dt * self.due, -reach), reach)
        speed = (shift - self.shift) / dt
        self.shift, self.speed, self.change = shift, speed, (speed - self.speed) / dt

    def answer(self, absorption: Absorption, surplus: float, dt: float) -> None:
        """To a surplus, m, at the end of a step of ``dt`` s."""
        self.lasting += dt / absorption.memory * (surplus - self.lasting)
        self.due = -absorption.gain * (surplus - self.lasting) - self.shift / absorption.memory
