"""Rules between the motions of a case and its other keys."""

from collections.abc import Iterator
from typing import Any

from psph.case.keys import AXES
from psph.case.motion import PADDLES, TurnAbout, misfits
from psph.case.placed import Placed
from psph.physics.walls.conditions import MIRROR


def moved(case) -> Iterator[tuple[tuple, Any, str]]:
    """Motions that are none, or none here: location, value and message."""
    gravity, tables = (
        case.physics.gravity.acceleration if case.physics.gravity else (),
        case.tables_of(Placed),
    )
    for loc, parts in case.motions.items():
        for place, name, says in misfits(parts, case.space.dimensions, gravity):
            inner = (place,) if len(parts) > 1 else ()
            yield (*loc, *inner, *([name] if name else [])), ..., says
        what = tables[loc[0]].not_absorbing if loc[0] in tables else ""
        if what and any(len(one.ways) == 1 and one.absorbs for one in parts):
            yield loc, ..., f"a wall may absorb waves, {what} not; remove absorb"
    yield from _walls(case)
    yield from _frame(case)


def _walls(case) -> Iterator[tuple[tuple, Any, str]]:
    for name, wall in case.walls.items():
        pressed = all(entry.of.takes_pistons for entry in case.movers)
        if wall.motion and wall.condition == MIRROR and not pressed:
            yield (
                ("walls", name, "motion"),
                ...,
                "a mirror moves before gases alone, and else stands still; give the wall another condition",
            )
        if wall.motion and any(wall.velocity or ()):
            yield (
                ("walls", name, "velocity"),
                wall.velocity,
                "is of a wall that stands; its motion gives it one; remove one of the two",
            )


def _frame(case) -> Iterator[tuple[tuple, Any, str]]:
    loc, parts, space = ("frame", "motion"), case.frame.motion, case.space
    if not parts:
        return
    if any(len(one.ways) == 1 and not one.is_rigid for one in parts):
        yield loc, ..., "is no rigid motion; give one of psph's own"
    if any(one.way in PADDLES for one in parts if len(one.ways) == 1):
        yield loc, ..., "a paddle makes waves as a wall in its tank; give it to a wall"
    turns = [getattr(one, one.way) for one in parts if len(one.ways) == 1]
    axes = [one.axis for one in turns if isinstance(one, TurnAbout) and one.turns]
    for axis in axes:
        along = [name for name, a in zip(AXES, axis or ()) if a]
        if space.periodic and list(space.periodic) != along:
            yield loc, ..., "a frame that turns has no periodic axis, but for the one that it turns about"
            return
