"""What of a case has no influence on its scene, or less than it asks for."""

from collections.abc import Iterator

from psph.runs.forecast import long_run
from psph.simulation.paces import is_held
from psph.simulation.plan import Plan


def hints(scene, plan: Plan) -> Iterator[str]:
    """One line for each effect that finds itself idle: why, and what to remove; and one where friction serves
    for fewer passes than asked for.
    """
    for call in plan.called:
        if hasattr(call.effect, "idle") and (why := call.effect.idle(scene, plan.effects)):
            yield f"{call.title}: {why}"
    asked, served = scene.case.time.damping_every, plan.steps_held * plan.rate_passes
    if served < asked and _bears_held(plan):
        yield (
            f"time.damping_every = {asked}: friction serves for {served} here; its limit of the step bears "
            "no more"
        )


def plan_warnings(scene, plan: Plan, ranks: int) -> Iterator[str]:
    """For `check`, what only the plan of a scene tells: keys of the time that do nothing in it, and a run on
    so many ``ranks`` that takes long.
    """
    for line in _served_in_vain(scene, plan):
        yield f"{scene.case.file}: {line}"
    yield from long_run(scene, plan, ranks)


def _served_in_vain(scene, plan: Plan) -> Iterator[str]:
    time = scene.case.time
    if time.passes == 2 and not plan.midway:
        yield (
            "time.passes: 2 does nothing: not all that is in the scene bears it, so steps have one pass; "
            "remove it"
        )
    if time.lead and not plan.midway and not scene.case.preset("time.lead"):
        yield f"time.lead: {time.lead:g} does nothing in steps of one pass; set time.passes = 2, or remove it"
    if time.damping_every > plan.rate_passes and not _bears_held(plan):
        yield (
            f"time.damping_every: {time.damping_every} does nothing: what is in the scene needs friction in "
            "each step, or has none; remove it"
        )


def _bears_held(plan: Plan) -> bool:
    """Whether there is friction whose rates may serve for several steps, and all matter bears that."""
    return any(is_held(call.effect) for call in plan.called) and all(kind.bears_held for kind in plan.matter)
