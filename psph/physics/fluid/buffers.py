"""What corrected gradients take for fluid with neighbours all around: not what stands behind an open end."""

from typing import NamedTuple

from psph.engine.jit import call_by_type
from psph.physics.facts import Facts
from psph.physics.motion import ends_fluid


class NoBuffers(NamedTuple):
    """All fluid."""

    def stands_behind(self, i):
        """0: there is no end."""
        return 0.0

    def in_front(self, i):
        """1 in a fluid, else 0."""
        return i.is_fluid


class BesideBuffers(NamedTuple):
    """Fluid in front of ends: behind one there is nothing, as behind a wall."""

    def stands_behind(self, i):
        """1 in the buffer of an end, else 0."""
        return i.ends_fluid

    def in_front(self, i):
        """1 in a fluid in front of an end, else 0."""
        return i.is_fluid * (1.0 - i.ends_fluid)


Buffers = NoBuffers | BesideBuffers

in_front = call_by_type("in_front")
"""(buffers, i) → 1 in fluid in front of open ends, else 0: see :class:`BesideBuffers`."""


stands_behind = call_by_type("stands_behind")
"""(buffers, i) → 1 in the buffer of an end, else 0."""


def buffers_of(scene: Facts) -> Buffers:
    """Whether some fluid of a scene stands behind an open end."""
    return BesideBuffers() if open_ended(scene) else NoBuffers()


def open_ended(scene: Facts) -> bool:
    """Whether fluid comes and goes: some of it stands behind an open end."""
    return any(ends_fluid(one.motion) for one in scene.species)
