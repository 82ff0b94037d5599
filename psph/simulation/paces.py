"""For how many steps the rates of slow effects serve: two clocks, that of sound and that of friction."""

import math
from collections.abc import Iterable

from psph.fields import HELD_ACCELERATION, HELD_DENSITY_RATE, Field
from psph.physics.motion import HELD_COUPLE
from psph.simulation.midway import cfl_of, pushes, room, together

PACES = (8, 4, 2)
"""Steps for which they serve where their limits do not bear what is asked for."""

WORTH = 0.97
"""A step shorter by this factor is made up for by what held rates save."""


def is_held(effect) -> bool:
    """Whether the rates of an effect may serve for several steps: those of friction, and other slow ones."""
    return bool(getattr(effect, "held", False))


def steps_held(scene, effects: Iterable, extremes, kinds, rate_passes: int = 1) -> int:
    """For how many steps of so many ``rate_passes`` the rates of the held ones among the ``effects`` serve.

    As many as ``time.damping_every`` asks for, in passes, or fewer where their limits of the time step would
    make it shorter than the rest of the scene takes it; 1 where a kind of matter does not bear it.
    """
    effects = tuple(effects)
    asked = scene.case.time.damping_every // rate_passes if any(map(is_held, effects)) else 1
    if asked <= 1 or not all(kind.bears_held for kind in kinds):
        return 1
    limited = [one for one in effects if hasattr(one, "longest_step")]
    sound = cfl_of(scene, rate_passes) * scene.smoothing_length / extremes.sound_speed
    free = [one for one in limited if not is_held(one)]
    rest = [sound, *(room(one, rate_passes) * one.longest_step(extremes) for one in free)]
    longest = scene.case.time.step or WORTH * min(rest)
    own = [(one.longest_step(extremes), one) for one in limited if is_held(one)]
    beside = [one.longest_step(extremes) for one in free if pushes(one)]
    paces = sorted({asked, *(n for n in PACES if n < asked)}, reverse=True)
    for n in paces:
        steps = [step * share_of_limit(one, n) for step, one in own]
        if min(steps, default=math.inf) >= longest and (
            rate_passes == 1 or together(steps + beside) >= longest
        ):
            return n
    return 1


def held_parts(effect, scene) -> tuple:
    """The parts of an effect where rates serve for several steps: the one that is held, and one that acts in
    each where the effect says so (``held_apart``)."""
    return effect.held_apart(scene) if hasattr(effect, "held_apart") else (effect,)


def share_of_limit(effect, steps: int) -> float:
    """2/(N + 1) of a held one, else 1: which part of its limit of the step an effect stands where held rates
    serve for N ``steps``.

    What decays at the rate λ by a force of every N-th step and is predicted with the one before it follows
    v̂ₘ₊₁ = v̂ₘ − NλΔt v̂ₘ − ½λΔt (v̂ₘ − v̂ₘ₋₁): stable for (N + 1) λΔt < 2.  In every step it is for λΔt < 1
    (psph.simulation.integrator).
    """
    return 2.0 / (steps + 1) if is_held(effect) else 1.0


def held_fields(effects: Iterable, coupled: bool) -> tuple[Field, ...]:
    """What particles carry of the rates of these held effects; ``coupled``: of their moments too."""
    effects = tuple(effects)
    found = [HELD_ACCELERATION] if _any_has(effects, "radial", "shear", "push") else []
    found += [HELD_DENSITY_RATE] if _any_has(effects, "density_rate") else []
    return (*found, *([HELD_COUPLE] if coupled and _any_has(effects, "shear", "push") else []))


def _any_has(effects: tuple, *methods: str) -> bool:
    return any(hasattr(effect, name) for effect in effects for name in methods)
