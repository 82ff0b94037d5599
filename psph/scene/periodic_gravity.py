"""Flows that gravity drives along a periodic axis: nothing falls there, and friction alone ends them."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from psph.composition.mirrors import ABOVE, BELOW
from psph.physics.facts import SOUND_OVER_SPEED
from psph.scene.rheologies import held_speeds
from psph.scene.walls import unheld

if TYPE_CHECKING:
    from psph.scene.scene import Scene

TOO_FAST = 0.2
"""Mach number that a flow should stay below: its density then varies by some per cent."""

MOST_OPEN = 0.5
"""Part of the lines across a flow that may pass by all walls on a side that is taken for closed."""


def driven_speed(scene: "Scene") -> float:
    """The most that gravity along periodic axes can make of a fluid's speed by the end of the run, m/s.

    g t of a free fall; for a viscosity ν at most g H²/(8ν) across a width H with a wall on both sides, and
    g (2H)²/(8ν) with a wall on one: half of a flow whose other half is behind a plane of symmetry, or
    would be above a free surface; for pastes and grains what their rheology allows.  A mirror that the
    fluid slides along holds nothing back.
    """
    along = _pull(scene)
    speed = along * scene.case.time.end
    for d, width in _widths(scene) if along else ():
        sides = sum(_holds(scene, d, side) for side in (BELOW, ABOVE))
        if sides:
            speed = min([speed, *held_speeds(scene, along, width * 2.0 / sides, width)])
    return speed


def creeping_speed(scene: "Scene") -> float:
    """√(gH) of gravity along periodic axes and the narrowest width H across them, m/s.

    c² is to be a hundred times gH too, or the forces of a slow flow compress it: Morris, Fox & Zhu (1997), J.
    Comput. Phys. 136, 214, eq. (12).
    """
    return math.sqrt(_pull(scene) * min((width for _, width in _widths(scene)), default=0.0))


def _pull(scene: "Scene") -> float:
    """Gravity along the periodic axes, m/s²."""
    return math.dist(scene.gravity, scene.height_gravity)


def _widths(scene: "Scene") -> list[tuple[int, float]]:
    """Each axis that does not repeat, and how far the fluids reach along it, m."""
    fluids = slice(len(scene.case.flowing))
    top, bottom = scene.census.highest[fluids].max(axis=0), scene.census.lowest[fluids].min(axis=0)
    return [
        (d, float(top[d] - bottom[d]) + scene.spacing)
        for d, period in enumerate(scene.periods)
        if period is None
    ]


def _holds(scene: "Scene", axis: int, side: int) -> bool:
    """Whether what bounds the fluids on this side holds back what flows along it."""
    for plane in scene.mirror_planes:
        if (plane.axis, plane.side) == (axis, side):
            return plane.sticks
    return bool(scene.walls) and unheld(scene, axis, side) <= MOST_OPEN


def driven_flow(scene: "Scene") -> Iterator[str]:
    """A warning of a speed of sound that is given, and is too low for what gravity can drive."""
    given, speed = scene.case.physics.sound_speed, driven_speed(scene)
    if given is not None and speed > TOO_FAST * given:
        yield (
            f"physics.sound_speed: {given:.3g} m/s is less than ten times the {speed:.3g} m/s "
            "that gravity along a periodic axis can drive this flow to by time.end (g t, at most "
            "g H²/(8ν) between walls, H twice the width where one side is free or a plane of symmetry, or "
            "what a rheology allows); "
            f"give {SOUND_OVER_SPEED * speed:.3g}, unless something else holds the flow back"
        )
