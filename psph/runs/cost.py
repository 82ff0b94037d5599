"""What a run cost: the ledger of time as a table, the pair loop shared out among its effects."""

from collections.abc import Iterator

from psph.simulation.plan import Plan

PAIRS = "pairs"
"""The ledger's name of the pair loop."""


def costs(plan: Plan, periods: tuple, spent: dict[str, float]) -> Iterator[tuple[str, float]]:
    """(what, s), the dearest first: the parts of a step as measured, of the pair loop each effect.

    An effect's part of the pair loop is estimated by its operations: those that the loop would do
    without if the effect were absent.  What remains is what all share, distances and the kernel.
    """
    if not plan.passes:
        return iter(sorted(spent.items(), key=lambda part: -part[1]))
    everything = plan.flops_per_pair(periods)
    a_flop = spent.get(PAIRS, 0.0) / everything
    parts = {name: seconds for name, seconds in spent.items() if name != PAIRS}
    parts[SHARED] = spent.get(PAIRS, 0.0)
    for call in plan.called:
        others = tuple(e for e in plan.effects if e is not call.effect)
        if own := everything - plan.flops_per_pair(periods, others):
            parts[f"{PAIRS}: {call.title}"] = own * a_flop
            parts[SHARED] -= own * a_flop
    return iter(sorted(parts.items(), key=lambda part: -part[1]))


SHARED = f"{PAIRS}: distances, kernel, fetching"
"""What no single effect pays for."""


def cost_lines(plan: Plan, periods: tuple, spent: dict[str, float], whole: float) -> Iterator[str]:
    """The table in lines: what, seconds, share of the ``whole`` s."""
    rows = [*costs(plan, periods, spent), ("the rest", whole - sum(spent.values()))]
    width = max(len(name) for name, _ in rows)
    for name, seconds in rows:
        yield f"  {name:<{width}}  {seconds:9.3f} s  {100 * seconds / whole:5.1f} %"
    if plan.passes:
        yield f"  ({PAIRS}: measured as one; among effects by their share of its operations)"
