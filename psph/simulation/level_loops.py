"""Passes where particles are of several levels of sizes: the same loop for each, with other numbers."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from psph.composition.loads import Couple, Loads, Unloaded
from psph.composition.mirrors import with_own_rows
from psph.engine.settled import settled
from psph.fields import with_length
from psph.physics.motion import COUPLE, LOAD
from psph.simulation.level_clock import LevelClock
from psph.simulation.pairs import Summed, Sums, sum_over_neighbours
from psph.simulation.passes import Pass

PARTS = LEADING, NEAR, FAR = range(3)
"""What a particle is to the passes: it has all sums, as who leads and walls have; it follows beside who leads
and has its own sums alone; it follows farther off, or is a wall there that has no pressure but by a sum, and
has those now and then."""


SELDOM = 2
"""Steps of a level for which the state and the sums serve of those who follow where nobody sees them who
leads."""


class LevelLoops:
    """The passes of a ``plan`` over the particles of a ``store`` that are of several levels.

    Nobody who follows needs a force.  ``role`` (columns,) has len(PARTS) · level + part of each column.
    """

    def __init__(self, plan, store, clock: LevelClock):
        self.plan, self.store, self._clock = plan, store, clock
        self.role = np.zeros(0, np.uint8)
        self._pushing: Any = None
        self._own = np.uint64(0)
        self._levels = (plan, *plan.finer)
        self._following = [settled(sum_over_neighbours) for _ in plan.passes]
        self._pushes = settled(sum_over_neighbours)
        loaded = plan.materials.loaded
        self._loaded = () if loaded is None else [loaded & ~others for others in plan.materials.others]

    def push_by(self, pushing, mirrors) -> None:
        """Walls and bodies whose load is asked for are pushed by rows of the leading fluid ``pushing``, each
        on its own level, and by what ``mirrors`` show of it, or None: what the fluid does is told once,
        wherever levels are there twice."""
        seen, self._pushing = with_own_rows(mirrors, self.store.total, pushing)
        self._own = np.uint64(0) if seen is None else seen.own

    def of(self, one: Pass, loop, seen: tuple, sums) -> Iterator[tuple[Any, tuple]]:
        """The compiled ``loop`` of the pass ``one`` for each level that needs it, and those of who follows
        and of loads, with what each takes beside columns: what is ``seen``, where ``sums`` go."""
        due, far = self._clock.due(one), self._clock.every(SELDOM)
        for level in np.flatnonzero(due).tolist():
            own, told = self._seen(level, one, seen)
            follows = {NEAR, FAR} if far[level] else {NEAR}
            if not one.gives_rates:
                yield loop, (Summed((), own.reductions, self._but(level, {LEADING} | follows)), *told, sums)
                continue
            yield loop, (Summed(own.effects, own.reductions, self._but(level, {LEADING})), *told, sums)
            if own.reductions:
                alone = Summed((), own.reductions, self._but(level, follows))
                yield self._following[one.place], (alone, *told, Sums(None, None, sums.written))
        if one.gives_rates and self._pushing is not None:
            yield from self._loads(one, seen, due)

    def _seen(self, level: int, one: Pass, seen: tuple) -> tuple[Pass, tuple]:
        """The pass with the numbers of a ``level``, and what is ``seen`` with its smoothing length."""
        plan, (metric, view, around) = self._levels[level], seen
        h = plan.smoothing_length
        shown = around._replace(shown=with_length(around.shown, h))
        return plan.passes[one.place], (metric._replace(kernel=plan.kernel), with_length(view, h), shown)

    def _but(self, level: int, parts: set[int]) -> Unloaded:
        """A pass over some ``parts`` of a ``level`` alone."""
        others = np.ones(len(PARTS) * len(self._levels), bool)
        others[[len(PARTS) * level + part for part in parts]] = False
        return Unloaded(others, self.role)

    def _loads(self, one: Pass, seen: tuple, due: np.ndarray) -> Iterator[tuple[Any, tuple]]:
        """The push of the leading fluid on each level that is ``due`` (levels,)."""
        s = self.store
        for level in np.flatnonzero(due).tolist() if self._loaded else ():
            loaded = self._loaded[level]
            own, (metric, view, around) = self._seen(level, one, seen)
            couples = ((Couple(own.effects),), (s[COUPLE.name],)) if COUPLE.name in s else ((), ())
            summed = Summed(own.effects, couples[0], Loads(loaded, s.group))
            mirrors = around.mirrors and around.mirrors._replace(own=self._own)
            told = metric, view, around._replace(lists=self._pushing, mirrors=mirrors)
            yield self._pushes, (summed, *told, Sums(s[LOAD.name], None, couples[1]))
