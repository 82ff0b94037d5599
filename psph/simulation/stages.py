"""The stages of a step, in their order.  A scene has those that it needs: see :func:`stages_of`."""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from psph.parallel.reductions import largest
from psph.physics.region import next_time


class Stage(NamedTuple):
    """Declared work of a step: both take the simulation, and are collective.

    ``run`` takes it from one state within a step to the next.  ``begin`` is the same before the first step,
    of a step without length: the start goes through the stages as every step does.
    """

    run: Callable[..., None]
    begin: Callable[..., None]


def stages_of(plan) -> Iterator[Stage]:
    """What a step of this plan does, in order."""
    yield Stage(predict, predict)
    if plan.regions:
        yield Stage(populate, nothing)
    yield Stage(renew_lists, begin_lists)
    yield Stage(sum_over_pairs, begin_sums)
    if plan.floats:
        yield Stage(push_bodies, push_bodies)
    yield Stage(kick, begin_rates)
    if plan.absorbs:
        yield Stage(measure_levels, measure_levels)
    yield Stage(find_limits, find_limits)


def nothing(simulation) -> None:
    """A stage that the start does without."""


def predict(simulation) -> None:
    """Kick, drift, and predict what the forces read at the end of the step."""
    with simulation.ledger("kick, drift, predict"):
        simulation.engine.predict(simulation.then, simulation.dt, simulation.previous_speed)


def populate(simulation) -> None:
    """Take particles out and let others in, where new lists are due or a region asks for them."""
    regions = [region for region, _ in simulation.plan.regions]
    if simulation.listed and next_time(regions, simulation.time) > simulation.then:
        return
    with simulation.ledger("populate"):
        simulation.population.renew(simulation.then)
    simulation.listed = False


def renew_lists(simulation) -> None:
    """New lists where the old ones would not hold until the end of the step."""
    if not simulation.listed:
        simulation.rebuild()


def begin_lists(simulation) -> None:
    """The first lists, and what particles keep of the start."""
    simulation.rebuild()
    simulation.engine.begin()


def sum_over_pairs(simulation) -> None:
    """Every pass over the neighbours that is due."""
    at = simulation.steps, simulation.then, simulation.dt
    simulation.engine.sum(*at, ghosts_are_fresh=not simulation.listed, at_once=simulation.impacts.lasts)


def begin_sums(simulation) -> None:
    """The first sums; twice where forces rest on those of the pass before."""
    sum_over_pairs(simulation)
    if simulation.plan.starts_twice:
        kick(simulation)
        find_limits(simulation)
        predict(simulation)
        simulation.listed = True
        sum_over_pairs(simulation)


def push_bodies(simulation) -> None:
    """The second kick of rigid bodies, with the new forces."""
    with simulation.ledger("bodies"):
        simulation.engine.push_bodies(simulation.then, simulation.dt)


def kick(simulation) -> None:
    """The second kick, with the new rates."""
    simulation.previous_speed = (
        simulation.fluid_speed
    )  # bounds the shifts of the next step, whose speed is not known
    with simulation.ledger("kick"):
        simulation.own_extremes = simulation.engine.kick(
            simulation.then, simulation.dt, simulation.previous_speed
        )


def begin_rates(simulation) -> None:
    """The first rates, which are those of earlier steps too, and a kick without length."""
    simulation.engine.begin_rates()
    kick(simulation)


def measure_levels(simulation) -> None:
    """How high the water stands before the paddles that answer to it."""
    with simulation.ledger("paddles"):
        simulation.engine.poses.paddles.answer(simulation, simulation.then, simulation.dt)


def find_limits(simulation) -> None:
    """The largest speeds, acceleration, strain, word and shift over all ranks.

    A scene without shifts or moving walls sends no number for them.
    """
    *extremes, shift2, wall2 = simulation.own_extremes
    displaces, moves = simulation.plan.displaces, simulation.plan.moves_walls
    with simulation.ledger("limits"):
        sent = [*extremes, simulation.request(), *([shift2] * displaces), *([wall2] * moves)]
        found = largest(simulation.comm, sent)
    simulation.fluid_speed, simulation.acceleration = np.sqrt(found[:2]).tolist()
    simulation.strain, simulation.requested = found[2:4].tolist()
    simulation.shift = float(np.sqrt(found[4]) if displaces else 0.0)
    walls = float(np.sqrt(found[-1]) if moves else 0.0)
    simulation.speed = max(simulation.fluid_speed, walls)
    simulation.impacts.see(simulation.acceleration)
