"""Steps of their own that particles of a gas take: how long each is, and who is woken.

A step is as long as its particle bears by itself, and FINER times what any in its list bears at the most:
a power of two of ticks, so that steps end together.  What a shock reaches bears less from one of its steps
to the next: who sleeps meanwhile in a longer one than that allows is woken, and ends it with the step of the
simulation that goes on.  Saitoh & Makino (2009), ApJ 697, L99.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from psph.composition.loads import Unloaded
from psph.engine.jit import elementwise
from psph.engine.threads import in_threads
from psph.errors import Unbearable
from psph.parallel.reductions import largest, whole_sums
from psph.physics.gas.state import (
    EARLIER_LENGTH,
    GROWTH_RATE,
    HEAT,
    INVERSE_LENGTH,
    LENGTH,
    LISTED_LENGTH,
    LONGEST,
    SIGNAL,
)
from psph.simulation.each_step import LAST, TICKS, steps_of, turn
from psph.simulation.pairs import Summed
from psph.work import Rank

FINER = 2.0
"""A step is no longer than so many times what one in the list bears.  Saitoh & Makino have 4: a blast is
hardly quicker by that, and keeps its energy four times worse (docs/gas.md)."""

ROUNDING = 1e-9
"""Part of itself by which a step may be longer than its limit."""

MOST_GROWTH = 0.2
"""Part of itself by which a smoothing length changes at the most while its particle sleeps."""

ASLEEP = np.array([False, True])
"""Whether a pass leaves out who is numbered 0, or 1."""

NEVER = 1e-300
"""Instead of a time of zero, s."""


class Shorter(Unbearable):
    """A particle that bears no step in a step of all; raised on all ranks."""


class Limits(NamedTuple):
    """What limits a step: so many times h over the ``signal`` speed, √(h/|a|) for a ``push``, and so much of
    its heat for what is ``cooling``; ``tiny`` is the least heat, J/kg."""

    signal: float
    push: float
    cooling: float
    tiny: float


class ToLimit(NamedTuple):
    """Arrays by column from which limits are found, and the limit itself; ``due`` is above 0 where a step
    ends."""

    signal: Any
    length: Any
    acceleration: Any
    heating: Any
    heat: Any
    longest: Any
    due: Any


class Sleeping(NamedTuple):
    """Arrays by column: h, 1/h, ρ, 1/ρ; h at the end of the step before, and the rate of h since, 1/s."""

    length: Any
    inverse: Any
    density: Any
    volume: Any
    before: Any
    growth: Any


@elementwise
def find_limits(first, last, low, limits, finer, lists, of, found):
    """How long steps the columns ``first`` to ``last`` bear whose own end, s, to ``found`` (owned,).

    Those in their ``lists`` bear what was told before this step of the simulation.  Returns the largest
    signal/h and −u̇/u, 1/s, and |a|/h, 1/s².
    """
    fastest, pushed, cooled = 0.0, 0.0, 0.0
    for k in range(np.uint64(first), np.uint64(last)):
        if of.due[k] > 0.0:
            row, a2 = k - np.uint64(low), 0.0
            for a in of.acceleration:
                a2 += a[k] ** 2
            signal, push = of.signal[k] / of.length[k], np.sqrt(a2) / of.length[k]
            cooling = max(0.0, -of.heating[k] / max(of.heat[k], limits.tiny))
            fastest, pushed, cooled = max(fastest, signal), max(pushed, push), max(cooled, cooling)
            longest = min(limits.signal / signal, limits.push / np.sqrt(push), limits.cooling / cooling)
            begin = lists.begin[row]
            for n in range(begin, begin + np.uint64(lists.lengths[row])):
                longest = min(longest, finer * of.longest[lists.lists[n]])
            found[row] = longest
    return fastest, pushed, cooled


@elementwise
def go_on(first, last, low, now, tick, found, of, sizes, longest):
    """The columns ``first`` to ``last`` whose steps end ``now``, in ticks, begin others no longer than what
    was ``found`` (owned,), s; −1 times the earliest end, the longest limit, and −1 times the shortest."""
    end, most, least = np.inf, 0.0, np.inf
    for k in range(np.uint64(first), np.uint64(last)):
        if of.last[k] > 0.0:
            longest[k], gone = found[k - np.uint64(low)], of.step[k]
            rate = (sizes.length[k] / sizes.before[k] - 1.0) / gone if gone > 0.0 else 0.0
            sizes.before[k] = sizes.length[k]
            of.long[k], of.begun[k] = fitting(now, longest[k], tick), now
            most_rate = MOST_GROWTH / max(of.long[k] * tick, NEVER)
            sizes.growth[k] = min(max(rate, -most_rate), most_rate)
        end = min(end, of.begun[k] + of.long[k])
        most, least = max(most, longest[k]), min(least, longest[k])
    return -end, most, -least


@elementwise
def fitting(now, longest, tick):
    """Ticks of a step that begins ``now`` and is no longer than ``longest`` s: the largest power of two that
    divides both now and those of a step of all, or one."""
    long = float(TICKS)
    while long > 1.0 and (long * tick > longest * (1.0 + ROUNDING) or now % long != 0.0):
        long *= 0.5
    return long


@elementwise
def begin_steps(first, last, tick, of, longest):
    """The columns ``first`` to ``last`` begin steps, all at once; −1 times the earliest end."""
    end = np.inf
    for k in range(np.uint64(first), np.uint64(last)):
        of.long[k], of.begun[k] = fitting(0.0, longest[k], tick), 0.0
        end = min(end, of.long[k])
    return -end


@elementwise
def tell(first, last, low, now, lists, of, longest, allowed):
    """Those in the columns ``first`` to ``last`` whose steps begin ``now`` tell all in their lists what they
    bear: ``allowed`` (columns,) is lowered to that.  In one thread: what is written is not theirs."""
    for k in range(np.uint64(first), np.uint64(last)):
        if of.begun[k] == now:
            begin = lists.begin[k - np.uint64(low)]
            for n in range(begin, begin + np.uint64(lists.lengths[k - np.uint64(low)])):
                j = lists.lists[n]
                allowed[j] = min(allowed[j], longest[k])


@elementwise
def ask(first, last, low, lists, of, longest, allowed):
    """Those in the columns ``first`` to ``last`` who sleep ask all in their lists what they bear."""
    for k in range(np.uint64(first), np.uint64(last)):
        if of.last[k] == 0.0:
            begin, least = lists.begin[k - np.uint64(low)], np.inf
            for n in range(begin, begin + np.uint64(lists.lengths[k - np.uint64(low)])):
                least = min(least, longest[lists.lists[n]])
            allowed[k] = least


@elementwise
def wake(first, last, low, finer, then, ticks, dt, of, allowed, velocity, acceleration, heat, heating, woken):
    """End the steps of those in columns ``first`` to ``last`` who sleep longer than ``finer`` times what is
    ``allowed``, s, at ``then``, after ``ticks`` of ``dt`` s; ``woken`` (owned,) tells who.

    Their first kick was by half of a longer step: it becomes one by half of this.
    """
    for k in range(np.uint64(first), np.uint64(last)):
        woken[k - np.uint64(low)] = of.last[k] == 0.0 and of.step[k] > finer * allowed[k] * (1.0 + ROUNDING)
        if woken[k - np.uint64(low)]:
            long = then - of.begun[k]
            step = dt * (long / ticks)
            less = 0.5 * (step - of.step[k])
            for d in range(len(velocity)):
                velocity[d][k] += less * acceleration[d][k]
            heat[k] += less * heating[k]
            of.long[k], of.step[k], of.last[k] = long, step, long / ticks


@elementwise
def grow(first, last, low, dt, due, most, listed, dimensions, sizes):
    """Lengths and densities of those in columns ``first`` to ``last`` who sleep go on as in their step
    before, h up to ``most`` (owned,) times the ``listed`` one."""
    for k in range(np.uint64(first), np.uint64(last)):
        if due[k] == 0.0:
            before, denser = sizes.length[k], 1.0
            h = min(before * (1.0 + sizes.growth[k] * dt), most[k - np.uint64(low)] * listed[k])
            for _ in range(dimensions):
                denser *= before / h
            sizes.length[k], sizes.inverse[k] = h, 1.0 / h
            sizes.density[k] *= denser
            sizes.volume[k] = 1.0 / sizes.density[k]


class GasSteps:
    """The clock of the steps of their own of a gas on a ``rank``.

    A step of all is at most 2^``halvings`` times the shortest.  ``pace`` is that of the plan, which this
    tells what limits the next step; ``limits`` are those of a particle.  The same on every rank.
    """

    def __init__(self, rank: Rank, pace, halvings: int, limits: Limits):
        self._plan, self._store, self._domain = rank.plan, rank.store, rank.domain
        self._pace, self._halvings, self._limits = pace, halvings, limits
        self._now, self._end, self._next, self._tick = 0, TICKS, TICKS, 0.0
        self._asleep = np.zeros(0, np.uint8)
        self.relisted = True
        """Whether lists are new since neighbours were last asked."""
        self._due, self._woken, self._all = 0, 0, 0

    def begin(self) -> None:
        """At the start all end a step, of no length."""
        self._store[LAST.name][self._store.inner] = 1.0

    def bring(self) -> None:
        """Ghosts come to bear what their owners bear; collective."""
        self._domain.halo.refresh((LONGEST.name,))

    def parts(self, whole: float) -> Iterator[tuple[float, bool]]:
        """Steps of the simulation, s, to the next end of a particle's each, of which one of all, ``whole`` s,
        is made; and whether others follow.  Collective."""
        self._tick, self._now = whole / TICKS, 0
        ends = self._each(begin_steps, self._tick, steps_of(self._store), self._store[LONGEST.name])
        self._end = -int(largest(self._domain.comm, [max(ends)])[0])
        while self._now < TICKS:
            self._next = TICKS  # without sums nobody begins another step
            self._each(turn, float(self._now), float(self._ticks), self._tick, steps_of(self._store))
            yield self._ticks * self._tick, self._end < TICKS
            self._now, self._end = self._end, self._next

    def wake(self, dt: float) -> None:
        """Who sleeps too long for its neighbours ends its step with this one, of ``dt`` s.

        Those tell who begin a step, few of all; who has ghosts in its list asks, and with new lists
        everyone.  Both find the same: who goes on with its step was told before.
        """
        s, low = self._store, self._store.low
        of, longest, lists = steps_of(s), s[LONGEST.name], self._domain.lists
        allowed, end = np.full(s.total, np.inf), low + s.owned
        asking, self.relisted = self.relisted, False
        first, last = (low, low) if asking else self._domain.interior()
        if not asking:
            tell(low, end, low, float(self._now), lists, of, longest, allowed)
        for begin, before in ((low, first), (last, end)):
            in_threads(ask, begin, before, low, lists, of, longest, allowed)
        moved = s["velocity"], s["acceleration"], s[HEAT.name], s[HEAT.rate]
        woken = np.zeros(s.owned, np.bool_)
        self._each(wake, low, FINER, float(self._end), float(self._ticks), dt, of, allowed, *moved, woken)
        self._woken += int(np.count_nonzero(woken))

    def settle(self, dt: float, most: np.ndarray) -> None:
        """Lengths of those who are due have been found; those of others grow for ``dt`` s, up to ``most``
        (owned,) times those of the lists."""
        s, due = self._store, self._store[LAST.name]
        told = due, most, s[LISTED_LENGTH.name], s.dimensions, self._sizes()
        self._each(grow, s.low, dt, *told)
        self._asleep = (due[: s.total] == 0.0).astype(np.uint8)
        self._due += s.owned - int(np.count_nonzero(self._asleep[s.inner]))
        self._all += s.owned

    def loops(self, one, loop, seen: tuple, sums) -> Iterator[tuple[Any, tuple]]:
        """The compiled ``loop`` of the pass ``one`` over those who are due."""
        due = Unloaded(ASLEEP, self._asleep)
        yield loop, (Summed(one.effects, one.reductions, due), *seen, sums)

    def after_sums(self) -> None:
        """Whose steps end begin others, and the limits of the next step of all.  Collective."""
        s, found, of = self._store, np.zeros(self._store.owned), steps_of(self._store)
        read = SIGNAL.name, LENGTH.name, "acceleration", HEAT.rate, HEAT.name, LONGEST.name, LAST.name
        told = self._domain.lists, ToLimit(*(s[name] for name in read)), found
        tops = self._each(find_limits, s.low, self._limits, FINER, *told)
        told = float(self._end), self._tick, found, of, self._sizes(), s[LONGEST.name]
        ends = self._each(go_on, s.low, *told)
        own = [*np.max(ends, axis=0), *np.max(tops, axis=0)]
        end, most, least, *self._pace.tops = largest(self._domain.comm, own).tolist()
        if -least < self._tick:
            raise Shorter(
                f"a particle bears a step of {-least:.3g} s, less than 1/{TICKS} of that of all, which was "
                f"2^{self._pace.doublings} of the shortest when it began; give a smaller time.halvings"
            )
        if self._end < TICKS:
            self._next = -int(end)
        self._pace.doublings = 0
        while self._pace.doublings < self._halvings and -2.0 * least * 2.0**self._pace.doublings <= most:
            self._pace.doublings += 1

    def passed(self) -> Iterator[str]:
        """How many had forces in a step, and were woken; collective."""
        due, woken, every = whole_sums(self._domain.comm, [self._due, self._woken, self._all]).tolist()
        if every:
            yield (
                f"steps of their own: {due / every:.1%} of all particles had forces in a step, "
                f"{woken / every:.2%} were woken for that"
            )

    @property
    def _ticks(self) -> int:
        """Those of the step of the simulation that goes on."""
        return self._end - self._now

    def _sizes(self) -> Sleeping:
        s, volume = self._store, "specific_volume"
        names = LENGTH.name, INVERSE_LENGTH.name, "density", volume, EARLIER_LENGTH.name, GROWTH_RATE.name
        return Sleeping(*(s[name] for name in names))

    def _each(self, loop, *args) -> list:
        return in_threads(loop, self._store.low, self._store.low + self._store.owned, *args)
