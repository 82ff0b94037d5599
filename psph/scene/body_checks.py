"""Rigid bodies that cannot be in their scene, and numbers of bodies that are likely a slip."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from psph.case.bodies import SLIDES, TURNS
from psph.case.keys import AXES
from psph.scene.bodies import body_step, density_ratio

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
