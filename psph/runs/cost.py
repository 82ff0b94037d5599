"""What a run cost: the ledger of time as a table, the pair loop shared out among its effects."""

from collections.abc import Iterator
from typing import NamedTuple

from psph.simulation.plan import Plan

PAIRS = "pairs"
"""The ledger's name of the pair loop."""

REST = "the rest"
"""What no part of a step was measured as."""


class Spent(NamedTuple):
    """What ``steps`` steps took, ``seconds``, and its ``parts`` by :func:`costs`."""

    seconds: float
    steps: int
    parts: list[tuple[str, float]]


def costs(plan: Plan, periods: tuple, spent: dict[str, float], whole: float) -> list[tuple[str, float]]:
    """(what, s), the dearest first: the parts of a step as measured, of the pair loop each effect; last what
    is left of the ``whole`` s.

    An effect's part of the pair loop is estimated by its operations: those that the loop would do
    without if the effect were absent.  What remains is what all share, distances and the kernel.
    """
    rest = (REST, whole - sum(spent.values()))
    if not plan.passes:
        return [*sorted(spent.items(), key=lambda part: -part[1]), rest]
    everything = plan.flops_per_pair(periods)
    a_flop = spent.get(PAIRS, 0.0) / everything
    parts = {name: seconds for name, seconds in spent.items() if name != PAIRS}
    parts[SHARED] = spent.get(PAIRS, 0.0)
    for call in plan.called:
        others = tuple(e for e in plan.effects if e is not call.effect)
        if own := everything - plan.flops_per_pair(periods, others):
            parts[f"{PAIRS}: {call.title}"] = own * a_flop
            parts[SHARED] -= own * a_flop
    return [*sorted(parts.items(), key=lambda part: -part[1]), rest]


SHARED = f"{PAIRS}: distances, kernel, fetching"
"""What no single effect pays for."""


def cost_lines(parts: list[tuple[str, float]], whole: float) -> Iterator[str]:
    """The ``parts`` of the ``whole`` s that a run cost in lines: what, seconds, share."""
    width = max(len(name) for name, _ in parts)
    for name, seconds in parts:
        yield f"  {name:<{width}}  {seconds:9.3f} s  {100 * seconds / whole:5.1f} %"
    if any(name == SHARED for name, _ in parts):
        yield f"  ({PAIRS}: measured as one; among effects by their share of its operations)"
