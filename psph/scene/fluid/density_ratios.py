"""What several fluids of different density can do wrong in a scene."""

from collections.abc import Iterator
from itertools import combinations

from psph.case.keys import AXES
from psph.physics.fluid.several import several
from psph.scene.faces import thinnest
from psph.scene.parts import Part
from psph.scene.scene import Scene
from psph.scene.walls import layers_needed

LARGEST_RATIO = 5.0
"""Of the densities of two fluids in one scene.  A still layer of a fifth of the density on water keeps its
pressure within some per cent; at a tenth the pressure is 19 % off, at a twentieth 64 %: docs/limits.md."""

ALIKE = 0.01
"""Densities that differ by less than this part are one for a wall."""

COMPRESSED = 0.3
"""Largest pressure over ρ₀c² that a trapped fluid bears: at 0.5 the guard of the density ends a run."""

ROUNDED = 1.005
"""What a speed of sound is raised by before it is told in three digits: so that it is enough."""


def several_fluids(scene: Scene) -> Iterator[str]:
    """Warnings of a scene with fluids of different density, a line each."""
    fluids = [part for part in scene.layout.parts if part.flows]
    if several(scene):
        yield from _trapped(scene, fluids)
        yield from _held_by_no_pressure(scene, fluids)
        yield from _thin(scene, fluids)
        return
    for one, other in combinations(fluids, 2):
        own, beside = one.table.density, other.table.density
        ratio = max(own / beside, beside / own)
        if ratio > LARGEST_RATIO:
            yield (
                f"{other.key}.density: {beside:g} beside {own:g} kg/m3 of "
                f"{one.key}, a ratio of {ratio:.3g}: pressures are far off above {LARGEST_RATIO:g} "
                "(docs/limits.md); bring the "
                "two densities nearer to each other"
            )
    if len(fluids) > 1:
        yield from _walls_of_another_fluid(scene, fluids)


def _trapped(scene: Scene, fluids: list[Part]) -> Iterator[str]:
    """What heavier fluids compress too far where they trap it: with ρ₀U², U the expected speed, twice the
    pressure of what stops there, since jets that meet in a corner shut it in."""
    heaviest = max(part.table.density for part in fluids)
    for part, one in ((part, scene.species[part.number]) for part in fluids):
        pressed = heaviest * scene.expected_speed**2
        stiffness = one.density * one.sound_speed**2
        if one.density < heaviest and pressed > COMPRESSED * stiffness:
            needed = (pressed / (COMPRESSED * one.density)) ** 0.5
            yield (
                f"{part.key}.sound_speed: {one.sound_speed:.3g} m/s is too low where heavier fluids "
                f"trap it: up to {pressed:.3g} Pa press on it, {pressed / stiffness:.2g} times its "
                f"density times c2; give {ROUNDED * needed:.3g} m/s or more if that can happen"
            )


def _held_by_no_pressure(scene: Scene, fluids: list[Part]) -> Iterator[str]:
    """Walls without a pressure, whose error is some hundredths of what the heaviest fluid weighs."""
    light, heavy = (find(fluids, key=lambda part: part.table.density) for find in (min, max))
    if heavy.table.density <= LARGEST_RATIO * light.table.density:
        return
    for part in scene.layout.parts:
        condition = scene.species[part.number].condition
        if part.is_wall and not scene.species[part.number].bearing:
            yield (
                f'{part.key}.condition: "{condition}" bears no pressure, and errs by some per cent of that '
                f"of {heavy.key}, more than {light.key} of {light.table.density:g} kg/m3 has; use "
                '"dynamic"'
            )


def _thin(scene: Scene, fluids: list[Part]) -> Iterator[str]:
    """Layers and drops that the kernel sees through: a row of a tenth of the density parts at once."""
    need = layers_needed(scene.layout)
    for part in fluids:
        rows, axis = thinnest(scene.census, part.number)
        if rows < need:
            yield (
                f"{part.key}.shape: {rows} row{'s' * (rows != 1)} of particles along {AXES[axis]}, and the "
                f"kernel reaches over {need}: beside other densities it may part; make it at least "
                f"{need * scene.spacing:.6g} m thick, or space.spacing smaller"
            )


def _walls_of_another_fluid(scene: Scene, fluids: list[Part]) -> Iterator[str]:
    """What does not flow has the density of one fluid: beside another one pressures do not balance."""
    parts, found = scene.layout.parts, set()
    for first, last in scene.layout.lattice.chunks():
        held = scene.layout.materials(first, last)
        for fluid in fluids:
            beside = set(held[scene.layout.touching(fluid.number, first, last)].tolist())
            found |= {(wall, fluid.number) for wall in beside}
    for part in (one for one in parts if not one.flows and one.whole == one.number):
        own, numbers = parts[part.source], parts.of_whole(part.number)
        for fluid in fluids:
            density = fluid.table.density
            beside = any((number, fluid.number) in found for number in numbers)
            if beside and abs(density / own.table.density - 1.0) > ALIKE:
                cure = "let it continue the fluid that it touches most"
                if part.is_wall:
                    cure = f'make the part there a wall of its own with continues = "{fluid.name}"'
                yield (
                    f'{part.key}.continues: "{own.name}", but it touches {fluid.key} of {density:g} kg/m3 '
                    f"too, and currents arise along it; {cure}"
                )
