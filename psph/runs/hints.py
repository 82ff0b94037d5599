"""What of a case has no influence on its scene, or less than it asks for."""

from collections.abc import Iterator

from psph.simulation.plan import Plan


def hints(scene, plan: Plan) -> Iterator[str]:
    """One line for each effect that finds itself idle: why, and what to remove; and one where friction serves
    for fewer passes than asked for.
    """
    for call in plan.called:
        if hasattr(call.effect, "idle") and (why := call.effect.idle(scene, plan.effects)):
            yield f"{call.title}: {why}"
    asked, served = scene.case.time.damping_every, plan.steps_held * plan.rate_passes
    if served < asked:
        yield (
            f"time.damping_every = {asked}: friction serves for {served} here; its limit of the step, or "
            "matter beside it, bears no more"
        )
