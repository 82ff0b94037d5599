"""Which motion each group of a scene has, and what its particles carry for it."""

from typing import Any, NamedTuple

import numpy as np

from psph.physics.motion import (
    ANCHOR,
    APPARENT,
    FIXED,
    FREE,
    PRESCRIBED,
    RIGID,
    WHIRL,
    WORK,
    carried_by,
    deforms,
    is_free,
    is_rigid,
)


class Movement(NamedTuple):
    """The different ``motions`` that deform walls and those that are ``rigid``; of each group the number
    ``motion_of`` of its motion (psph.physics.motion), and the row ``pose_of`` of its pose, 0 without one.
    """

    motions: tuple[Any, ...]
    rigid: tuple[Any, ...]
    motion_of: np.ndarray
    pose_of: np.ndarray


def movement_of(species) -> Movement:
    """How the groups of a scene, its ``species``, move."""
    motions, rigid = (_distinct(species, one_of) for one_of in (deforms, is_rigid))
    return Movement(
        motions,
        rigid,
        np.array([_number(one.motion, motions) for one in species], np.uint8),
        np.array([_row(one.motion, rigid) for one in species], np.uint8),
    )


def carried_fields(movement: Movement, frame) -> tuple[str, ...]:
    """Names of what particles can carry because walls move, or the ``frame`` does."""
    moves = bool(movement.motions or movement.rigid)
    if not moves and frame is None:
        return ()
    whirl = [WHIRL.name] if movement.rigid else []
    return (*([ANCHOR.name] if moves else ()), WORK.name, APPARENT.name, *whirl)


def _distinct(species, one_of) -> tuple:
    """The different motions of some species that are ``one_of`` these."""
    # By type too: named tuples of different types are equal where their values are.
    found = (carried_by(s.motion) for s in species if one_of(s.motion))
    motions = {(type(one), one) for one in found}
    return tuple(motion for _, motion in sorted(motions, key=str))


def _row(motion, among: tuple) -> int:
    """The place of a motion among others, 0 where it is none of them."""
    told, own = [(type(one), one) for one in among], carried_by(motion)
    return told.index((type(own), own)) if (type(own), own) in told else 0


def _number(motion, motions: tuple) -> int:
    """The number of a motion in compiled loops."""
    if is_free(motion):
        return FREE
    if is_rigid(motion):
        return RIGID
    return PRESCRIBED + _row(motion, motions) if deforms(motion) else FIXED
