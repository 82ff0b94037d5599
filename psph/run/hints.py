"""Effects of a scene that have no influence on it."""

from collections.abc import Iterator

from psph.simulation.plan import Plan, words


def hints(scene, plan: Plan) -> Iterator[str]:
    """One line for each effect that finds itself idle: why, and what to remove."""
    for effect in plan.effects:
        if hasattr(effect, "idle") and (why := effect.idle(scene, plan.effects)):
            yield f"{words(type(effect).__name__)}: {why}"
