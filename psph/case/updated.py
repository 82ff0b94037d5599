"""Solids whose neighbours are those of the present, and the rules between their keys."""

from collections.abc import Iterator
from typing import Any, ClassVar

import psph.acts as acts
from psph.case.findings import Finding

TOTAL, UPDATED = "total", "updated"
"""Descriptions of a solid: psph.physics.solid, and psph.physics.stress."""

OF_REFERENCE = (
    "law",
    "hyperelastic",
    "plane",
    "relaxation",
    "yield_stress",
    "hardening",
    "johnson_cook",
    "damping",
    "hourglass",
    "loads",
    "load_rise",
    "critical_stretch",
    "flaws",
    "continues",
    "mie_gruneisen",
    "spacing",
    "no_slip",
)
"""Keys that mean nothing to a solid whose neighbours are those of the present."""

OF_SOLIDS = {
    acts.ONE: "solids need two or three dimensions",
    acts.FRAME: "solids know of no frame that moves; remove one of the two",
    acts.SYMMETRY: "mirrors know of no solids; draw the whole solid",
    acts.MIXED: 'solids are computed in double precision, since strains are small; use "double"',
}
"""Beside what solids of either description do not work (psph.acts)."""


@acts.speaks_for(acts.UPDATED)
class Updated:
    """Beside what updated Lagrangian solids do not work."""

    refuses: ClassVar = OF_SOLIDS | {
        other: f"nothing is known of updated Lagrangian solids beside {beside}; remove one"
        for other, beside in (
            (acts.FLUIDS, "fluids"),
            (acts.BODIES, "rigid bodies"),
            (acts.SOLIDS, "solids that are total Lagrangian"),
        )
    }


def updated_in(case) -> dict[str, Any]:
    """The solids of a case whose neighbours are those of the present, by name."""
    return {name: solid for name, solid in case.solids.items() if solid.is_updated}


def referred_in(case) -> dict[str, Any]:
    """The solids of a case whose neighbours are those of the start, by name: total Lagrangian."""
    return {name: solid for name, solid in case.solids.items() if not solid.is_updated}


def updated(case) -> Iterator[Finding]:
    """What updated Lagrangian solids do not know, in a case that has some."""
    here = ("solids", next(iter(updated_in(case))), "description")
    if case.anvils:
        yield here, UPDATED, "nothing is known of updated Lagrangian solids beside anvils; remove one"
    for name in updated_in(case).keys() & case.walls.keys():
        yield ("solids", name), ..., "a wall has this name too; give the solid another"
    for name, solid in updated_in(case).items():
        for key_of in OF_REFERENCE:
            default = type(solid).model_fields[key_of].get_default(call_default_factory=True)
            if getattr(solid, key_of) != default:
                says = 'an updated Lagrangian solid has none; remove it, or give description = "total"'
                yield ("solids", name, key_of), ..., says
