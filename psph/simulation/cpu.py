"""The engine of a rank: its particles, their lists and records, and the compiled loops over them.

All that depends on how sums are computed on a processor lies behind these few methods.
"""

from collections.abc import Callable, Iterable, Iterator
from typing import Any

import numpy as np

from psph.composition.space import softening
from psph.engine.settled import Settled, settled
from psph.engine.threads import in_threads
from psph.fields import seen_at, view_of
from psph.output.ledger import Ledger
from psph.particles.records import Records
from psph.particles.store import Store
from psph.physics.motion import COUPLE, HELD_COUPLE
from psph.simulation.bounded import admit_kicked, admit_predicted
from psph.simulation.evolving import Evolving
from psph.simulation.integrator import kick, kick_drift_predict, settle_given_pressure, state_of
from psph.simulation.midway import drift_to_end, kick_to_middle
from psph.simulation.neighbourhood import Neighbourhood
from psph.simulation.pair_loops import PairLoops
from psph.simulation.pairs import Around, Metric
from psph.simulation.passes import Pass, written_seldom
from psph.simulation.plan import Plan
from psph.simulation.poses import Poses, corners_of
from psph.simulation.pulls import potentials
from psph.simulation.rules import Columns, Rules
from psph.work import Rank

ON_DUE = np.array([False, True])
"""In the place of the groups that are loaded, where columns are numbered 1 if they are due, else 0."""


