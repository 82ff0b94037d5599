"""Steps of their own that particles take: parts of one step of all, each as long as its particle bears.

A step of all has 2¹⁶ ticks.  A particle that has begun a step of its own, τ s long, is kicked by τ/2, drifts
by the same v½ while others end theirs, and is kicked by τ/2 at its end, where it has forces: a leapfrog.  In
between, t s after it began, others see

    v̂ = v½ + (t − τ/2) a,   û = u + t u̇.

As steps change their lengths û is predicted to first order: rates of earlier steps would be those of steps
of other lengths, and at the rim of a blast they are farther off than none (docs/gas.md).
"""

from typing import Any, NamedTuple

import numpy as np

from psph.engine.jit import elementwise, inside
from psph.fields import Field

TICKS = 2**16
"""Ticks of a step of all."""

FIRST = Field("first_kick", "1", "half steps of the simulation by which a particle is kicked first")
LAST = Field("last_kick", "1", "half steps by which it is kicked at its step's end; 0 while that goes on")
AHEAD = Field("seen_ahead", "1", "steps of the simulation from its first kick to the velocity that is seen")
STEP = Field("own_step", "s", "step of its own that a particle takes")
LONG = Field("own_step_ticks", "1", "ticks of that")
BEGUN = Field("own_step_begun", "1", "tick at which it has begun that")
OF_STEPS = (FIRST, LAST, AHEAD, STEP, LONG, BEGUN)
"""What particles carry that take steps of their own."""


class EachStep(NamedTuple):
    """Their arrays by column, in the order of OF_STEPS."""

    first: Any
    last: Any
    ahead: Any
    step: Any
    long: Any
    begun: Any


def steps_of(store) -> EachStep | None:
    """Those of a ``store``; None where all take the same step."""
    return EachStep(*(store[field.name] for field in OF_STEPS)) if LONG.name in store else None


@inside
def ends_step(own, k):
    """Whether the step of column ``k`` ends with that of the simulation; all do where ``own`` is None."""
    return True if own is None else own.last[k] > 0.0


@inside
def step_of(own, dt, k):
    """The step of column ``k``, s: ``dt`` where ``own`` is None."""
    return dt if own is None else own.step[k]


@elementwise
def turn(first, last, now, ticks, tick, of):
    """Where the columns ``first`` to ``last`` are in steps of their own in a step of the simulation, so many
    ``ticks`` from ``now`` on, each of ``tick`` s."""
    for k in range(np.uint64(first), np.uint64(last)):
        long, gone = of.long[k], now + ticks - of.begun[k]
        of.step[k] = long * tick
        of.first[k] = long / ticks if of.begun[k] == now else 0.0
        of.last[k] = long / ticks if gone == long else 0.0
        of.ahead[k] = (gone - 0.5 * long) / ticks


@elementwise
def predict_own_rows(first, last, dt, data, rows, of):
    """Evolve further fields: the first half of the kick where steps begin, and the value that forces read.

    Each row of ``rows`` (n, 5) names those of ``data`` that hold a component: its value, the predicted
    one, its rate, and those of earlier steps, which nobody reads here.
    """
    for n in range(len(rows)):
        value, predicted, rate = rows[n, 0], rows[n, 1], rows[n, 2]
        for k in range(np.uint64(first), np.uint64(last)):
            data[value, k] += 0.5 * dt * of.first[k] * data[rate, k]
            data[predicted, k] = data[value, k] + dt * of.ahead[k] * data[rate, k]


@elementwise
def kick_own_rows(first, last, dt, data, rows, of):
    """The second half of the kick of these fields where steps end, with the new rates."""
    for n in range(len(rows)):
        value, rate = rows[n, 0], rows[n, 2]
        for k in range(np.uint64(first), np.uint64(last)):
            data[value, k] += 0.5 * dt * of.last[k] * data[rate, k]
