"""What to try after a guard stopped a run, from the case and the particle at fault."""

from collections.abc import Iterator

from psph.case.running import GuardKeys
from psph.kinds import kinds_in
from psph.scene.steps import shorter_step


def advice(scene, guard: str, suspect) -> list[str]:
    """Things to try, the most promising first; at least one."""
    if guard == "overlap":
        return [
            "let a motion that forces a body into another end before, or let the other give way",
            *shorter_step(scene),
            *_bound(guard),
        ]
    of_kinds = [line for kind in kinds_in(scene) for line in kind.advice(guard, suspect)]
    return [*of_kinds, *_bound(guard)] or [*shorter_step(scene)]


def _bound(guard: str) -> Iterator[str]:
    if guard in GuardKeys.model_fields:
        yield (
            f'raise guards.{guard} if this is intended, or give guards.on_trouble = "warn" to '
            "continue in spite of it"
        )
