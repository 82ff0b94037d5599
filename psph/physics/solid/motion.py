"""How particles of elastic solids move (psph.physics.motion): freely, in a fluid, or in a clamp."""

from typing import Any, NamedTuple

from psph.fields import SOLID
from psph.physics.rigid.body import Borne


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


class Riding(Borne):
    """Particles of a solid that go with a rigid body, which bears what pulls on them."""

    __slots__ = ()

    kind = SOLID


class MovingClamp(NamedTuple):
    """Particles of a solid that move as a whole by a rigid ``motion``, as they are told."""

    motion: Any

    kind = SOLID

    def pose(self, time: float):
        """The pose of the whole at ``time``, s."""
        return self.motion.pose(time)
