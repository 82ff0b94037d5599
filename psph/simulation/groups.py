"""What holds for each group of particles: its equation of state, its properties, and what is told to it."""

from collections.abc import Iterable
from typing import Any

from psph.fields import OF_MATERIAL
from psph.kinds import kinds_in
from psph.physics.catalogue import Entry
from psph.scene.solids import meets
from psph.simulation.calling import called_for


def laws(scene, entries: Iterable[Entry]) -> dict[tuple[type, Any], str]:
    """Each equation of state of the scene with its type, and the keys of the case that call for it.

    By type too: named tuples of different types are equal where their values are.
    """
    [(_, shared)] = filter(None, (called_for(scene.case, entry) for entry in entries))
    reasons: dict[tuple[type, Any], dict[str, None]] = {}
    for (name, fluid), one in zip(scene.case.flowing.items(), scene.species):
        own = fluid.equation_of_state and f"fluids.{name}.equation_of_state = {fluid.equation_of_state}"
        if one.shear_modulus:
            own = f"{scene.case.table_of(name)}.{name}.young"
        reasons.setdefault((type(one.law), one.law), {})[own or shared] = None
    for one in scene.species[len(reasons) and len(scene.species) :]:  # of solids alone: none bears a pressure
        reasons.setdefault((type(one.law), one.law), {})[shared] = None
    return {law: "; ".join(keys) for law, keys in reasons.items()}


def species_of(scene) -> tuple:
    """The groups of a scene: those on its lattice, then those that kinds of matter add."""
    return (*scene.species, *(group for kind in kinds_in(scene) for group in kind.groups()))


def is_given_pressure(effect, material) -> bool:
    """Whether an effect gives particles of a material their pressure."""
    return hasattr(effect, "tells") and material_value(material, effect.tells) > 0.0


def material_value(material, name: str) -> float:
    """A material's value of one of the fields ``OF_MATERIAL``."""
    return float(getattr(material, "density" if name == "rest_density" else name))


def split(species, names) -> tuple[dict[str, float], tuple[str, ...]]:
    """Quantities fixed by the material that formulas read, of some ``species``: shared values, and names of
    those that vary."""
    shared, varying = {}, []
    for name in (field.name for field in OF_MATERIAL):
        values = {material_value(m, name) for m in species}
        if name != "mass" and name not in names:
            continue
        if len(values) == 1:
            shared[name] = values.pop()
        else:
            varying.append(name)
    return shared, tuple(varying)


def has_couples(scene) -> bool:
    """Whether the push of a viscous fluid on a wall or a body is asked for, and what has a moment; or that of
    elastic solids on bodies, whose contacts turn the normals of their faces."""
    if scene.case.bodies and meets(scene):
        return True
    rubbed = any(one.loaded and one.rubs for one in scene.species if not one.is_fluid)
    return scene.dimensions > 1 and rubbed and any(one.rubs for one in scene.species if one.is_fluid)
