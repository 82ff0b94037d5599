"""The prediction of linear theory for the initial lattice of a scene."""

from collections.abc import Iterator

from psph.scene.species import Start
from psph.simulation.plan import Plan
from psph.theory.stability import FORMS, STATES, SYMMETRIC, parts
from psph.theory.stability.growth import growth, is_stable
from psph.theory.stability.lattices import OF_SCENES
from psph.theory.stability.uniform import STIFF, Settings
from psph.theory.stability.windows import SMOOTHINGS, windows

BY_SIGN = "tensile_control"
"""The form that is one of the theory's forms under compression and another under tension."""

NEAR = 1e-4
"""Relative change of density for the derivative of the pressure."""


def stability_forecast(scene, plan: Plan) -> Iterator[str]:
    """Whether small waves grow at the start, how fast, and which h/dx is stable; nothing where all keep their
    neighbours.  What kinds of matter say of it comes first."""
    for kind in plan.matter:
        for says, settings in kind.forecast(plan):
            yield says if settings is None else f"  {says:<20}{_verdict(settings)[1]}"
    if not any(part.flows for part in scene.layout.parts):
        return
    lattice, form = OF_SCENES[scene.dimensions], scene.case.physics.pressure_gradient
    yield (
        f"Stability of the {lattice} lattice at the start, {form} pressure gradient "
        "(linear theory, docs/stability.md)"
    )
    if form not in (*FORMS, BY_SIGN):
        yield f"  {'no forecast':<20}linear theory does not cover this form; docs/scheme.md has runs with it"
        return
    linear = (effect.linear(scene) for effect in plan.effects if hasattr(effect, "linear"))
    added = tuple(remedy for remedy in linear if remedy is not None)
    if scene.case.space.normalised:
        added += (parts.NormalisedGradient(),)
    verdicts = [_verdict(s) for s in _settings(scene, lattice, form, added)]
    yield from dict.fromkeys(f"  {state:<20}{says}" for state, says in verdicts)
    left = [call.title for call in plan.called if not hasattr(call.effect, "linear")]
    if left:
        yield f"  not included        {', '.join(left)}"


def _verdict(settings: Settings) -> tuple[str, str]:
    """The state (tension, compression or neutral), and whether the lattice is stable in it."""
    if settings.form != SYMMETRIC and not settings.remedies:
        return "neutral", (
            "a uniform pressure cancels: no wave grows, at any h/dx, and nothing restores the order "
            "of particles"
        )
    state, pressure = _state(settings), f"p = {settings.pressure:.3g} Pa"
    now = growth(settings)
    if now.stable:
        return state, f"stable at h/dx {settings.smoothing:g}, {pressure}"
    unit = (abs(settings.pressure) / settings.density) ** 0.5 / settings.spacing
    tried = SMOOTHINGS[::2] if settings.lattice == OF_SCENES[3] else SMOOTHINGS  # in 3D slower
    held = windows((h for h in tried if is_stable(settings._replace(smoothing=h))), tried)
    return state, (
        f"unstable at h/dx {settings.smoothing:g}, growth {now.rate / unit:.2g} √(|P|/ρ)/dx = "
        f"{now.rate:.3g}/s at {pressure}; "
        + (f"stable at h/dx {held}" if held else "no h/dx from 1 to 2 is stable")
    )


def _state(settings: Settings) -> str:
    return next(name for name, sign in STATES.items() if sign * settings.pressure > 0.0)


def _settings(scene, lattice: str, form: str, added: tuple) -> Iterator[Settings]:
    """One for each sign that the pressure has at the start; both where it has none yet."""
    space = scene.case.space
    for pressure, start in _extremes(scene):
        density, stiffness = _state_at(start, pressure)
        yield Settings(
            space.kernel,
            space.smoothing,
            lattice,
            pressure,
            _form(form, pressure),
            density,
            stiffness**0.5,
            space.spacing,
            added,
        )


def _form(form: str, pressure: float) -> str:
    """The form of tensile control inside a fluid under a pressure; other forms as they are."""
    if form != BY_SIGN:
        return form
    return SYMMETRIC if pressure > 0.0 else "difference"


def _state_at(start, pressure: float) -> tuple[float, float]:
    """ρ in kg/m^d and dp/dρ in m²/s² of a fluid under a pressure."""
    law, constants = start.law, (start.rest_density, start.sound_speed)
    density = float(law.density(pressure, *constants))
    ends = [law.pressure(density * (1.0 + step), *constants) for step in (-NEAR, NEAR)]
    return density, (ends[1] - ends[0]) / (2.0 * NEAR * density)


def _extremes(scene) -> Iterator[tuple[float, Start]]:
    """The largest pressure of each sign among the fluids, Pa, and the start of that fluid.

    Where a fluid starts without pressure, or with one that differs from place to place, p of
    both signs that c is made for: ρc²/100.
    """
    found: dict[bool, tuple[float, Start]] = {}
    for part, start in zip(scene.layout.parts, scene.starts.states):
        if not part.flows:
            continue
        own = start.layer.highest if start.layer else start.pressure
        expected = start.rest_density * (scene.sound_speed / STIFF) ** 2
        for pressure in (own,) if own else (expected, -expected):
            sign = pressure > 0.0
            if sign not in found or abs(pressure) > abs(found[sign][0]):
                found[sign] = pressure, start
    return iter(found.values())
