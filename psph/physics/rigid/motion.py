"""Rigid motions: parts one upon the other."""

from functools import reduce
from typing import Any, NamedTuple

from psph.fields import WALL
from psph.physics.rigid.pose import ZERO, Pose, combined, rotation
from psph.physics.rigid.schedule import ActingTime
from psph.vectors import Vector, add, scale

UPWARDS = (0.0, 0.0, 1.0)
"""The axis of all turns in 2D."""


class MotionPart(NamedTuple):
    """A displacement and a turn about a point that moves along.

    x = c + s(t) + R(θ(t)) (x₀ − c): ``law`` gives s and θ (psph.physics.rigid.laws) by the ``schedule``,
    ``center`` c in m, ``axis`` of the turn a unit vector.
    """

    law: Any
    schedule: ActingTime = ActingTime()
    center: Vector = ZERO
    axis: Vector = UPWARDS

    def pose(self, time: float) -> Pose:
        """Its pose at ``time``, s."""
        moved, speed, change = self.law.ways(self.schedule, time)
        return Pose(
            reference=self.center,
            translation=add(self.center, moved[:3]),
            rotation=rotation(self.axis, moved[3]),
            velocity=speed[:3],
            angular_velocity=scale(self.axis, speed[3]),
            acceleration=change[:3],
            angular_acceleration=scale(self.axis, change[3]),
        )


class Rigid(NamedTuple):
    """The wall moves as a whole, by the parts of its motion.

    x = pₙ(… p₂(p₁(x₀))): each of ``parts`` moves, in space, what the parts before it have made of the wall.
    A part has its ``pose`` at a time.
    """

    parts: tuple[Any, ...]

    kind = WALL

    @property
    def drift(self) -> Vector | None:
        """The velocity, m/s, with which it goes at all times without a turn, or None."""
        own = [part.law.drift(part.schedule) if hasattr(part.law, "drift") else None for part in self.parts]
        return None if None in own else tuple(map(sum, zip(*own)))

    def pose(self, time: float) -> Pose:
        """The pose of the whole at ``time``, s."""
        return reduce(combined, (part.pose(time) for part in self.parts))
