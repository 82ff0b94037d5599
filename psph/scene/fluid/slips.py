"""Numbers of fluids and of their tank that are likely a slip in a unit or a sign; none of them is
impossible."""

import math
from collections.abc import Iterator

import numpy as np

from psph.case.keys import AXES
from psph.physics.fluid.friction import friction_step
from psph.scene.scene import Scene
from psph.scene.walls import unheld

LONGEST_TANK = 300.0
"""Metres: the longest wave flume (the Delta Flume) has 300 m.  Millimetres taken for metres have a
table-top tank longer than that."""

LIGHTEST, HEAVIEST = 0.05, 25_000.0
"""kg/m³: hydrogen has 0.08 at room temperature, osmium 22,600."""

EARTH, STRONGEST = 9.81, 100.0
"""m/s²: gravity at the ground, and that from which on cm/s² or mm/s² are more likely than a centrifuge."""

LIGHTEST_LIQUID = 50.0
"""kg/m³: liquid hydrogen has 71; a dense gas such as sulphur hexafluoride 6."""

THINNEST = 2e-8
"""m²/s: liquid helium above its superfluid state has 2.5e-8."""

MOST_SHORTER = 200.0
"""How many times friction may shorten the time steps that sound allows, without a warning: the slow flow
between plates of run/cases/poiseuille.toml has 15."""

MOST_UNHELD = 0.5
"""Part of a fluid's columns that may fall past all walls without a warning."""


def slips(scene: Scene) -> Iterator[str]:
    """A line for each number that is likely not meant."""
    for kind in (_gravity, _densities, _viscosities, _long_tank, _falls_out):
        yield from kind(scene)


def _gravity(scene: Scene) -> Iterator[str]:
    pull = float(np.linalg.norm(scene.gravity))
    if pull > STRONGEST:
        yield (
            f"physics.gravity: {[*scene.gravity]} m/s² is {pull / EARTH:.3g} times that of the earth, which "
            "is 9.81 m/s²; were other units meant?"
        )


def _densities(scene: Scene) -> Iterator[str]:
    for name, fluid in scene.case.fluids.items():
        if not LIGHTEST <= fluid.density <= HEAVIEST:
            than = "lighter than any gas" if fluid.density < LIGHTEST else "heavier than any metal"
            yield (
                f"fluids.{name}.density: {fluid.density:g} kg/m³ is {than}; densities are in kg/m³: "
                "water has 1000, air 1.2"
            )
    fluids = scene.case.fluids.items()
    heaviest = max(fluids, key=lambda one: one[1].density, default=None) if _on_earth(scene) else None
    if (
        heaviest
        and LIGHTEST <= heaviest[1].density < LIGHTEST_LIQUID
        and _on_earth(scene)
        and _is_open(scene)
    ):
        name, fluid = heaviest
        yield (
            f"fluids.{name}.density: {fluid.density:g} kg/m³ is that of a gas, which has no free surface; "
            "densities are in kg/m³: water has 1000"
        )


def _viscosities(scene: Scene) -> Iterator[str]:
    """A viscosity that shortens the time step far below what sound allows, or that nothing has."""
    for name, fluid in scene.case.fluids.items():
        if fluid.viscosity and fluid.viscosity < THINNEST and _on_earth(scene):
            yield (
                f"fluids.{name}.viscosity: {fluid.viscosity:g} m²/s is thinner than any liquid; it is the "
                "kinematic viscosity in m²/s: water has 1e-6, mercury 1.1e-7"
            )
        sound = scene.case.time.cfl * scene.smoothing_length / scene.sound_speed
        times = sound / friction_step(scene, fluid.viscosity) if fluid.viscosity else 0.0
        if times > MOST_SHORTER:
            yield (
                f"fluids.{name}.viscosity: {fluid.viscosity:g} m²/s makes time steps {times:.2g} times "
                "shorter than sound does; it is the kinematic viscosity in m²/s: water has 1e-6, honey 7e-3"
            )


def _on_earth(scene: Scene) -> bool:
    """Whether gravity is that at the ground, so that numbers likely are in SI units."""
    return abs(float(np.linalg.norm(scene.gravity)) / EARTH - 1.0) < 0.02


def _is_open(scene: Scene) -> bool:
    """Whether fluid has a free surface without tension: scaled drops may be of any density."""
    tensions = any(fluid.surface_tension for fluid in scene.case.fluids.values())
    return scene.has_free_surface and not tensions


def _long_tank(scene: Scene) -> Iterator[str]:
    """Only under gravity: without it lengths may be in any unit."""
    if not any(scene.gravity):
        return
    census = scene.census
    sizes = (census.highest - census.lowest).max(axis=1) + scene.spacing
    longest = int(sizes.argmax())
    if sizes[longest] > LONGEST_TANK:
        key = scene.layout.parts[longest].key
        yield (
            f"{key}.shape: {sizes[longest]:.4g} m long, and no wave flume is longer than "
            f"{LONGEST_TANK:g} m; lengths are in m: if they were meant in mm, divide all of them by 1000"
        )


def _falls_out(scene: Scene) -> Iterator[str]:
    """Fluid below which there is no wall, no plane of symmetry and no period: it falls for ever."""
    axis = int(np.abs(scene.layout.height_gravity).argmax())
    pull = scene.layout.height_gravity[axis]
    hangs = any(part.flows and part.keeps_form for part in scene.layout.parts)  # on a clamp, or is thrown
    if not pull or hangs:
        return
    sign = int(math.copysign(1, pull))
    if (axis, sign) in ((plane.axis, plane.side) for plane in scene.layout.mirror_planes):
        return
    free = unheld(scene.layout, axis, sign)
    if free > MOST_UNHELD:
        towards = f"{'+' if pull > 0.0 else '−'}{AXES[axis]}"
        yield (
            f"physics.gravity: {[*scene.gravity]} m/s² pulls towards {towards}, where no wall holds "
            f"{free:.0%} of the fluid: it falls for ever; turn gravity round, or give a wall there"
        )
