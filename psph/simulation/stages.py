"""The stages of a step, in their order.  A scene has those that it needs: see :func:`stages_of`."""

from collections.abc import Callable, Iterator

import numpy as np

from psph.parallel.reductions import largest
from psph.physics.region import next_time

Stage = Callable[..., None]
"""Takes the simulation from one state within a step to the next; collective."""


def stages_of(plan) -> Iterator[Stage]:
    """What a step of this plan does, in order."""
    yield predict
    if plan.regions:
        yield populate
    yield renew_lists
    yield sum_over_pairs
    if plan.floats:
        yield push_bodies
    yield kick
    if plan.absorbs:
        yield measure_levels
    yield find_limits


def predict(simulation) -> None:
    """Kick, drift, and predict what the forces read at the end of the step."""
    with simulation.ledger("kick, drift, predict"):
        simulation.engine.predict(simulation.then, simulation.dt, simulation.pace)


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


def sum_over_pairs(simulation) -> None:
    """Every pass over the neighbours that is due."""
    at = simulation.steps, simulation.then, simulation.dt
    simulation.engine.sum(*at, ghosts_are_fresh=not simulation.listed, at_once=simulation.impacts.lasts)


def push_bodies(simulation) -> None:
    """The second kick of rigid bodies, with the new forces."""
    with simulation.ledger("bodies"):
        simulation.engine.push_bodies(simulation.then, simulation.dt)


def kick(simulation) -> None:
    """The second kick, with the new rates."""
    simulation.pace = simulation.fluid_speed  # bounds the shifts of the next step, whose speed is not known
    with simulation.ledger("kick"):
        simulation.own_extremes = simulation.engine.kick(simulation.then, simulation.dt, simulation.pace)


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
        sent = [*extremes, simulation.word(), *([shift2] * displaces), *([wall2] * moves)]
        found = largest(simulation.comm, sent)
    simulation.fluid_speed, simulation.acceleration = np.sqrt(found[:2]).tolist()
    simulation.strain, simulation.heard = found[2:4].tolist()
    simulation.shift = float(np.sqrt(found[4]) if displaces else 0.0)
    walls = float(np.sqrt(found[-1]) if moves else 0.0)
    simulation.speed = max(simulation.fluid_speed, walls)
    simulation.impacts.see(simulation.acceleration)
