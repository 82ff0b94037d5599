"""How many steps a run will take, and about how long: a guess before anything is compiled.

The pace is that of psph on one machine (docs/performance.md); another may be twice as fast or as
slow.  ``psph bench`` measures the machine at hand.
"""

import math
from collections.abc import Iterator
from typing import NamedTuple

from psph.kinds import count_of
from psph.output.progress import duration
from psph.scene.sites import sites_within
from psph.simulation.plan import Plan

STEP, PARTICLE, FLOP = 3e-5, 4e-8, 1.1e-10
"""Seconds of a step whatever the particles, of a particle in it apart from its pairs, and of an
operation of a pair, lists and halo included: by the measured rates of docs/performance.md."""

LONGEST = 7 * 86400.0
"""Seconds: a run that is longer is likely not meant."""

MOST_USUAL_STEPS = 5e7
"""Steps of a run, about fifty times those of a long one: more are likely not meant."""


class Forecast(NamedTuple):
    """Steps of a run, the name of the limit that sets their length, and about how many seconds."""

    steps: int
    limit: str
    seconds: float


def forecast(scene, plan: Plan, ranks: int) -> Forecast:
    """What a run of a scene will take on so many ranks, a core each."""
    step, limit = plan.longest_step(scene.expected_speed, pull(scene))
    steps = math.ceil(scene.case.time.end / step)
    flops = (
        plan.flops_per_pair(scene.layout.periods)
        if plan.passes
        else max(kind.flops() for kind in plan.matter)
    )
    neighbours = sites_within(scene, scene.support)
    each = PARTICLE + neighbours * flops * FLOP
    summed = count_of(scene) - sum(kind.waiting(plan) for kind in plan.matter)
    return Forecast(steps, limit, steps * (STEP + each * summed / ranks))


def forecast_lines(found: Forecast, ranks: int, end: float) -> Iterator[str]:
    """The forecast for a run to ``end`` s, in words."""
    where = "1 rank" if ranks == 1 else f"{ranks} ranks"
    yield f"  expected            {found.steps:,} steps to {end:g} s, limited by {found.limit}"
    yield (
        f"  run time            about {duration(max(found.seconds, 1.0))} on {where}, a guess by the pace of "
        "docs/performance.md; `python -m psph bench` measures this machine"
    )


def long_run(scene, plan: Plan, ranks: int) -> Iterator[str]:
    """A warning where a run will take longer than is likely meant."""
    found = forecast(scene, plan, ranks)
    if found.seconds <= LONGEST and found.steps <= MOST_USUAL_STEPS:
        return
    where = "1 rank" if ranks == 1 else f"{ranks} ranks"
    yield (
        f"{scene.case.file}: time.end: {scene.case.time.end:g} s takes about {found.steps:.2g} steps "
        f"and, at a guess, {duration(found.seconds)} on {where}; {_cure(plan, found.limit)}"
    )


def pull(scene) -> float:
    """The acceleration to expect, m/s²."""
    return math.hypot(*scene.gravity)


def _cure(plan: Plan, limit: str) -> str:
    """What to do about a limit of the step that makes a run long."""
    own = (cure for kind in plan.matter if (cure := kind.cure(limit)))
    return next(own, "") or (
        f"{limit} limits the step: take a larger space.spacing, an earlier time.end, a lower "
        "physics.sound_speed, or more ranks, and look at the units"
    )
