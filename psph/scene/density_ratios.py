"""What several fluids of different density can do wrong in a scene."""

from collections.abc import Iterator
from itertools import combinations

from psph.scene.scene import Scene

LARGEST_RATIO = 5.0
"""Of the densities of two fluids in one scene.  A still layer of a fifth of the density on water keeps its
pressure within some per cent; at a tenth the pressure is 19 % off, at a twentieth 64 %: docs/limits.md."""

ALIKE = 0.01
"""Densities that differ by less than this part are one for a wall."""


def several_fluids(scene: Scene) -> Iterator[str]:
    """Warnings of a scene with fluids of different density, a line each."""
    fluids, table = scene.case.flowing, scene.case.table_of
    for (a, one), (b, other) in combinations(fluids.items(), 2):
        ratio = max(one.density / other.density, other.density / one.density)
        if ratio > LARGEST_RATIO:
            yield (
                f"{table(b)}.{b}.density: {other.density:g} beside {one.density:g} kg/m3 of "
                f"{table(a)}.{a}, a ratio of {ratio:.3g}: pressures are far off above {LARGEST_RATIO:g} "
                "(docs/limits.md); bring the "
                "two densities nearer to each other"
            )
    if len(fluids) > 1:
        yield from _walls_of_another_fluid(scene)


def _walls_of_another_fluid(scene: Scene) -> Iterator[str]:
    """A wall, a body or a solid has the density of one fluid: beside another one pressures do not balance."""
    names, found = list(scene.case.flowing), set()
    for first, last in scene.layout.lattice.chunks():
        held = scene.layout.materials(first, last)
        for fluid, name in enumerate(names):
            beside = set(held[scene.layout.touching(fluid, first, last)].tolist())
            found |= {(wall, name) for wall in beside}
    for key, numbers, continued in _continuing(scene):
        own = scene.case.flowing[continued]
        for name in names:
            density = scene.case.flowing[name].density
            beside = any((number, name) in found for number in numbers)
            if beside and abs(density / own.density - 1.0) > ALIKE:
                other = f"{scene.case.table_of(name)}.{name}"
                cure = f'make the part there a wall of its own with continues = "{name}"'
                if key.startswith(("solids.", "bodies.")):
                    cure = "let it continue the fluid that it touches most"
                yield (
                    f'{key}.continues: "{continued}", but it touches {other} of {density:g} kg/m3 too, and '
                    f"currents arise along it; {cure}"
                )


def _continuing(scene: Scene) -> Iterator[tuple[str, list[int], str]]:
    """The key of each wall, body and solid, the numbers of its parts, and the fluid that it continues."""
    parts = scene.layout.parts
    for number in (*parts.solids, *parts.boundaries):
        yield parts[number].key, parts.of_solid(number), parts[number].table.continues
