"""The limits of the time step of a plan."""

from collections.abc import Iterator

from psph.simulation.midway import pushes, room, together
from psph.simulation.paces import share_of_limit


def step_limits(plan, speed: float, acceleration: float) -> Iterator[tuple[float, str]]:
    """Every limit of the time step with its name, s, for the largest |v| and |a|."""
    for kind in plan.matter:
        yield from kind.limits(plan, speed, acceleration)
    yield from plan.limits_of_effects


def limits_of_effects(plan) -> Iterator[tuple[float, str]]:
    """Those that effects set, s, whatever |v| and |a| are."""
    frictions = []
    heeded = [effect for kind in plan.matter for effect in kind.heeds(plan)]
    for call in plan.called:
        if hasattr(call.effect, "longest_step") and not any(call.effect is one for one in heeded):
            share = share_of_limit(call.effect, plan.steps_held) * room(call.effect, plan.rate_passes)
            step = share * call.effect.longest_step(plan.extremes)
            frictions += [step] * pushes(call.effect)
            yield step, call.title
    if plan.midway and len(frictions) > 1:
        yield together(frictions), "all friction"
