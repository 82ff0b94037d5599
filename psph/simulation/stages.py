"""The stages of a step, in their order; kinds of matter add theirs: see :func:`stages_of`."""

from collections.abc import Iterator

import numpy as np

from psph.errors import Refused
from psph.parallel.reductions import largest
from psph.work import Stage


def stages_of(plan) -> Iterator[Stage]:
    """What a step of this plan does, in order: the stages of every step, and before each of them those that
    kinds of matter have there.  Raises Refused where a kind has one before a stage that there is not."""
    for kind in plan.matter:
        for other in sorted(kind.stages().keys() - OF_EVERY_STEP.keys()):
            known = ", ".join(OF_EVERY_STEP)
            raise Refused(f"{kind.name}: stages: {other}: no such stage; give one of {known}")
    for name, stage in OF_EVERY_STEP.items():
        for kind in plan.matter:
            if own := kind.stages().get(name):
                yield own
        yield stage


def nothing(simulation) -> None:
    """A stage that the start does without."""


def predict(simulation) -> None:
    """Kick, drift, and predict what the forces read at the end of the step; or drift to its middle, where the
    plan has a pass there."""
    engine = simulation.engine
    go = engine.go_midway if simulation.plan.midway else engine.predict
    with simulation.ledger("kick, drift, predict"):
        go(simulation.then, simulation.dt, simulation.previous_speed)


def go(simulation) -> None:
    """Predict; at the middle of a step the rest of the way is known, and whether lists hold till its end."""
    predict(simulation)
    if simulation.plan.midway:
        with simulation.ledger("skin"):
            simulation.listed = simulation.hold(simulation.dt)


def begin_prediction(simulation) -> None:
    """What the forces read at the start is what there is."""
    predict(simulation)
    if simulation.plan.midway:
        drift(simulation)


def renew_lists(simulation) -> None:
    """New lists where the old ones would not hold until the end of the step."""
    if not simulation.listed:
        simulation.rebuild()


def begin_lists(simulation) -> None:
    """The first lists, and what particles keep of the start."""
    simulation.rebuild()
    simulation.engine.begin()


def sum_midway(simulation) -> None:
    """The rate of density at the middle of the step, and the drift to its end, where the plan has them.

    Lists that were made at the middle may hold no longer at the end.
    """
    if not simulation.plan.midway:
        return
    with simulation.ledger("skin"):
        holds = simulation.listed or simulation.hold(0.5 * simulation.dt)
    simulation.engine.sum_midway(ghosts_are_fresh=not simulation.listed)
    drift(simulation)
    if holds:
        simulation.listed = True
    else:
        simulation.rebuild()


def drift(simulation) -> None:
    """From the middle of the step to its end."""
    with simulation.ledger("kick, drift, predict"):
        simulation.engine.drift(simulation.then, simulation.dt, simulation.previous_speed)


def sum_over_pairs(simulation) -> None:
    """Every pass over the neighbours that is due."""
    at = simulation.then, simulation.dt
    simulation.engine.sum(simulation.is_due, *at, ghosts_are_fresh=not simulation.listed)


def begin_sums(simulation) -> None:
    """The first sums; twice where forces rest on those of the pass before."""
    sum_over_pairs(simulation)
    if simulation.plan.starts_twice:
        kick(simulation)
        find_limits(simulation)
        predict(simulation)
        simulation.listed = True
        sum_midway(simulation)
        for kind in simulation.engine.kinds:
            kind.sums_again()
        sum_over_pairs(simulation)


def kick(simulation) -> None:
    """The second kick, with the new rates."""
    # It bounds the shifts of the next step, whose speed is not known yet.
    bounds = [kind.uneven() for kind in simulation.engine.kinds] if simulation.plan.displaces else ()
    simulation.previous_speed = min([simulation.fluid_speed, *bounds])
    with simulation.ledger("kick"):
        simulation.own_extremes = simulation.engine.kick(
            simulation.then, simulation.dt, simulation.previous_speed
        )


def begin_rates(simulation) -> None:
    """The first rates, which are those of earlier steps too, and a kick without length."""
    simulation.engine.begin_rates()
    kick(simulation)


def find_limits(simulation) -> None:
    """The largest speeds, acceleration, strain, word and shift over all ranks.

    A scene without shifts or moving walls sends no number for them.
    """
    *extremes, shift2, wall2 = simulation.own_extremes
    displaces, moves = simulation.plan.displaces, simulation.plan.moves_walls
    with simulation.ledger("limits"):
        sent = [*extremes, simulation.request(), *([shift2] * displaces), *([wall2] * moves)]
        maxima = largest(simulation.comm, sent)
    simulation.fluid_speed, simulation.acceleration = np.sqrt(maxima[:2]).tolist()
    simulation.strain, simulation.requested = maxima[2:4].tolist()
    simulation.shift = float(np.sqrt(maxima[4]) if displaces else 0.0)
    walls = float(np.sqrt(maxima[-1]) if moves else 0.0)
    simulation.speed = max(simulation.fluid_speed, walls)
    simulation.impacts.see(simulation.acceleration)


OF_EVERY_STEP = {
    "predict": Stage(go, begin_prediction),
    "renew_lists": Stage(renew_lists, begin_lists),
    "sum_midway": Stage(sum_midway, sum_midway),
    "sum_over_pairs": Stage(sum_over_pairs, begin_sums),
    "kick": Stage(kick, begin_rates),
    "find_limits": Stage(find_limits, find_limits),
}
"""The stages of every step, in order, by the names before which kinds of matter have theirs."""
