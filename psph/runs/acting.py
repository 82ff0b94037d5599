"""What acts on which matter of a scene, in words."""

from collections.abc import Iterator

from psph.acts import MATTER
from psph.case.corners import matter_in
from psph.simulation.plan import Plan

WIDTH = 28


def matter_lines(case, plan: Plan) -> Iterator[str]:
    """For each kind of matter which effects act on it; nothing where a scene has but one kind."""
    here = matter_in(case)
    if len(here) < 2:
        return
    yield "What acts on what, beside the pushes of neighbours (docs/acts.md)"
    for kind in (one for one in MATTER if one in here):
        own = [call.name for call in plan.called if kind in call.acts]
        others = [call.name for call in plan.called if kind not in call.acts]
        says = ", ".join(own) or "none of these effects"
        if len(others) < len(own):
            says = f"all of these effects but {', '.join(others)}" if others else "all of these effects"
        yield f"  {kind:<{WIDTH}}{says}"
