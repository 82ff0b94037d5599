"""Effects that a scene calls for and that nothing in it can feel."""

from collections.abc import Iterator

from psph.physics.gravity import Gravity
from psph.physics.surface import FreeSurface
from psph.physics.viscosity import ArtificialViscosity, LaminarViscosity
from psph.solver.plan import Plan, words

UNSEEN = 0.01
"""A fluid's own friction below this part of the numerical one is lost in it."""


def hints(scene, plan: Plan) -> Iterator[str]:
    """One line for each such effect: why, and what to take out."""
    present = {type(effect): effect for effect in plan.effects}
    for kind, look in LOOKS.items():
        if kind in present and (why := look(scene, plan, present)):
            yield f"{words(kind.__name__)}: {why}"


def _gravity(scene, plan: Plan, present: dict) -> str | None:
    if any(scene.gravity):
        return None
    return "physics.gravity is zero along every axis; the case can do without the key"


def _surface(scene, plan: Plan, present: dict) -> str | None:
    if scene.has_free_surface:
        return None
    return (
        "fluid, walls and periods leave no free surface at the start; without physics.free_surface "
        "the pair loop has one sum less"
    )


def _numerical(scene, plan: Plan, present: dict) -> str | None:
    friction = present[ArtificialViscosity]
    if friction.alpha or friction.beta:
        return None
    return "both of its coefficients are zero; take physics.artificial_viscosity out"


def _laminar(scene, plan: Plan, present: dict) -> str | None:
    if not scene.expected_speed > 0.0 and not any(scene.gravity):
        return "nothing moves at the start and nothing falls; there is no velocity gradient to feel it"
    if ArtificialViscosity not in present:
        return None
    own = plan.extremes.viscosity
    numerical = present[ArtificialViscosity].alpha * scene.sound_speed * scene.smoothing_length / 8.0
    if own > UNSEEN * numerical:
        return None
    return (
        f"its {own:g} m2/s are lost in the {numerical:.2g} m2/s that physics.artificial_viscosity "
        "stands for (alpha c h/8); take fluids.*.viscosity out, or lower alpha"
    )


LOOKS = {
    Gravity: _gravity,
    FreeSurface: _surface,
    ArtificialViscosity: _numerical,
    LaminarViscosity: _laminar,
}
"""For each effect the look at the scene that may find it idle."""