class Engine:
    """Advances and sums the particles of ``store``, a rank's share of a scene, as ``plan`` says.

    Methods that end in new ghosts or lists are collective over ``comm``.
    """

    def __init__(self, scene, plan: Plan, store: Store, comm, ledger: Ledger):
        self.plan, self.store, self.ledger = plan, store, ledger
        self.neighbourhood = Neighbourhood(scene, plan, store, comm)
        self.domain = self.neighbourhood.domain
        seldom = written_seldom(plan.passes)
        self.records = [Records(store, one.neighbour_fields, plan.space, {}, seldom) for one in plan.passes]
        rank = Rank(scene, plan, store, self.domain, ledger)
        self.kinds = tuple(work for kind in plan.matter for work in kind.work(rank))
        movers = tuple(work for work in self.kinds if work.rows)
        groups = plan.materials
        self.poses = Poses(
            groups.rigid, corners_of(scene, plan), scene.frame, scene.gravity, movers, plan.midway is not None
        )
        for work in self.kinds:
            work.meet(self.poses.maps)
        self._rules = Rules(
            plan.carriers,
            groups.laws,
            groups.law_of,
            groups.given_pressure,
            groups.free,
            groups.motions,
            groups.motion_of,
            self.poses.maps,
            groups.pose_of if groups.rigid else None,
            self.poses.frame,
            scene.layout.periods,
            plan.pulls.booked,
            next((work.own_steps for work in self.kinds if work.own_steps), None),
            plan.ahead,
        )
        self._midway_rules = self._rules._replace(poses=self.poses.middle)
        self._predict, self._kick = settled(kick_drift_predict), settled(kick)
        self._state = settled(state_of)
        self._to_middle, self._to_end = settled(kick_to_middle), settled(drift_to_end)
        self._evolving = Evolving(plan.evolving, store, self.each)
        self._unsent: set[str] = set()
        self._loops = PairLoops(plan, store, self.kinds)
        self._potential = settled(potentials)
        self._paid = 0.0
        self._bundles: dict[tuple, Columns] = {}
        self._viewed = self._carried = None

    def of(self, name: str) -> Any:
        """The work of that name, of a kind of matter (psph.kinds), or None."""
        return next((work for work in self.kinds if work.name == name), None)

    def parts(self, whole: float) -> Iterator[tuple[float, bool]]:
        """Steps, s, of which one of ``whole`` s is made, and whether others follow."""
        told = (kind.parts(whole) for kind in self.kinds)
        if own := next(filter(None, told), None):
            yield from own
            return
        for left in reversed(range(self.plan.pace)):
            yield whole / self.plan.pace, left > 0

    def predict(self, time: float, dt: float, largest_speed: float) -> None:
        """Kick, drift to ``time`` and predict; ``largest_speed`` bounds displacements, m/s."""
        self.each(self._predict, time, dt, self._rules, self.view(largest_speed), self.columns())
        for kind in self.kinds:
            kind.advance(time, dt, largest_speed)
        self._evolving.predict(dt)
        if bounds := self.plan.bounds:
            value = self.store[self.store.seen_as(bounds.bounds.name)]
            self.each(admit_predicted, bounds, self._rules, self.view(largest_speed), value, self.columns())
        self._evolving.make_room()
        if self._rules.own is None:
            self.store.rotate("density_rate", "density_rate_1", "density_rate_2")

    def go_midway(self, time: float, dt: float, largest_speed: float) -> None:
        """Kick, and drift to the middle of a step of ``dt`` s that ends at ``time``."""
        view = self.view(largest_speed)
        self.each(self._to_middle, time - 0.5 * dt, dt, self._midway_rules, view, self.columns())

    def sum_midway(self, ghosts_are_fresh: bool) -> None:
        """The pass at the middle of a step; ghosts are brought there unless they are."""
        one = self.plan.midway
        if ghosts_are_fresh:
            self._sum_all(one)
        else:
            self._sum_while_refreshing(one, self._due_ghosts(one, one.moved))

    def drift(self, time: float, dt: float, largest_speed: float) -> None:
        """Drift from the middle of a step to ``time``, its end."""
        self.each(self._to_end, time, dt, self._rules, self.view(largest_speed), self.columns())

    def kick(self, time: float, dt: float, largest_speed: float) -> list[float]:
        """The second kick.  Returns the largest |v|², |a|², strain, squared shift and |v|² of walls here."""
        self._evolving.kick(dt)
        lag = None if self.plan.midway else 0.5 * dt
        parts = self.each(self._kick, time, dt, lag, self._rules, self.view(largest_speed), self.columns())
        if bounds := self.plan.bounds:
            rest = (self.store[name] for name in (bounds.bounds.name, "density", bounds.remembers.name))
            self.each(admit_kicked, bounds, self.view(largest_speed), *rest)
        parts = [*parts, *filter(None, [kind.kick(dt) for kind in self.kinds])]
        return list(map(max, *parts)) if len(parts) > 1 else list(parts[0])

    def rebuild(self) -> None:
        """Put every particle where it belongs and list its neighbours."""
        with self.ledger("rebuild"):
            self.neighbourhood.update(self.spent_on_pairs(), self.kinds)
        self._unsent.clear()
        with self.ledger("records"):
            self._fit_records()
        for kind in self.kinds:
            kind.settle()

    def begin(self) -> None:
        """What particles keep of the start, from where they stand then; lists have to be there."""
        self.neighbourhood.begin()
        for kind in self.kinds:
            kind.begin()

    def sum(self, is_due: Callable[[Pass], bool], time: float, dt: float, ghosts_are_fresh: bool) -> None:
        """Every pass that ``is_due`` in the step of ``dt`` s that ends at ``time``, s.  The first brings
        ghosts up to date unless they are; each what was written before it, in earlier steps too."""
        for kind in self.kinds:
            kind.before_sums(dt)
        stale = self.plan.renewed if ghosts_are_fresh else self.plan.refreshed
        for one in self.plan.passes:
            if one.midway or not is_due(one):
                continue
            if fields := self._due_ghosts(one, stale):
                self._sum_while_refreshing(one, fields)
            else:
                self._sum_all(one)
            if one.gives_rates and not one.holds:
                self._add_held_couples()
            if one.settles:
                self.each(settle_given_pressure, self._rules, self.view(0.0), self.columns())
            stale, self._unsent = (), self._unsent | one.written
            self.records[one.place].settle()
            for records in self.records:
                records.renew(one.written)
        self.neighbourhood.mark()
        for kind in self.kinds:
            kind.after_sums(time, dt)

    def _due_ghosts(self, one: Pass, stale: tuple[str, ...]) -> tuple[str, ...]:
        """What ghosts need before a pass: what is ``stale``, and what passes wrote since it was sent."""
        fields = stale + tuple(name for name in one.brought if name in self._unsent and name not in stale)
        self._unsent.difference_update(fields)
        return fields

    def settle_pressure(self, largest_speed: float, ranges: Iterable[tuple[int, int]] | None = None) -> None:
        """Pressure and 1/ρ from the density at the end of the step, for whoever reads them, of some
        ``ranges`` of columns or of all.  After a step of two passes they stand there: the pressure of its
        forces, which the next step reads."""
        every = [(self.store.low, self.store.low + self.store.owned)]
        for first, last in every if ranges is None else ranges:
            if not self.plan.midway:
                self.bear(first, last, largest_speed)
        for kind in self.kinds:
            kind.measure()

    def bear(self, first: int, last: int, largest_speed: float) -> None:
        """Pressure and 1/ρ of the columns ``first`` to ``last`` from their density."""
        self._state(first, last, self._rules, self.view(largest_speed), self.columns())

    def shown_pressure(self) -> np.ndarray:
        """The pressure of this rank's particles, Pa (n,), as :meth:`settle_pressure` has left it; of elastic
        solids that of their stress."""
        pressure = self.store.shown("pressure")
        for kind in self.kinds:
            pressure = kind.with_pressure(pressure)
        return pressure

    def potential(self) -> np.ndarray:
        """Potential energy by mass of this rank's particles, J/kg (n,), but for that of uniform pulls."""
        energies = np.zeros(self.store.total)
        if held := self.plan.pulls.held:
            self.each(self._potential, held, self.store.view(), energies)
        return energies[self.store.inner]

    def stored_energy(self) -> float:
        """Energy that kinds of matter store, as solids do by their deformation, J; collective."""
        return sum(kind.energy() for kind in self.kinds)

    def state(self) -> dict:
        """What the next steps of kinds of matter rest on beside their particles."""
        return {key: value for kind in self.kinds for key, value in kind.state().items()}

    def booked(self) -> list[float]:
        """What kinds of matter add to log.csv; collective."""
        return [value for kind in self.kinds for value in kind.booked()]

    def begin_rates(self) -> None:
        """The rates of earlier steps, before there were any, are the first ones."""
        names = [] if self.plan.midway else ["density"]
        for name in (*names, *(field.name for field in self.plan.evolving)):
            now = self.store.rows[f"{name}_rate"]
            for older in ("_rate_1", "_rate_2"):
                self.store.data[list(self.store.rows[f"{name}{older}"])] = self.store.data[list(now)]

    def take_up(self, saved) -> None:
        """The lists as they were made, then everything as it was when ``saved`` was written."""
        self.neighbourhood.take_up(saved.state["lower"], saved.state["upper"], saved.state["skin"])
        saved.fill(self.store)
        for kind in self.kinds:
            kind.restore(saved.state["poses"])
        self.poses.turn_to(saved.state["time"])
        if self.plan.passes:
            self.domain.halo.refresh(self.domain.ghost_fields + self.plan.refreshed)
        self.neighbourhood.sort_out(self.kinds)  # what ghosts are counts too
        self._fit_records()
        for records in self.records:
            records.fill(0, self.store.total)
        for kind in self.kinds:
            kind.settle()
        self.neighbourhood.restore(saved.state["skin"])

    def bytes_held(self) -> int:
        """Bytes of this rank's particles, records and lists."""
        tables = (records.table for records in self.records)
        arrays: list[np.ndarray] = [
            self.store.data,
            self.store.id,
            self.store.group,
            *tables,
            *self.neighbourhood.arrays,
        ]
        held = sum(kind.bytes_held() for kind in self.kinds)
        return held + sum(a.nbytes for a in arrays)

    def spent_on_pairs(self) -> float:
        """Seconds of this rank's pair loop since this was last asked."""
        paid, self._paid = self._paid, self.ledger.seconds["pairs"]
        return max(self._paid - paid, 0.0)  # whoever holds the ledger may have cleared it

    def _fit_records(self) -> None:
        """Room for the records of new columns, and for the longest of new lists."""
        for records in self.records:
            records.make_room()
        if self.records:
            longest = self.neighbourhood.longest
            length = self.domain.cutoff if self.plan.sizes else self.plan.smoothing_length
            self.softening = softening(self.plan.space, length, longest)

    def each(self, loop, *args) -> list:
        """A loop over the columns of the owned particles."""
        return in_threads(loop, self.store.low, self.store.low + self.store.owned, *args)

    def _sum_all(self, one: Pass) -> None:
        with self.ledger("records"):
            self.records[one.place].fill(0, self.store.total)
        with self.ledger("pairs"):
            self.sum_columns(one, self.store.low, self.store.low + self.store.owned)

    def _sum_while_refreshing(self, one: Pass, fields: tuple[str, ...]) -> None:
        """Interior particles are summed while the halo travels, then the rim."""
        first, last = self.domain.interior()
        loops = [*self._loops_of(one)]
        halo, records = self.domain.halo, self.records[one.place]
        begin, end = self.store.low, self.store.low + self.store.owned
        with self.ledger("halo"):
            halo.start(fields)
        with self.ledger("records"):
            records.fill(begin, end)
        with self.ledger("pairs"):
            self._run(one, loops, first, last)
        with self.ledger("halo"):
            halo.finish(fields)
        with self.ledger("records"):
            records.fill(0, begin)
            records.fill(end, self.store.total)
        with self.ledger("pairs"):
            self._run(one, loops, begin, first)
            self._run(one, loops, last, end)

    def sum_columns(self, one: Pass, first: int, last: int) -> None:
        """One pass over the neighbours of the particles in some columns."""
        self._run(one, [*self._loops_of(one)], first, last)

    def _run(self, one: Pass, loops: list, first: int, last: int) -> None:
        """The ``loops`` of a pass over some columns."""
        if first == last:
            return
        for loop, args in loops:
            in_threads(loop, first, last, *args)
        loaded = self.plan.materials.loaded is not None and not self.plan.finer
        if one.gives_rates and not one.midway and loaded:
            for columns, lists in self.neighbourhood.dry_beside_fluid(first, last):
                self._load_dry(one, *loops[0], columns, lists)

    def _add_held_couples(self) -> None:
        """To the couples of the last pass those that serve for several steps."""
        s = self.store
        if HELD_COUPLE.name in s:
            for row, held in zip(s.rows[COUPLE.name], s.rows[HELD_COUPLE.name]):
                s.data[row, s.inner] += s.data[held, s.inner]

    def _load_dry(self, one: Pass, loop, args: tuple, columns: np.ndarray, lists) -> None:
        """The load alone of some ``columns``, walls that are dry, by the ``loop`` of loads: all else
        of them stays as without fluid."""
        summed, metric, view, around, sums = args
        due = np.zeros(self.store.total, np.uint8)
        due[columns] = 1
        asked = summed._replace(loads=summed.loads._replace(loaded=ON_DUE, group=due))
        filled = (name for name in (*one.gives[1:], *one.filled) if name in self.store)
        rows = [row for name in filled for row in self.store.rows[name]]
        kept, data = np.ix_(rows, columns), self.store.data
        before = data[kept]
        in_threads(loop, columns[0], columns[-1] + 1, asked, metric, view, around._replace(lists=lists), sums)
        data[kept] = before

    def prepare_sums(self, share: int, shares: int) -> None:
        """Compile or load one of so many ``shares`` of the passes, by their types alone."""
        self._fit_records()
        for one in self.plan.passes[share::shares]:
            for loop, args in self._loops_of(one):
                loop.prepare(self.store.low, self.store.low, *args)

    def _loops_of(self, one: Pass) -> Iterator[tuple[Settled, tuple]]:
        """The compiled loops of a pass, each with what it takes beside the columns."""
        s, plan, records = self.store, self.plan, self.records[one.place]
        around = Around(records.view(), records.table, s.low, *self.neighbourhood.of(one))
        return self._loops.of(one, (Metric(plan.kernel, plan.space, self.softening), s.view(), around))

    def columns(self) -> Columns:
        """The arrays that the step advances; no anchor where no motion asks for it."""
        s = self.store
        held = s.blocks, s.rows.get("density_rate")  # whose rows change places in each step
        if held not in self._bundles:
            arrays = (s[name] if name in s else None for name in Columns._fields[1:])
            self._bundles = {kept: one for kept, one in self._bundles.items() if kept[0] == s.blocks}
            self._bundles[held] = Columns(s.group, *arrays)
        return self._bundles[held]

    def view(self, largest_speed: float):
        """The particles as the plan's carriers see them; a displacement also sees the largest speed."""
        view = self.store.view()
        if view is not self._viewed:
            names = self.plan.carried
            self._viewed, self._carried = view, view_of(names)(*(getattr(view, name) for name in names))
        return seen_at(self._carried, largest_speed)
