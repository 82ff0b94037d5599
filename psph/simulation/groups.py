"""What holds for each group of particles: its equation of state, its motion, and what is told to it."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from psph.physics.catalogue import Entry
from psph.physics.motion import FIXED, FREE, PRESCRIBED, RIGID, Fixed, Free, is_rigid
from psph.simulation.calling import called_for


def laws(scene, entries: Iterable[Entry]) -> dict[tuple[type, Any], str]:
    """Each equation of state of the scene with its type, and the keys of the case that call for it.

    By type too: named tuples of different types are equal where their values are.
    """
    [(_, shared)] = filter(None, (called_for(scene.case, entry) for entry in entries))
    reasons: dict[tuple[type, Any], dict[str, None]] = {}
    for (name, fluid), one in zip(scene.case.fluids.items(), scene.species):
        own = fluid.equation_of_state and f"fluids.{name}.equation_of_state = {fluid.equation_of_state}"
        reasons.setdefault((type(one.law), one.law), {})[own or shared] = None
    return {law: "; ".join(keys) for law, keys in reasons.items()}


def tells(effect, material) -> bool:
    """Whether an effect gives particles of a material their pressure."""
    return hasattr(effect, "tells") and material_value(material, effect.tells) > 0.0


def distinct(species, one_of) -> tuple:
    """The different motions of some species that are ``one_of`` these."""
    # By type too: named tuples of different types are equal where their values are.
    found = {(type(s.motion), s.motion) for s in species if one_of(s.motion)}
    return tuple(motion for _, motion in sorted(found, key=str))


def row_of(motion, among: tuple) -> int:
    """The place of a motion among others, 0 where it is none of them."""
    told = [(type(one), one) for one in among]
    return told.index((type(motion), motion)) if (type(motion), motion) in told else 0


def motion_numbers(species, motions) -> np.ndarray:
    numbers = {Free: FREE, Fixed: FIXED}
    return np.array(
        [
            RIGID
            if is_rigid(s.motion)
            else numbers.get(type(s.motion), PRESCRIBED + row_of(s.motion, motions))
            for s in species
        ],
        np.uint8,
    )


def material_value(material, name: str) -> float:
    """A material's value of one of the fields ``OF_MATERIAL``."""
    return float(getattr(material, "density" if name == "rest_density" else name))
