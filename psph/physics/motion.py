"""How the particles of a species move: freely, not at all, or as they are told.

A motion is a typed value, as an effect is.  One that is prescribed has two methods, of a particle's
``anchor`` (where it stood at the start, m) and the time (s):

    place(anchor, time)     → where it is, m
    velocity(anchor, time)  → the time derivative of that, m/s

so that its particles never drift from where they belong, however many steps a run takes.
"""

from typing import NamedTuple

from psph.fields import FLUID, VECTOR, WALL, Field

ANCHOR = Field("anchor", "m", "place at time zero, of particles whose motion is prescribed", VECTOR)


class Free(NamedTuple):
    """Particles move as forces have them."""

    kind = FLUID


class Fixed(NamedTuple):
    """Particles stay where they are."""

    kind = WALL


FREE, FIXED, PRESCRIBED = 0, 1, 2
"""Numbers of motions in compiled loops: of prescribed ones, the first."""


def is_prescribed(motion) -> bool:
    """Whether a motion says where its particles are."""
    return hasattr(motion, "place")
