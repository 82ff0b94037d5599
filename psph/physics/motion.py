"""How the particles of a species move: freely, not at all, or as they are told.

A motion is a typed value, as an effect is.  A rigid one is a function of time alone: it has one method,

    pose(time)              → a psph.physics.rigid.pose.Pose,

which is evaluated once a step.  One that deforms a wall has two methods, of a particle's ``anchor`` (where
it stood at the start, m) and the time (s), which are compiled into the loops:

    place(anchor, time)     → where it is, m
    velocity(anchor, time)  → the time derivative of that, m/s

Neither is integrated, so that particles never drift from where they belong, however many steps a run takes.
"""

from typing import NamedTuple

import numpy as np

from psph.fields import AXIAL, BUFFER, FLUID, MATRIX, OTHER, VECTOR, WALL, Field, Turned, VelocityGradient

ANCHOR = Field("anchor", "m", "place at time zero, of particles whose motion is prescribed", VECTOR)

APPARENT = Field(
    "apparent",
    "m/s2",
    "force per mass of an accelerated frame, less the acceleration of a moving wall",
    VECTOR,
    image=Turned,
)

WORK = Field("work", "J", "energy that a moving wall, a load or the force of an accelerated frame has given")

LOAD = Field("load", "m/s2", "acceleration by the fluid alone, of particles whose load is asked for", VECTOR)

COUPLE = Field(
    "couple",
    "m2/s2",
    "moment of the load by its mass about the particle's own place: each pair pushes halfway between its two",
    AXIAL,
)

HELD_COUPLE = Field("held_couple", "m2/s2", "part of the couple that serves for several steps", AXIAL)

WHIRL = Field(
    "whirl",
    "1/s",
    "[ω] of what moves as a whole: the velocity of one that is r away differs by [ω] r",
    MATRIX,
    image=VelocityGradient,
)

OF_MOTION = (ANCHOR, APPARENT, LOAD, COUPLE, WORK, WHIRL)
"""What particles carry only where something moves as it is told, or its load is asked for."""


class Free(NamedTuple):
    """Particles move as forces have them."""

    kind = FLUID
    flows = True
    goes_free = True
    is_free = True


class Fixed(NamedTuple):
    """Particles stay where they are."""

    kind = WALL
    drift = (0.0, 0.0, 0.0)


class Buffered(NamedTuple):
    """Particles stand behind an open end and go as that says (psph.matter.end)."""

    kind = BUFFER
    flows = True
    ends_fluid = True


class Led(NamedTuple):
    """Particles of a fluid go with those of another size around them (psph.matter.refinement)."""

    kind = BUFFER
    flows = True
    follows = True


class OfItsKind(NamedTuple):
    """Particles are moved by the work of a kind of matter (psph.kinds)."""

    kind = OTHER


FREE, FIXED, RIGID, PRESCRIBED = 0, 1, 2, 3
"""Numbers of motions in compiled loops: of those that deform, the first."""


def is_free(motion) -> bool:
    """Whether forces move particles."""
    return getattr(motion, "is_free", False)


def flows(motion) -> bool:
    """Whether what moves so is fluid to its neighbours."""
    return getattr(motion, "flows", False)


def ends_fluid(motion) -> bool:
    """Whether what moves so stands behind the end of a fluid."""
    return getattr(motion, "ends_fluid", False)


def follows(motion) -> bool:
    """Whether what moves so goes with particles of another size."""
    return getattr(motion, "follows", False)


def goes_free(motion) -> bool:
    """Whether forces say where what moves so goes, at least along an axis."""
    return getattr(motion, "goes_free", False)


def told_of(motion):
    """What of a motion the case tells: its ``motion`` where other things too say how it goes, or None."""
    return getattr(motion, "motion", motion)


def carried_by(motion):
    """What a motion goes with: another, as of what is fixed to a body; itself where there is none."""
    return getattr(motion, "carrier", motion)


def is_prescribed(motion) -> bool:
    """Whether a motion says where its particles are."""
    return deforms(motion) or is_rigid(motion)


def deforms(motion) -> bool:
    """Whether a motion says so for each particle by itself."""
    return hasattr(motion, "place")


def drift(motion):
    """The velocity, m/s, that all that moves so has at all times, or None."""
    return getattr(motion, "drift", None)


def is_rigid(motion) -> bool:
    """Whether a motion has a pose."""
    return hasattr(motion, "pose")


def moments(end: float, count: int) -> np.ndarray:
    """Times from 0 to ``end`` that no period divides: the golden section's multiples."""
    return np.array([0.0, *(end * ((k * 0.6180339887498949) % 1.0) for k in range(1, count)), end])
