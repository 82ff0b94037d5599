"""Rigid bodies that cannot be in their scene, and numbers of bodies that are likely a slip."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from psph.case.bodies import SLIDES, TURNS
from psph.case.keys import AXES
from psph.scene.bodies import body_step, density_ratio
from psph.scene.lattice import TOLERANCE

if TYPE_CHECKING:
    from psph.scene.scene import Scene

LIGHTEST, HEAVIEST = 0.05, 20.0
"""Densities over that of the fluid that are tried (docs/bodies.md), and beyond which little floats or is
made."""

MOST_SHORTER = 10.0
"""How many times bodies may shorten the time steps that sound allows without a warning."""


def body_faults(scene: "Scene") -> Iterator[str]:
    """A line for each body that a plane of symmetry cuts and that is free to leave it."""
    for number, (name, table) in enumerate(scene.case.bodies.items(), scene.layout.first_body):
        freed = set(table.freed(scene.dimensions))
        for plane in scene.mirror_planes:
            ends = (scene.census.lowest[number, plane.axis], scene.census.highest[number, plane.axis])
            if min(abs(end - plane.at) for end in ends) > 0.75 * scene.spacing:
                continue
            off = {SLIDES[plane.axis], *(turn for d, turn in enumerate(TURNS) if d != plane.axis)}
            if leaving := [one for one in (*SLIDES, *TURNS) if one in freed & off]:
                yield (
                    f"bodies.{name}.free: {', '.join(leaving)} would take it off the mirror at "
                    f"{AXES[plane.axis]} = {plane.at:g} m, which it touches; leave them out of free"
                )


def period_faults(scene: "Scene") -> Iterator[str]:
    """A line for each body that turns and reaches half a period, or more, from the point it turns about.

    The arms of its torque are those of the nearest images, which are others there.  Turns about the axis
    that repeats ask for no arm along it.
    """
    for number, one in enumerate(scene.rigid_bodies, scene.layout.first_body):
        for d, period in enumerate(scene.periods):
            if period is None or not any(free for axis, free in enumerate(one.turns) if axis != d):
                continue
            ends = scene.census.lowest[number, d], scene.census.highest[number, d]
            far = max(abs(end - one.reference[d]) for end in ends) + 0.5 * scene.spacing
            if far > 0.5 * period - TOLERANCE * scene.spacing:
                point = "centre" if one.pivot is None else "pivot"
                yield (
                    f"bodies.{one.name}: it reaches {far:.4g} m from the {point} that it turns about along "
                    f"{AXES[d]}, half of the period of {period:g} m or more; bodies must not cross the seam "
                    "at the start, move space.lower and space.upper; or move the pivot, or make the domain "
                    "longer"
                )


def body_warnings(scene: "Scene") -> Iterator[str]:
    """A line for each body whose density is likely a slip, and for steps that bodies make short."""
    for one in scene.rigid_bodies:
        ratio = density_ratio(scene, one)
        if not LIGHTEST <= ratio <= HEAVIEST:
            depth = " per metre of depth" if scene.dimensions == 2 else ""
            yield (
                f"bodies.{one.name}: {one.mass:.4g} kg, {ratio:.3g} times the density of its fluid; give "
                f"mass in kg{depth}, or density in kg/m3"
            )
    if scene.case.bodies:
        by_sound = scene.case.time.cfl * scene.smoothing_length / scene.sound_speed
        if by_sound > MOST_SHORTER * (step := body_step(scene)):
            yield (
                f"bodies: lines, contact or small mass make time steps {by_sound / step:.3g} times shorter "
                "than sound does; make lines softer, or bodies heavier"
            )
