"""What to try after a guard stopped a run of fluids, from the case and the particle at fault."""

from collections.abc import Iterator

from psph.case.schemes import STABLE
from psph.fields import FLUID
from psph.physics.facts import SOUND_OVER_SPEED
from psph.physics.walls.conditions import DYNAMIC
from psph.scene.pressureless_walls import unbearing_walls
from psph.scene.steps import finest_of, shorter_step
from psph.scene.walls import layers_needed, thinnest_walls

FASTER = 2.0
"""A larger c is proposed if the expected speed exceeds c/10 by this factor."""


def fluid_advice(scene, guard: str, suspect) -> Iterator[str]:
    """Things to try, the most promising first."""
    yield from _driven(scene, guard, suspect)
    yield from _long_step(scene, suspect.passes)
    yield from _scheme(scene)
    yield from _pressure(scene, suspect)
    yield from _walls(scene, guard, suspect)
    yield from _sound(scene, guard)
    yield from _friction(scene)
    yield from shorter_step(scene)


def _driven(scene, guard: str, suspect) -> Iterator[str]:
    c, speed = scene.sound_speed, suspect.speed
    if scene.layout.driven and guard in ("energy", "speed", "density") and speed > c / SOUND_OVER_SPEED:
        yield (
            f"raise physics.sound_speed to {SOUND_OVER_SPEED * speed:.3g} m/s or more: gravity along a "
            f"periodic axis drives this flow, it has reached c/{c / speed:.2g}, and c is meant for c/10"
        )


def _long_step(scene, passes: int) -> Iterator[str]:
    step, cfl = scene.case.time.step, scene.case.time.cfl
    h = finest_of(scene).smoothing_length
    limit = passes * cfl * h / (scene.sound_speed + scene.expected_speed)
    if step is not None and step > limit:
        yield f"remove time.step = {step:g}: time.cfl = {cfl:g} would allow {limit:.2g} s"


def _scheme(scene) -> Iterator[str]:
    if scene.case.scheme != STABLE and not any(part.flows and part.keeps_form for part in scene.layout.parts):
        yield f'try scheme = "{STABLE}" in place of "{scene.case.scheme}" and its keys'


def _pressure(scene, suspect) -> Iterator[str]:
    physics, open_air = scene.case.physics, scene.has_free_surface
    if not scene.case.fluids:
        return  # soils bear as much tension as they are told, and solids any
    if physics.pressure_gradient == "minimum" and open_air:
        yield ('give physics.pressure_gradient = "symmetric": "minimum" (p⁻) is unstable at a free surface')
    if not (suspect.value("pressure") < 0.0 or scene.lowest_pressure < 0.0):
        return
    if open_air and physics.tension_floor is None:
        yield "give physics.tension_floor = 0.98: the fluid is under tension"
    elif not open_air and physics.background_pressure is None:
        yield 'give physics.background_pressure = "auto": the fluid is under tension'


def _friction(scene) -> Iterator[str]:
    physics = scene.case.physics
    viscous = any(part.flows and part.table.rubs for part in scene.layout.parts)
    damped = physics.artificial_viscosity or physics.pair_damping or physics.reconstructed_damping
    if not damped and not viscous:
        yield "give physics.artificial_viscosity = 0.05: this fluid has no damping"


def _sound(scene, guard: str) -> Iterator[str]:
    c = scene.sound_speed
    expected = scene.speeds.undriven
    if not scene.case.fluids:
        if guard == "density":
            yield "give a larger young: densities differ by (speed/c)², and c is that of its waves"
        return
    if expected > FASTER * c / SOUND_OVER_SPEED:
        yield (
            f"raise physics.sound_speed to {SOUND_OVER_SPEED * expected:.3g} m/s, ten times the "
            f"expected speed; it is {c:g}"
        )
    elif guard == "density":
        yield f"raise physics.sound_speed from {c:.4g} m/s: densities differ by (speed/c)²"


def _walls(scene, guard: str, suspect) -> Iterator[str]:
    near_wall = (suspect.around.shown("kind") != FLUID).any()
    if guard != "depth" and not near_wall:
        return
    need, names = layers_needed(scene.layout), [material.name for material in scene.species]
    for name in unbearing_walls(scene):
        condition = scene.case.walls[name].condition
        yield (
            f'give walls.{name}.condition = "{DYNAMIC}": with "{condition}" it bears no '
            "pressure, and lets through what comes fast"
        )
    for material, (layers, _) in thinnest_walls(scene.layout).items():
        yield f"make walls.{names[material]} thicker: {need} spacings instead of {layers}"
    if guard == "depth":
        yield (
            "make the walls higher if it jumped over a rim; else use a finer space.spacing: a fast particle "
            "then interacts with more wall particles"
        )
