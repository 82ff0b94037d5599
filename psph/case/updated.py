"""Solids whose neighbours are those of the present, and the rules between their keys."""

from collections.abc import Iterator

from psph.case.findings import Finding

TOTAL, UPDATED = "total", "updated"
"""Descriptions of a solid: psph.physics.solid, and psph.physics.stress."""

OF_REFERENCE = (
    "law",
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
)
"""Keys that mean nothing to a solid whose neighbours are those of the present."""

OF_FLUIDS = (
    "tension_floor",
    "position_shift",
    "particle_shifting",
    "summation_density",
    "local_potential",
    "pair_potential",
)
"""Keys of ``physics`` that keep a fluid in order, and take a solid apart."""


def updated(case) -> Iterator[Finding]:
    """What updated Lagrangian solids do not know, in a case that has some."""
    here = ("solids", next(iter(case.updated)), "description")
    for name in ("fluids", "soils", "anvils", "referred"):
        if getattr(case, name):
            beside = "solids that are total Lagrangian" if name == "referred" else name
            yield here, UPDATED, f"nothing is known of updated Lagrangian solids beside {beside}; remove one"
    for name in case.updated.keys() & case.walls.keys():
        yield ("solids", name), ..., "a wall has this name too; give the solid another"
    if case.physics.pressure_gradient != "symmetric":
        says = 'the stress of solids is symmetric in a pair; use "symmetric"'
        yield ("physics", "pressure_gradient"), case.physics.pressure_gradient, says
    if case.physics.contact is not None:
        says = 'updated Lagrangian solids feel each other without; remove it, or give description = "total"'
        yield ("physics", "contact"), ..., says
    for name in OF_FLUIDS:
        if getattr(case.physics, name) is not None:
            yield ("physics", name), ..., 'it is made for fluids; give scheme = "solid", or remove this key'
    for name, solid in case.updated.items():
        for key_of in OF_REFERENCE:
            default = type(solid).model_fields[key_of].get_default(call_default_factory=True)
            if getattr(solid, key_of) != default:
                says = 'an updated Lagrangian solid has none; remove it, or give description = "total"'
                yield ("solids", name, key_of), ..., says
