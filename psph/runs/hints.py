"""Effects of a scene that have no influence on it."""

from collections.abc import Iterator

from psph.simulation.plan import Plan


def hints(scene, plan: Plan) -> Iterator[str]:
    """One line for each effect that finds itself idle: why, and what to remove."""
    for call in plan.called:
        if hasattr(call.effect, "idle") and (why := call.effect.idle(scene, plan.effects)):
            yield f"{call.title}: {why}"
