"""Effects of a scene that have no influence on it."""

from collections.abc import Iterator

from psph.physics.fluid.gravity import Gravity
from psph.physics.fluid.viscosity import ArtificialViscosity, LaminarViscosity
from psph.physics.surface.free import FreeSurface
from psph.simulation.plan import Plan, words

UNSEEN = 0.01
"""A fluid's viscosity below this part of the numerical one is negligible."""


def hints(scene, plan: Plan) -> Iterator[str]:
    """One line for each such effect: why, and what to remove."""
    present = {type(effect): effect for effect in plan.effects}
    for kind, look in LOOKS.items():
        if kind in present and (why := look(scene, plan, present)):
            yield f"{words(kind.__name__)}: {why}"


def _gravity(scene, plan: Plan, present: dict) -> str | None:
    if any(scene.gravity):
        return None
    return "physics.gravity is zero along every axis; remove the key"


def _surface(scene, plan: Plan, present: dict) -> str | None:
    if scene.has_free_surface:
        return None
    return (
        "the fluid has no free surface at the start; remove physics.free_surface, and the pair loop "
        "has one sum less"
    )


def _numerical(scene, plan: Plan, present: dict) -> str | None:
    friction = present[ArtificialViscosity]
    if friction.alpha or friction.beta:
        return None
    return "both of its coefficients are zero; remove physics.artificial_viscosity"


def _laminar(scene, plan: Plan, present: dict) -> str | None:
    if not scene.expected_speed > 0.0 and not any(scene.gravity):
        return "nothing moves at the start and there is no gravity, so it has nothing to act on"
    if ArtificialViscosity not in present:
        return None
    own = plan.extremes.viscosity
    numerical = present[ArtificialViscosity].alpha * scene.sound_speed * scene.smoothing_length / 8.0
    if own > UNSEEN * numerical:
        return None
    return (
        f"its {own:g} m2/s are negligible beside the {numerical:.2g} m2/s of "
        "physics.artificial_viscosity (alpha c h/8); remove fluids.*.viscosity, or lower alpha"
    )


LOOKS = {
    Gravity: _gravity,
    FreeSurface: _surface,
    ArtificialViscosity: _numerical,
    LaminarViscosity: _laminar,
}
"""For each effect the check whether it is idle in a scene."""
