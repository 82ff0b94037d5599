"""Elastic solids among fluids: what they show, in the place of what they are made of."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from psph.scene.scene import Scene


def is_immersed(scene: "Scene", material: int) -> bool:
    """Whether a material is of an elastic solid beside fluids."""
    return bool(scene.case.flowing) and scene.layout.elastic_of(material) is not None


def shown_by(scene: "Scene") -> list[int]:
    """For each material the index of the one whose density and state it has: of a wall, and of a solid among
    fluids, that of the fluid that it continues; without fluids of a wall that of the first solid."""
    layout, fluids = scene.layout, list(scene.case.flowing)
    if not fluids:
        return [*range(layout.movers), *layout.clamps, *[0] * len(scene.boundaries)]
    continued = [fluids.index(one.continues) for one in scene.boundaries.values()]
    movers = [*range(layout.fluids), *(fluids.index(one.continues) for one in scene.case.referred.values())]
    return [*movers, *(movers[of] for of in layout.clamps), *continued]
