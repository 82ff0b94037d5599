"""Numbers of a case that are likely a slip in a unit or a sign; none of them is impossible."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from psph.case.keys import AXES
from psph.physics.fluid.viscosity import FRICTION_STEP
from psph.scene.species import NONE

if TYPE_CHECKING:
    from psph.scene.scene import Scene

LONGEST_TANK = 300.0
"""Metres: the longest wave flume (the Delta Flume) has 300 m.  Millimetres taken for metres have a
table-top tank longer than that."""

LIGHTEST, HEAVIEST = 0.05, 25_000.0
"""kg/m³: hydrogen has 0.08 at room temperature, osmium 22,600."""

MOST_SHORTER = 200.0
"""How many times friction may shorten the time steps that sound allows, without a warning: the slow flow
between plates of run/cases/poiseuille.toml has 15."""

MOST_UNHELD = 0.5
"""Part of a fluid's columns that may fall past all walls without a warning."""


def slips(scene: "Scene") -> Iterator[str]:
    """A line for each number that is likely not meant."""
    for kind in (_densities, _viscosities, _long_tank, _falls_out):
        yield from kind(scene)


def _densities(scene: "Scene") -> Iterator[str]:
    for name, fluid in scene.case.fluids.items():
        if not LIGHTEST <= fluid.density <= HEAVIEST:
            than = "lighter than any gas" if fluid.density < LIGHTEST else "heavier than any metal"
            yield (
                f"fluids.{name}.density: {fluid.density:g} kg/m³ is {than}; densities are in kg/m³: "
                "water has 1000, air 1.2"
            )


def _viscosities(scene: "Scene") -> Iterator[str]:
    """A viscosity that shortens the time step far below what sound allows."""
    for name, fluid in scene.case.fluids.items():
        h = scene.smoothing_length
        times = fluid.viscosity * scene.case.time.cfl / (FRICTION_STEP * h * scene.sound_speed)
        if times > MOST_SHORTER:
            yield (
                f"fluids.{name}.viscosity: {fluid.viscosity:g} m²/s makes time steps {times:.2g} times "
                "shorter than sound does; it is the kinematic viscosity in m²/s: water has 1e-6, honey 7e-3"
            )


def _long_tank(scene: "Scene") -> Iterator[str]:
    """Only under gravity: without it lengths may be in any unit."""
    if not any(scene.gravity):
        return
    census = scene.census
    sizes = (census.highest - census.lowest).max(axis=1) + scene.spacing
    longest = int(sizes.argmax())
    if sizes[longest] > LONGEST_TANK:
        yield (
            f"{scene.key_of(longest)}.shape: {sizes[longest]:.4g} m long, and no wave flume is longer than "
            f"{LONGEST_TANK:g} m; lengths are in m: if they were meant in mm, divide all of them by 1000"
        )


def _falls_out(scene: "Scene") -> Iterator[str]:
    """Fluid in a scene with walls, none of which lies where gravity pulls it."""
    axis = int(np.abs(scene.gravity).argmax())
    pull = scene.gravity[axis]
    if not pull or not scene.walls or scene.periods[axis] is not None:
        return
    sign = int(math.copysign(1, pull))
    if (axis, sign) in ((plane.axis, plane.side) for plane in scene.mirror_planes):
        return
    unheld = _unheld(scene, axis, sign)
    if unheld > MOST_UNHELD:
        towards = f"{'+' if pull > 0.0 else '−'}{AXES[axis]}"
        yield (
            f"physics.gravity: {[*scene.gravity]} m/s² pulls towards {towards}, where no wall holds "
            f"{unheld:.0%} of the fluid: it leaves the scene; turn gravity round, or give a wall there"
        )


def _unheld(scene: "Scene", axis: int, sign: int) -> float:
    """Part of the lines of sites along ``axis`` with fluid that have no wall beyond it."""
    lattice, fluids = scene.lattice, scene.layout.fluids
    place, nowhere = lattice.axes.index(axis), -lattice.counts[axis] - 1
    held = with_fluid = 0
    ends = None  # of the lines so far, where they go on from chunk to chunk
    for first, last in lattice.chunks():
        found = scene.layout.materials(first, last)
        sites = sign * (np.arange(found.shape[place]) + (0 if place else first))
        along = sites.reshape((-1,) + (1,) * (found.ndim - place - 1))
        far = np.array(
            [
                np.where(mask, along, nowhere).max(axis=place)
                for mask in (found < fluids, (found >= fluids) & (found < NONE))
            ]
        )
        ends = far if place or ends is None else np.maximum(ends, far)
        if place or last == lattice.planes:
            fluid, wall = ends
            with_fluid += np.count_nonzero(fluid > nowhere)
            held += np.count_nonzero((fluid > nowhere) & (wall > fluid))
    return 1.0 - held / with_fluid if with_fluid else 0.0
