"""The state in which the materials of a scene start."""

from typing import TYPE_CHECKING

from psph.case.parameters import last_part
from psph.case.study import EXACT
from psph.physics.stress.bulk import Hooke
from psph.scene.species import Start
from psph.scene.still import HYDROSTATIC

if TYPE_CHECKING:
    from psph.scene.scene import Scene


def law_of(scene: "Scene", part):
    """The equation of state of a material: its own, or that of all."""
    if hasattr(part, "bulk_modulus"):
        return Hooke(part.bulk_modulus, scene.stressed.tension_of(part))
    name = getattr(part, "equation_of_state", None) or scene.case.physics.equation_of_state
    [law] = (entry.effect for entry in scene.case.catalogue.states if last_part(entry) == name)
    return law()


def start_of(scene: "Scene", index: int) -> Start:
    """The state of a material before the first step."""
    part = scene.parts[index]
    pressure = getattr(part, "pressure", 0.0)
    hydrostatic, exact = (pressure == word for word in (HYDROSTATIC, EXACT))
    return Start(
        law=law_of(scene, part),
        rest_density=part.density,
        sound_speed=scene.sound_speed,
        pressure=0.0 if hydrostatic or exact else pressure,
        exact=(lambda x: scene.exact.pressure(x, 0.0, scene.setting)) if exact else None,
        layer=scene.stills.get(index) if hydrostatic else scene.stressed.layers.get(index),
    )
