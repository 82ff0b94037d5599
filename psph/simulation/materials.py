"""The table of materials: a row for each group of particles."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np

from psph.fields import OF_MATERIAL, OTHER, WALL
from psph.kinds import kinds_in
from psph.physics.catalogue import Entry
from psph.physics.motion import is_prescribed
from psph.simulation.calling import called_for
from psph.simulation.movement import movement_of

NOT_BONDED = 255
"""Number of what keeps no neighbours of the start."""


class Materials(NamedTuple):
    """What holds for all particles of a group: loops read it by the number of the group.

    A row is a group, a column an array (groups,) or a tuple.  What is the same for all groups, and what loops
    read of a neighbour, is not here but among the constants and fields of the plan (:func:`split`).
    """

    species: tuple[Any, ...]
    """The rows as the scene has them (psph.scene.species.Species)."""
    kinds: tuple[int, ...]
    """The kind, as frames tell them (psph.fields)."""
    free: np.uint8
    """How many groups move freely: these come first."""
    driven: np.ndarray
    """Whether its particles do not: they move as they are told, or not at all."""
    apart: np.ndarray
    """Whether its particles are in ordinary passes neither seen nor see others."""
    laws: tuple[Any, ...]
    """The equations of state of fluids and walls."""
    law_reasons: tuple[str, ...]
    """The keys of the case that called for each."""
    law_of: np.ndarray
    """The number of the law."""
    bearing: np.ndarray
    """Whether its particles bear a pressure."""
    given_pressure: np.ndarray
    """Whether a pass gives its particles their pressure."""
    motions: tuple[Any, ...]
    """The prescribed motions that deform walls."""
    motion_of: np.ndarray
    """The number of the motion (psph.physics.motion)."""
    rigid: tuple[Any, ...]
    """The motions that have a pose (psph.simulation.poses)."""
    pose_of: np.ndarray
    """The row of the pose, 0 without one."""
    bonded_to: np.ndarray
    """The number of what its particles are bonded in, NOT_BONDED where they are not."""
    others: np.ndarray
    """For each level of sizes whether a group is of another one (levels, groups)."""
    loaded: np.ndarray | None
    """Whether the push of the fluid alone, or of elastic solids where nothing flows, is summed on its
    particles; None: on none."""

    @property
    def flows(self) -> bool:
        """Whether there is a fluid."""
        return any(one.is_fluid for one in self.species)

    def where(self, holds: Callable[[Any], bool]) -> np.ndarray:
        """Whether something holds for each row."""
        return np.array([holds(one) for one in self.species], bool)

    def values(self, name: str) -> np.ndarray:
        """The value of each row of one of the fields ``OF_MATERIAL``."""
        return np.array([material_value(one, name) for one in self.species])


def materials_of(scene, states: Iterable[Entry], effects: Sequence) -> Materials:
    """The table of a scene, with the equations of state that its case can call for and its ``effects``."""
    species = (*scene.species, *(group for kind in kinds_in(scene) for group in kind.groups()))
    own_laws, movement = laws(scene, states), movement_of(species)

    def each(value, dtype=bool) -> np.ndarray:
        return np.array([value(one) for one in species], dtype)

    level = each(lambda one: one.level, np.int64)
    loaded = loaded_of(species)
    return Materials(
        species=species,
        kinds=tuple(one.kind for one in species),
        free=np.uint8(sum(one.mobile for one in species)),
        driven=each(lambda one: not one.mobile),
        apart=each(lambda one: one.kind == OTHER),
        laws=tuple(law for _, law in own_laws),
        law_reasons=tuple(own_laws.values()),
        law_of=each(lambda one: [*own_laws].index((type(one.law), one.law)), np.uint8),
        bearing=each(lambda one: one.bearing),
        given_pressure=each(lambda one: any(is_given_pressure(effect, one) for effect in effects)),
        bonded_to=each(lambda one: NOT_BONDED if one.bonded is None else one.bonded, np.uint8),
        others=level != np.arange(1 + level.max(initial=0))[:, None],
        loaded=loaded if loaded.any() else None,
        **movement._asdict(),
    )


def loaded_of(species: Sequence) -> np.ndarray:
    """Whether what pushes on each of the ``species`` is summed (species,): where it is asked for, and on what
    a prescribed motion drives, for the books of the energy."""
    flows = any(one.is_fluid for one in species)
    return np.array(
        [one.loaded or (is_prescribed(one.motion) and (flows or one.kind == WALL)) for one in species], bool
    )


def laws(scene, entries: Iterable[Entry]) -> dict[tuple[type, Any], str]:
    """Each equation of state of the scene with its type, and the keys of the case that call for it.

    By type too: named tuples of different types are equal where their values are.
    """
    [(_, shared)] = filter(None, (called_for(scene.case, entry) for entry in entries))
    reasons: dict[tuple[type, Any], dict[str, None]] = {}
    for part, one in zip(scene.layout.parts, scene.species):
        if part.flows:
            reasons.setdefault((type(one.law), one.law), {})[part.law_key or shared] = None
    for one in scene.species[len(reasons) and len(scene.species) :]:  # of solids alone: none bears a pressure
        reasons.setdefault((type(one.law), one.law), {})[shared] = None
    return {law: "; ".join(keys) for law, keys in reasons.items()}


def is_given_pressure(effect, material) -> bool:
    """Whether an effect gives particles of a material their pressure."""
    return hasattr(effect, "tells") and material_value(material, effect.tells) > 0.0


def material_value(material, name: str) -> float:
    """A material's value of one of the fields ``OF_MATERIAL``."""
    return float(getattr(material, "density" if name == "rest_density" else name))


def tell_of_groups(store, materials: Materials) -> None:
    """Of particles that have changed groups what these differ in: whether forces move them, and whether they
    stand behind an open end."""
    for name in ("mobile", "ends_fluid"):
        if name in store:
            store[name][store.inner] = materials.values(name)[store.shown("group")]


def split(species, names) -> tuple[dict[str, float], tuple[str, ...]]:
    """Quantities fixed by the material that formulas read, of some ``species``: shared values, and names of
    those that vary."""
    shared, varying = {}, []
    for name in (field.name for field in OF_MATERIAL):
        values = {material_value(m, name) for m in species}
        if name != "mass" and name not in names:
            continue
        if len(values) == 1 and (name != "mass" or all(m.one_mass for m in species)):
            shared[name] = values.pop()
        else:
            varying.append(name)
    return shared, tuple(varying)


def has_couples(scene) -> bool:
    """Whether the push of a viscous fluid on a wall or a body is asked for, which has a moment."""
    rubbed = any(one.loaded and one.rubs for one in scene.species if not one.is_fluid)
    return scene.dimensions > 1 and rubbed and any(one.rubs for one in scene.species if one.is_fluid)
