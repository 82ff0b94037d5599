"""What of the state at the start is likely not meant: pressures, surfaces, speeds of sound."""

from collections.abc import Iterator

from psph.case.findings import asked_of
from psph.case.fluids import HYDROSTATIC
from psph.physics.facts import SOUND_OVER_SPEED
from psph.scene.fluid.periodic_gravity import driven_speed
from psph.scene.fluid.still import felt_gravity, stills_of
from psph.scene.scene import Scene

TOO_FAST = 0.2
"""Mach number that a flow should stay below: its density then varies by some per cent."""


def start_warnings(scene: Scene) -> Iterator[str]:
    """A line for each fluid that starts without the pressure of its own weight, since the case gives none."""
    silent = {n: name for n, (name, one) in enumerate(scene.case.fluids.items()) if is_silent(one)}
    if not silent or not any(felt_gravity(scene.layout)) or not scene.has_free_surface:
        return
    for number, still in stills_of(scene.census, [*silent]).items():
        taut = scene.case.fluids[silent[number]].surface_tension
        drop = f", of a drop {'2 ' * (scene.dimensions == 3)}surface_tension/radius" if taut else ""
        if still.highest > 0.0:
            yield (
                f"fluids.{silent[number]}.pressure: not given, so it starts at 0 Pa and sinks under its own "
                f"weight: pressures swing between 0 and {2.0 * still.highest:.3g} Pa at first; give "
                f'"{HYDROSTATIC}"{drop}, or 0 if that is meant'
            )


def is_silent(fluid) -> bool:
    """Whether the case says nothing of a fluid's pressure at the start."""
    return "pressure" not in fluid.model_fields_set


def effect_warnings(scene: Scene) -> Iterator[str]:
    """What the effects that the case asks for warn of, a line each."""
    for name, _, effect in asked_of(scene.case):
        if hasattr(effect, "warns"):
            yield from (f"physics.{name}: {says}" for says in effect.warns(scene))


def driven_flow(scene: Scene) -> Iterator[str]:
    """A warning of a speed of sound that is given, and is too low for what gravity can drive."""
    given, speed = scene.case.physics.sound_speed, driven_speed(scene.census)
    if given is not None and speed > TOO_FAST * given:
        yield (
            f"physics.sound_speed: {given:.3g} m/s is less than ten times the {speed:.3g} m/s "
            "that gravity along a periodic axis can drive this flow to by time.end (g t, at most "
            "g H²/(8ν) between walls, H twice the width where one side is free or a plane of symmetry, or "
            "what a rheology allows); "
            f"give {SOUND_OVER_SPEED * speed:.3g}, unless something else holds the flow back"
        )
