"""Ideal gases on a rank: smoothing lengths, density and pressure before the sums over pairs, the longest step
and the books after them."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

import numpy as np

from psph.engine.threads import in_rooms, in_threads
from psph.errors import Unbearable
from psph.parallel.reductions import exact_sums, largest
from psph.particles.neighbours import Neighbours, empty
from psph.particles.store import SPARE
from psph.physics.gas.state import (
    EVENNESS,
    HEAT,
    INVERSE_LENGTH,
    LENGTH,
    LISTED_LENGTH,
    LONGEST,
    SIGNAL,
    SOUND,
    UNEQUAL,
)
from psph.scene.parts.gas_sides import GasSide
from psph.simulation.each_step import LAST, steps_of
from psph.simulation.gas_shares import find_shares, shares_of
from psph.simulation.gas_steps import GasSteps
from psph.simulation.gas_streams import Streams
from psph.simulation.lengths import NONE, OUTGROWN, SWOLLEN, Lengths, Numbers, find_lengths, find_state
from psph.simulation.near_rows import AXES, SeenRows, images_in, rooms_for, table_of
from psph.smoothing import unit_kernel
from psph.work import Rank, Work

TINY = np.finfo(float).tiny

MOST_LISTS = 60
"""Times that lists are made anew for one step: particles that find no neighbours by then have none."""

PREDICTED = f"predicted_{HEAT.name}"


class Unsized(Unbearable):
    """A particle of a gas without a smoothing length, or without heat; raised on all ranks."""


LEAST_PREDICTED = 0.5
"""Share of a particle's heat, half a step kicked, below which it is not predicted: where a shock has passed
rates fall, and what goes on from those of earlier steps would be too low."""


class Pace:
    """What limits the time step of gases: the largest ``signal``/h and ``cooling``, −u̇/u, in 1/s, and
    ``push``, |a|/h in 1/s².  A step of all is 2^``doublings`` times the shortest of particles."""

    def __init__(self, signal: float):
        self.signal, self.push, self.cooling = signal, 0.0, 0.0
        self.doublings = 0

    @property
    def tops(self) -> list[float]:
        """All of them."""
        return [self.signal, self.push, self.cooling]

    @tops.setter
    def tops(self, tops: list[float]) -> None:
        self.signal, self.push, self.cooling = tops


class Gases(Work):
    """The particles of the ideal gases of a scene on a ``rank``.

    ``gamma`` holds γ of each group; ``pressures`` give that of the start, Pa (n,), at places (n, dim), by the
    groups of which the case tells it.  ``pace`` is that of the plan, the same on every rank.  ``least`` is
    the share of the viscosity where nothing shocks, None where particles have no shares; through ``sides`` of
    the domain gas comes and goes.  ``steps`` are those of their own that particles take, or None.
    """

    name = "ideal_gases"

    def __init__(
        self,
        rank: Rank,
        gamma: np.ndarray,
        pressures: Mapping[int, Callable[[np.ndarray], np.ndarray]],
        pace: Pace,
        least: float | None,
        sides: Sequence[GasSide] = (),
        steps: GasSteps | None = None,
    ):
        scene, self._plan, self._store, self._domain, _ = rank
        self._gamma, self._pressures, self._pace = gamma, pressures, pace
        self._least, self.steps = least, steps
        self.streams, self._names = Streams(sides, self._domain), [one.name for one in scene.species]
        kernel = unit_kernel(scene.kernel, scene.dimensions)
        target = scene.case.space.smoothing**scene.dimensions
        periods = (*scene.layout.periods, *(None,) * (AXES - scene.dimensions))
        self._room, self._nearer = np.zeros(0, np.uint64), empty(0, 0)
        self._asked = Numbers(scene.dimensions, target, kernel, kernel.support, periods)

    def begin(self) -> None:
        """Where the first layers of what comes in stand."""
        self.streams.begin()
        if self.steps:
            self.steps.begin()

    def parts(self, whole: float) -> Iterator[tuple[float, bool]] | None:
        """By the steps of their own of particles."""
        return self.steps.parts(whole) if self.steps else None

    def loops(self, one, loop, seen: tuple, sums) -> Iterable[tuple] | None:
        """Over those whose steps end."""
        return self.steps.loops(one, loop, seen, sums) if self.steps else None

    def passed(self) -> Iterator[str]:
        """What has come in and gone out, and who had forces in a step."""
        yield from self.streams.passed(self._names)
        yield from self.steps.passed() if self.steps else ()

    def settle(self) -> None:
        """New lists: room for rows of those alone that are close, which these are part of."""
        if self.steps:
            self.steps.relisted = True
        lists, owned, lanes = self._domain.lists, self._store.owned, self._plan.space.lanes
        padded = -(-lists.lengths[:owned].astype(np.uint64) // np.uint64(lanes)) * np.uint64(lanes)
        ends = np.cumsum(padded, dtype=np.uint64)
        self._room, needed = ends - padded, int(ends[-1]) if owned else 0
        if owned > len(self._nearer.begin) or needed > len(self._nearer.lists):
            self._nearer = empty(owned + owned // SPARE, needed + needed // SPARE)

    def fit(self, growth: np.ndarray, mirrors) -> tuple[bool, Neighbours]:
        """Find smoothing lengths and densities; whether lists reach far enough for that, and the rows that
        forces go through: of those alone that are close, of all where an h has grown too much for that.

        By ``growth`` (owned,) lengths may be larger than when lists were made.  ``mirrors`` show images, or
        None.  Collective.

        Raises Unsized where there is no solution.
        """
        store, columns = self._store, self._store.total
        came = np.zeros(columns, np.uint8)
        of_lengths = LENGTH.name, INVERSE_LENGTH.name
        filled = *of_lengths, "density", "specific_volume", UNEQUAL.name, EVENNESS.name
        found = Lengths(*(store[name] for name in filled), came)
        rows = store.low, self._domain.lists, self._nearer, self._plan.space.lanes, self._room
        table = table_of(store["position"], found.inverse, columns)
        images = images_in(mirrors, self._domain.cutoff)
        in_rooms(
            find_lengths,
            store.low,
            store.low + store.owned,
            rooms_for(self._domain.lists, images, store.owned),
            self._asked._replace(images=images),
            SeenRows(*rows, table, store.value("mass")),
            growth,
            store[LISTED_LENGTH.name],
            found,
            store[LAST.name] if self.steps else None,
        )
        own = came[store.inner]
        lost = self._worst(own == NONE)
        tops = [float((own == OUTGROWN).any()), float((own == SWOLLEN).any()), lost]
        outgrown, swollen, lost = largest(self._domain.comm, tops)
        if lost:
            raise Unsized(
                f"particle {int(lost) - 1}: no smoothing length gives it the neighbours that space.smoothing "
                "asks for; particles may stand in one place: give a smaller time.cfl"
            )
        return not outgrown, self._domain.lists if swollen else self._nearer

    def guess(self) -> None:
        """At the start, from which lengths the first are found; collective."""
        store = self._store
        store[INVERSE_LENGTH.name][store.inner] = 1.0 / store[LENGTH.name][store.inner]
        self._domain.halo.refresh((INVERSE_LENGTH.name,))

    def heat(self) -> None:
        """At the start, the thermal energy that gives each particle the pressure of the case."""
        store, inner = self._store, self._store.inner
        group, position, density = store.group[inner], store.owned_rows("position"), store["density"][inner]
        for number, pressure in self._pressures.items():
            own = group == number
            heat = pressure(position[own]) / ((self._gamma[number] - 1.0) * density[own])
            for name in (HEAT.name, PREDICTED):
                store[name][inner][own] = heat
        for side in self.streams.sides:
            if side.speed > 0.0 and side.group in self._pressures:
                for name in (HEAT.name, PREDICTED):
                    self.streams.even(side, store[name][inner])

    def press(self) -> None:
        """Pressure and speed of sound as the forces read them; raises Unsized where there is no heat left."""
        store = self._store
        heat = store[PREDICTED]
        own, least = heat[store.inner], LEAST_PREDICTED * store[HEAT.name][store.inner]
        np.maximum(own, least, out=own)
        [cold] = largest(self._domain.comm, [self._worst(~(own >= 0.0))])
        if cold:
            raise Unsized(
                f"particle {int(cold) - 1}: its thermal energy is below zero or no number: it expands by too "
                "much in a step; give a smaller time.cfl"
            )
        arrays = store.group, self._gamma, heat, store["density"], store["pressure"], store[SOUND.name]
        self._each(find_state, *arrays)

    def sums_again(self) -> None:
        """The pressure, which the prediction has by density alone; and what ghosts bear."""
        self.press()
        if self.steps:
            self.steps.bring()

    def after_sums(self, time: float, dt: float) -> None:
        """The largest of what limits the next step, over all ranks, and the shares of viscosity in it."""
        store, inner = self._store, self._store.inner
        self.streams.hold()
        if self._least is not None:
            told = self._least, self._asked.support, dt, steps_of(store), shares_of(store)
            self._each(find_shares, *told)
        if self.steps:
            self.steps.after_sums()
            return
        per_length = 1.0 / store[LENGTH.name][inner]
        push = np.sqrt(sum(a[inner] ** 2 for a in store["acceleration"])) * per_length
        signal = store[SIGNAL.name][inner] * per_length
        cooling = -store[HEAT.rate][inner] / np.maximum(store[HEAT.name][inner], TINY)
        tops = [one.max(initial=0.0) for one in (signal, push, cooling)]
        self._pace.tops = largest(self._domain.comm, tops).tolist()

    def measure(self) -> None:
        """The pressure at the end of the step, by the thermal energy there."""
        store = self._store
        arrays = store.group, self._gamma, store[HEAT.name], store["density"], store["pressure"]
        self._each(find_state, *arrays, store[SOUND.name])

    def energy(self) -> float:
        """Σ m u, J; the same bits on any number of ranks, collective."""
        store = self._store
        return float(
            exact_sums(self._domain.comm, (store.shown("mass") * store.shown(HEAT.name))[:, None])[0]
        )

    def booked(self) -> tuple[float, ...]:
        """The same."""
        return (self.energy(),)

    def bytes_held(self) -> int:
        """Those of rows of who is close, as far as they are filled."""
        rows = self._nearer
        return rows.begin.nbytes + rows.lengths.nbytes + 4 * int(rows.lengths[: self._store.owned].sum())

    def state(self) -> dict:
        """What sets the next step, and what has come and gone."""
        return {self.name: [self._pace.tops, self._pace.doublings, self.streams.state()]}

    def restore(self, state: dict) -> None:
        """Go on from there."""
        self._pace.tops, self._pace.doublings, streams = state[self.name]
        self.streams.restore(streams)

    def _each(self, loop, *args) -> None:
        in_threads(loop, self._store.low, self._store.low + self._store.owned, *args)

    def _worst(self, holds: np.ndarray) -> float:
        """One more than the largest number of a particle of which something ``holds`` (owned,), or 0."""
        return float(1 + self._store.id[self._store.inner][holds].max(initial=-1))


def check_lists(simulation) -> None:
    """Whether lists reach far enough for where the step has taken particles, and mirrors; where they do not
    gas comes and goes."""
    simulation.neighbourhood.move_mirrors(simulation.then)
    streams = simulation.engine.of(Gases.name).streams
    with simulation.ledger("skin"):
        simulation.listed = not streams.due(simulation.then) and simulation.neighbourhood.skin.reach()
    if not simulation.listed:
        streams.renew(simulation.then, simulation.population)


def find_sizes(simulation) -> None:
    """Smoothing lengths, densities and pressures at the new places; new lists where these reach too short."""
    gases, domain = simulation.engine.of(Gases.name), simulation.domain
    stale = ("position",) * simulation.listed + (LONGEST.name,) * (gases.steps is not None)
    if stale:
        with simulation.ledger("halo"):
            domain.halo.refresh(stale)
    if gases.steps:
        with simulation.ledger("lengths"):
            gases.steps.wake(simulation.dt)
    _fit(simulation, gases)
    gases.press()


def begin_sizes(simulation) -> None:
    """The same at the start, where the pressure of the case becomes heat."""
    gases = simulation.engine.of(Gases.name)
    gases.guess()
    simulation.neighbourhood.move_mirrors(simulation.time)
    if gases.steps:
        gases.steps.bring()
    _fit(simulation, gases)
    gases.heat()
    gases.press()


def _fit(simulation, gases: Gases) -> None:
    """Smoothing lengths, and lists that reach far enough for them."""
    for _ in range(MOST_LISTS):
        with simulation.ledger("lengths"):
            fits, nearer = gases.fit(simulation.neighbourhood.skin.growth, simulation.neighbourhood.mirrors)
        if fits:
            if gases.steps:
                gases.steps.settle(simulation.dt, simulation.neighbourhood.skin.growth)
            simulation.neighbourhood.meet(nearer)
            return
        simulation.rebuild()
        simulation.listed = False
        if gases.steps:
            gases.steps.bring()
    raise Unsized(
        f"a particle finds too few neighbours after {MOST_LISTS} lists, each longer; put "
        "more particles around it, or let an axis be periodic"
    )
