"""Gas that comes in through sides of the domain, and leaves through others.

Before a side gas is held: it goes on with the velocity and the heat that it has, whatever pushes it.  Behind
the last layer of what comes in another follows each time that it has gone by a spacing; what has left the
domain is taken out when lists are made.
"""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from psph.fields import POSITION
from psph.parallel.reductions import all_rows, largest, whole_sums
from psph.physics.gas.state import HEAT
from psph.scene.parts.gas_sides import GasSide

HELD = ("acceleration", HEAT.rate)
"""Rates of what is held, which are zero."""

SLACK = 1e-9
"""Part of a spacing by which a layer may lack of having gone by one."""


class Streams:
    """What comes and goes through ``sides`` on a rank; the same bits on any number of ranks."""

    def __init__(self, sides: Sequence[GasSide], domain):
        self.sides, self._domain = tuple(sides), domain
        self.layers, self.came, self.went = ([0] * len(self.sides) for _ in range(3))
        self._first: list[float] | None = None

    def begin(self) -> None:
        """Where the first layers stand; collective."""
        found = [-min((depth for depth in self._depths(side)), default=math.inf) for side in self.sides]
        self._first = (-largest(self._domain.comm, found)).tolist() if found else []

    def _depths(self, side: GasSide) -> np.ndarray:
        """How far inward of a side each owned particle of its gas is, m."""
        store = self._domain.store
        own = store.shown("group") == side.group
        return side.depth(store[POSITION.name][side.axis][store.inner][own])

    def held(self, side: GasSide) -> np.ndarray:
        """Who is held before a side (owned,)."""
        store = self._domain.store
        near = side.depth(store[POSITION.name][side.axis][store.inner]) < side.deep
        return near & (store.shown("group") == side.group)

    def even(self, side: GasSide, values: np.ndarray) -> None:
        """Give all that is held before a side the largest of ``values`` (owned,) in the innermost layers of
        it, if there is anything: at the start what stands at a side lacks neighbours; collective."""
        store = self._domain.store
        depth = side.depth(store[POSITION.name][side.axis][store.inner])
        held = self.held(side)
        [found] = largest(
            self._domain.comm, [values[held & (depth > side.deep - 1.5 * side.step)].max(initial=0.0)]
        )
        if found > 0.0:
            values[held] = found

    def hold(self) -> None:
        """Nothing accelerates or heats what is held."""
        store = self._domain.store
        for side in self.sides:
            columns = store.low + np.flatnonzero(self.held(side))
            for name in HELD:
                for row in store.rows[name]:
                    store.data[row, columns] = 0.0

    def due(self, time: float) -> bool:
        """Whether a layer comes in by ``time``, s: the same on every rank."""
        return any(self._asked(side, time) > n for side, n in zip(self.sides, self.layers))

    @staticmethod
    def _asked(side: GasSide, time: float) -> int:
        return int(math.floor(side.speed * time / side.step + SLACK))

    def renew(self, time: float, population) -> None:
        """Take out what has left, and let in what comes by ``time``, s; new lists have to follow.
        Collective."""
        for n, side in enumerate(self.sides):
            if side.speed == 0.0:
                self.went[n] += self._take_out(side)
            while self.layers[n] < self._asked(side, time):
                self.came[n] += self._let_in(n, time, population)
                self.layers[n] += 1

    def _take_out(self, side: GasSide) -> int:
        """Those of its gas that are beyond a side; how many they were."""
        store = self._domain.store
        gone = store.shown("group") == side.group
        gone = gone & (side.depth(store[POSITION.name][side.axis][store.inner]) < 0.0)
        staying = np.flatnonzero(~gone)
        [many] = whole_sums(self._domain.comm, [np.count_nonzero(gone)]).tolist()
        if many:
            store.reorder((store.low + staying).astype(np.uint32), 0, 0)
        return many

    def _let_in(self, n: int, time: float, population) -> int:
        """One layer more, as that is which came last; how many are in it."""
        store, side = self._domain.store, self.sides[n]
        last = self._first[n] + side.speed * time - self.layers[n] * side.step
        depth = side.depth(store[POSITION.name][side.axis][store.inner])
        layer = (store.shown("group") == side.group) & (np.abs(depth - last) < 0.5 * side.step)
        parents = np.flatnonzero(layer)
        ids = store.shown("id")[parents]
        everyone = np.sort(all_rows(self._domain.comm, ids))
        columns = store.low + parents
        groups, block = store.group[columns].copy(), store.data[:, columns].copy()
        block[store.rows[POSITION.name][side.axis]] -= side.sign * side.step
        store.append(population.next_id + np.searchsorted(everyone, ids), groups, block)
        population.next_id += len(everyone)
        return len(everyone)

    def passed(self, names: Sequence[str]) -> Iterator[str]:
        """Lines on what has come in and gone out, by the ``names`` of the groups."""
        for side, came, went in zip(self.sides, self.came, self.went):
            end = "lower" if side.sign > 0 else "upper"
            what = f"{came:,} particles came in" if side.speed else f"{went:,} particles went out"
            yield f"{names[side.group]}: {what} through {'xyz'[side.axis]}.{end}"

    def state(self) -> list:
        """What the next steps rest on."""
        return [self.layers, self.came, self.went, self._first]

    def restore(self, state: list) -> None:
        """Go on from there."""
        self.layers, self.came, self.went, self._first = state
