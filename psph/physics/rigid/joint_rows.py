"""What a joint of rigid bodies forbids: its rows, each a gap that stays shut or a coordinate."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from psph.vectors import Vector

SLIDE, TURN, TILT, LENGTH, GO, SPIN = range(6)
"""What a row of a joint is about: that it does not slide along a way, turn about it or tilt its axis about
it, or keeps a length; and its coordinate, along a way or about it."""

ORIGIN = (0.0, 0.0, 0.0)


class Joint(NamedTuple):
    """What joins the body of the row ``body`` with that of the row ``other``, None for what no force moves.

    ``here`` and ``there`` are the points of the two that it joins, where they are at the start, m; the first
    lies by ``over``, whole periods, beyond that of the other's image that is joined.
    ``slides`` are directions along which the first may not move seen from the other, ``turns`` those about
    which it may not turn, and ``tilts`` those about which an ``axis`` of both may not tilt; all of them
    turn with the other. ``length`` in m is that of a rod between the points, None without one.  ``leader``
    has the pose of the other where it moves as it is told.  ``along`` is the way, or the axis, of its
    coordinate q: where the joint ``goes`` how far along it in m, else the angle about it in rad.  q has
    ``limits``, a spring of the ``stiffness`` (N/m or N m) about ``rest``, and a damper with the ``damping``
    (N s/m or N m s).  What reaches a limit with a ``latch`` stays there, else it goes back with the
    ``restitution`` times its speed.
    """

    name: str
    body: int
    other: int | None
    here: Vector
    there: Vector
    slides: tuple[Vector, ...] = ()
    turns: tuple[Vector, ...] = ()
    tilts: tuple[Vector, ...] = ()
    axis: Vector | None = None
    length: float | None = None
    leader: Any = None
    along: Vector | None = None
    goes: bool = False
    limits: tuple[float, float] = (-np.inf, np.inf)
    stiffness: float = 0.0
    rest: float = 0.0
    damping: float = 0.0
    latch: bool = False
    restitution: float = 0.0
    over: Vector = ORIGIN


class JointRows(NamedTuple):
    """The rows of all joints at a moment: the ``gap`` of each (m,), m or rad, or the coordinate q of a
    joint; the ``push`` N s and ``twist`` N m s (m, 3) of a unit impulse on the first body, and what turns
    the second ``back``; ``told`` (m,) the rates at which what leads opens the gaps, m/s or rad/s."""

    gap: np.ndarray
    push: np.ndarray
    twist: np.ndarray
    back: np.ndarray
    told: np.ndarray


def rows_of(joint: Joint) -> Iterator[tuple[int, Vector]]:
    """What each row of a joint is about, and its way."""
    yield from ((SLIDE, way) for way in joint.slides)
    yield from ((TURN, way) for way in joint.turns)
    yield from ((TILT, way) for way in joint.tilts)
    if joint.length is not None:
        yield LENGTH, ORIGIN
    if joint.along is not None:
        yield (GO if joint.goes else SPIN), joint.along


def turned(turn: np.ndarray, ways: np.ndarray) -> np.ndarray:
    """Vectors (n, 3) turned by matrices (n, 3, 3)."""
    return np.einsum("nde,ne->nd", turn, ways)


def vector_of(turn: np.ndarray) -> np.ndarray:
    """Axis times sine of the angle of matrices (n, 3, 3)."""
    m = 0.5 * (turn - turn.transpose(0, 2, 1))
    return np.stack([m[:, 2, 1], m[:, 0, 2], m[:, 1, 0]], axis=1)
