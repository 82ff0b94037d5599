"""Flows that gravity drives along a periodic axis: nothing falls there, and friction alone ends them."""

import math
from collections.abc import Iterator

from psph.composition.reflections import ABOVE, BELOW
from psph.physics.fluid.rheology import Granular, HerschelBulkley
from psph.scene.census import Census
from psph.scene.layout import Layout
from psph.scene.walls import unheld

MOST_OPEN = 0.5
"""Part of the lines across a flow that may pass by all walls on a side that is taken for closed."""


def driven_speed(census: Census) -> float:
    """The most that gravity along periodic axes can make of a fluid's speed by the end of the run, m/s.

    g t of a free fall; for a viscosity ν at most g H²/(8ν) across a width H with a wall on both sides, and
    g (2H)²/(8ν) with a wall on one: half of a flow whose other half is behind a plane of symmetry, or
    would be above a free surface; for pastes and grains what their rheology allows.  A mirror that the
    fluid slides along holds nothing back.
    """
    along = _pull(census.layout)
    speed = along * census.layout.case.time.end
    for d, width in _widths(census) if along else ():
        sides = sum(_holds(census.layout, d, side) for side in (BELOW, ABOVE))
        if sides:
            speed = min([speed, *_held_speeds(census.layout, along, width * 2.0 / sides, width)])
    return speed


def creeping_speed(census: Census) -> float:
    """√(gH) of gravity along periodic axes and the narrowest width H across them, m/s.

    c² is to be a hundred times gH too, or the forces of a slow flow compress it: Morris, Fox & Zhu (1997), J.
    Comput. Phys. 136, 214, eq. (12).
    """
    return math.sqrt(_pull(census.layout) * min((width for _, width in _widths(census)), default=0.0))


def _pull(layout: Layout) -> float:
    """Gravity along the periodic axes, m/s²."""
    return math.dist(layout.gravity, layout.height_gravity)


def _widths(census: Census) -> list[tuple[int, float]]:
    """Each axis that does not repeat, and how far the fluids reach along it, m."""
    layout, (bottom, top) = census.layout, census.flow
    return [
        (d, float(top[d] - bottom[d]) + layout.spacing)
        for d, period in enumerate(layout.periods)
        if period is None
    ]


def _holds(layout: Layout, axis: int, side: int) -> bool:
    """Whether what bounds the fluids on this side holds back what flows along it."""
    for plane in layout.mirror_planes:
        if (plane.axis, plane.side) == (axis, side):
            return plane.sticks
    return bool(layout.parts.walls) and unheld(layout, axis, side) <= MOST_OPEN


def _held_speeds(layout: Layout, pull: float, gap: float, depth: float) -> Iterator[float]:
    """The speeds in m/s that fluids reach under ``pull`` m/s² between plates ``gap`` m apart, and grains of
    this ``depth``, m, on a slope."""
    down = math.hypot(*(g for g, period in zip(layout.gravity, layout.periods) if period is None))
    for fluid in (part.table for part in layout.parts if part.flows):
        if fluid.viscosity:
            yield pull * gap**2 / (8.0 * fluid.viscosity)
        elif fluid.rheology and isinstance(fluid.rheology.law, HerschelBulkley):
            yield fluid.rheology.law.speed_between(fluid.density * pull, 0.5 * gap)
        elif fluid.rheology and isinstance(fluid.rheology.law, Granular) and down:
            yield fluid.rheology.law.speed_on_slope(pull / down, fluid.density * down, depth)
