"""What the elastic solids of a case are made of, and the planes that they may hit."""

import math
from typing import TYPE_CHECKING

from psph.particles.reach import Reach
from psph.physics.solid.contact import REACH
from psph.physics.solid.material import MADE_OF, Solid, solid_of

if TYPE_CHECKING:
    from psph.scene.scene import Scene


def solids_of(case) -> tuple[Solid, ...]:
    """The elastic solids of a case, in its order."""
    return tuple(
        solid_of(
            name,
            **{key: getattr(table, key) for key in MADE_OF},
            johnson_cook=table.johnson_cook and dict(table.johnson_cook),
        )
        for name, table in case.solids.items()
    )


def anvils_of(case) -> tuple[tuple[tuple[float, ...], tuple[float, ...]], ...]:
    """A point of each anvil of a case in m, and the unit vector out of it."""
    tables = case.anvils.values()
    return tuple((one.at, tuple(n / math.hypot(*one.normal) for n in one.normal)) for one in tables)


def modulus_shown(scene: "Scene", material: int) -> float:
    """The P-wave modulus ρ₀c_l² by which a contact with a material is stiff, Pa: of a solid its own,
    of a wall beside solids the largest of theirs, of a fluid 0."""
    if material < scene.layout.fluids or not scene.elastic_solids:
        return 0.0
    own, every = scene.layout.elastic_of(material), scene.elastic_solids
    return max(one.density * one.wave_speed**2 for one in (every if own is None else every[own : own + 1]))


def reach_of_contact(whole: Reach, spacing: float) -> Reach:
    """Of a scene of solids alone: they feel each other within two of the ``spacing`` in m, and what a
    kernel's ``whole`` reach has beyond that is skin, one spacing at least."""
    return Reach(REACH * spacing, max(whole.cutoff - REACH * spacing, spacing))
