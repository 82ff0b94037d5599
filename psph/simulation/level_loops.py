"""Passes where particles are of several levels of sizes: the same loop for each, with other numbers."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from psph.composition.loads import Unloaded
from psph.fields import with_length
from psph.simulation.pairs import Summed
from psph.simulation.passes import Pass


def loops_of_levels(
    plan, one: Pass, loop, group: np.ndarray, seen: tuple, sums
) -> Iterator[tuple[Any, tuple]]:
    """The compiled ``loop`` of the pass ``one`` of a ``plan`` for each level of sizes, over its own particles
    by their ``group`` (columns,), with what it takes beside columns: what is ``seen``, where ``sums`` go."""
    metric, view, around = seen
    for level, others in zip((plan, *plan.finer), plan.materials.others):
        own, h = level.passes[one.place], level.smoothing_length
        summed = Summed(own.effects, own.reductions, Unloaded(others, group))
        shown = around._replace(shown=with_length(around.shown, h))
        yield loop, (summed, metric._replace(kernel=level.kernel), with_length(view, h), shown, sums)
