"""How particles of elastic solids move (psph.physics.motion): freely, in a fluid, or in a clamp."""

from typing import Any, NamedTuple

from psph.fields import SOLID


class Elastic(NamedTuple):
    """Particles of a solid, whose forces come from their neighbours of the start."""

    kind = SOLID
    goes_free = True
    is_free = True


class Immersed(NamedTuple):
    """Particles of a solid in a fluid, moved in steps of its own: to the fluid a wall that moves."""

    kind = SOLID
    goes_free = True


class Clamped(NamedTuple):
    """Particles of a solid that stay where they are."""

    kind = SOLID


class Riding(NamedTuple):
    """Particles of a solid that go with a rigid body of this ``name``, which bears what pulls on them; its
    :class:`psph.physics.rigid.body.RigidBody` is known once its sites are."""

    name: str
    carrier: Any = None

    kind = SOLID

    def pose(self, time: float):
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


class MovingClamp(NamedTuple):
    """Particles of a solid that move as a whole by a rigid ``motion``, as they are told."""

    motion: Any

    kind = SOLID

    def pose(self, time: float):
        """The pose of the whole at ``time``, s."""
        return self.motion.pose(time)
