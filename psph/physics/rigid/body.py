"""What a rigid body is."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from psph.fields import WALL
from psph.physics.rigid.pose import Pose
from psph.vectors import Vector


class RigidBody(NamedTuple):
    """What a rigid body is, and what holds it.

    ``mass`` in kg (per m of depth in 2D); ``centre`` of mass at the start, m; ``inertia`` about it, kg
    m², nine numbers by rows; ``velocity`` in m/s and ``spin`` in rad/s at the start.  It is free to move
    along the axes of ``slides`` and to turn about the axes of ``turns``: none, one or three of them.
    ``pivot``, m: a point of the body that stays where it is, about which it turns.  Until the time
    ``held``, s, it stays, and then sets off with ``velocity`` and ``spin``.  ``motion`` has the pose of
    what is not free, None for a body that is held there.
    """

    name: str
    mass: float
    centre: Vector
    inertia: Vector
    velocity: Vector
    spin: Vector
    slides: tuple[bool, ...]
    turns: tuple[bool, ...]
    pivot: Vector | None = None
    held: float = 0.0
    motion: Any = None

    kind = WALL

    def pose(self, time: float) -> Pose:
        """Where what is not free has the body at ``time``, s."""
        return self.motion.pose(time) if self.motion else Pose(self.reference, self.reference)

    @property
    def reference(self) -> Vector:
        """The point about which it turns, m: its pivot, or its centre of mass."""
        return self.centre if self.pivot is None else self.pivot

    @property
    def goes_free(self) -> bool:
        """Whether forces say where it goes, at least along an axis."""
        return any((*self.slides, *self.turns))

    def starting_speed(self, lower: np.ndarray, upper: np.ndarray) -> float:
        """|V| + |ω| r at the start, m/s, with the corner of its box at r, m, farthest from what it turns
        about; ``lower`` and ``upper`` (dim,) are those of the box."""
        far = np.abs(np.array([lower, upper]) - self.reference[: len(lower)]).max(axis=0)
        return math.hypot(*self.velocity) + math.hypot(*self.spin) * math.hypot(*far)

    def fall(
        self, lowest: float, highest: float, spacing: float, gravity: Sequence[float]
    ) -> tuple[float, float] | None:
        """From where to where it may fall, heights of its particles in m, which reach from ``lowest`` to
        ``highest``: on a pivot as far as its highest, else all of it; None where it is held."""
        if any(slides and g for slides, g in zip(self.slides, gravity)):
            return lowest - spacing, lowest
        return (highest, lowest) if self.pivot is not None and any(self.turns) else None


class Borne(NamedTuple):
    """Particles that go with a rigid body of this ``name``, as another part of it; its :class:`RigidBody` is
    known once its sites are."""

    name: str
    carrier: Any = None

    kind = WALL

    def pose(self, time: float) -> Pose:
        """Where what is not free of the body has it at ``time``, s."""
        return self.carrier.pose(time)

    @property
    def motion(self):
        """That of the body which the case tells."""
        return self.carrier.motion

    @property
    def goes_free(self) -> bool:
        """As the body."""
        return self.carrier.goes_free
