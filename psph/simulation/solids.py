"""The elastic solids of a simulation: their rows, their partners on other ranks, and the two passes."""

import numpy as np

from psph.composition.space import Metres, softening
from psph.engine.settled import settled
from psph.engine.threads import in_threads
from psph.parallel.domain import Extent
from psph.parallel.partner_halo import PartnerHalo, follow
from psph.parallel.reductions import exact_sums
from psph.parallel.reference import reference_rows
from psph.particles.others import keep_others
from psph.particles.partners import ReferenceRows, padded_lists
from psph.physics.solid.contact import CONTACT_ENERGY
from psph.physics.solid.deformation import (
    DRAWN,
    KERNEL,
    MOMENT,
    STORED,
    STRESS,
    STRESS_ZZ,
    VON_MISES,
    Gradient,
    GradientRate,
    pressure_of,
    support_of,
)
from psph.physics.solid.material import is_damped
from psph.physics.solid.shares import SHARE
from psph.scene.parts.order import among
from psph.simulation.materials import NOT_BONDED
from psph.simulation.solid_memory import Memory, memory_of
from psph.simulation.solid_pairs import (
    Matter,
    Rows,
    Weights,
    fill_places,
    measure,
    push_solids,
    sum_gradients,
    sum_inner_forces,
    sum_moments,
)
from psph.simulation.solid_parts import parts_of
from psph.simulation.solid_plan import solid_plan
from psph.simulation.solid_shares import shares_of
from psph.simulation.solid_table import SolidRecords
from psph.smoothing import kernel
from psph.work import Work

PLACES, FLUX = "position", "flux"
"""What partners need before the first pass of a step, and before the second."""

LOOSENED, STRENGTH = "loosened", "strength"
"""What is read of partners where solids crack: whether one lets go of its last bonds, how strong it is."""


class Solids(Work):
    """The solids of ``scene`` among the particles of ``store``, a rank's share of them.

    A row is a solid particle that this rank owns: first those whose partners it owns too, then the rest, each
    in the order of the columns.  Behind the rows of a table stand partners of other ranks.
    """

    name = "solids"

    def __init__(self, scene, plan, store, domain, ledger):
        self.scene, self.plan, self.store, self.domain, self.ledger = scene, plan, store, domain, ledger
        self.comm, d = domain.comm, scene.dimensions
        self._planned = planned = solid_plan(plan)
        solids, periods, self._h = planned.solids, domain.periods, planned.smoothing_length
        own, damped = kernel(KERNEL, self._h, d), is_damped(solids)
        finer = np.array([one.finer for one in solids], float)
        self._finer, self.supports = finer if (finer > 1.0).any() else None, support_of(self._h) / finer
        sums = (Gradient(periods), *([GradientRate()] if damped else []))
        numbers = (np.array([getattr(s, n) for s in solids]) for n in ("stiffness", "viscosity", "density"))
        self._matter = Matter(planned.laws, sums, None, *numbers)
        self._weights = Weights(own, periods, softening(Metres(periods), self._h, 0))
        self._volume = scene.spacing**d
        moving = {PLACES: d} | ({"predicted_velocity": d} if damped else {})
        self._widths = {"reference": d, **moving}, {"reference": d, PLACES: d, FLUX: d * d}
        self._moving = tuple(moving)
        self.clamps, self.loads, self._faces, self._cracks = parts_of(scene, plan, store, self.comm)
        if self._cracks:
            self._widths[1].update({LOOSENED: 1, STRENGTH: 1})
        self._solid_of = plan.materials.bonded_to
        self._rows = self.halo = None
        loops = (sum_moments, sum_gradients, sum_inner_forces, measure, push_solids, fill_places)
        self._moments, self._gradients, self._forces, self._measure, self._push, self._fill = map(
            settled, loops
        )

    def listed(self) -> None:
        """Solids feel only other ones in space."""
        if self._planned.alone:
            first, lists = self.store.low, self.domain.lists
            in_threads(keep_others, first, first + self.store.owned, first, lists, self.store["solid"])

    def begin(self) -> None:
        """The moments of the reference lists, and the loads; collective."""
        with self.ledger("records"):
            self._find_moments()
        if self.loads:
            self.loads.draw(self._columns, self._matter.number)

    def _find_moments(self) -> None:
        """L of all rows."""
        self._moment = tuple(np.zeros(self._owned) for _ in self.store.rows[MOMENT.name])
        self._each(self._moments, 0, self._owned, self._weights, self._around[0], self._moment)
        for row, component in zip(self.store[MOMENT.name], self._moment):
            row[self._columns] = component

    @property
    def columns(self) -> np.ndarray:
        """Those of the rows."""
        return self._columns

    def state(self) -> dict:
        """The part of the loads that acts."""
        return {"acting": self.loads.acting.tolist()} if self.loads else {}

    def restore(self, state: dict) -> None:
        """Go on from there."""
        if self.loads:
            self.loads.acting = np.array(state["acting"])

    def fill_masses(self, mass: np.ndarray) -> None:
        """The true masses of rows, kg, into the columns of all particles."""
        mass[self._columns] = self.masses

    def settle(self) -> None:
        """Rows and partners after particles have found new columns or ranks; the first time the reference
        lists are made, from X.  Collective."""
        store = self.store
        unknown = self._rows is None
        if unknown:
            self._rows = self._listed()
        group = self._solid_of[store.group[store.inner]]
        columns = store.low + np.flatnonzero(group != NOT_BONDED)
        self._rows = follow(self.comm, self._rows, store.id[columns])
        counts, partners = self._rows.chosen(store.id[columns])
        owned = np.sort(store.id[columns])
        place = np.minimum(np.searchsorted(owned, partners), max(len(owned) - 1, 0))
        abroad = owned[place] != partners if len(owned) else np.zeros(0, bool)
        rim = np.zeros(len(columns), bool)
        rim[np.repeat(np.arange(len(columns)), counts)[abroad]] = True
        order = np.argsort(rim, kind="stable")
        self._columns = columns[order].astype(np.uint64)
        self._owned, self._inner = len(columns), int(np.count_nonzero(~rim))
        self._matter = self._matter._replace(number=self._solid_of[store.group[columns[order]]])
        density, volume = self._matter.density[self._matter.number], self._volume
        if self._finer is not None:
            finer = self._finer[self._matter.number]
            self._weights, volume = self._weights._replace(finer=finer), volume / finer**store.dimensions
        self._inverse_density, self.masses = 1.0 / density, density * volume
        if self._faces:
            self._faces.settle(self._columns)
        if self.clamps:
            self.clamps.settle(self._columns, self.masses)
        self._make_tables(store.id[columns[order]], np.unique(partners[abroad]), unknown)
        if self.loads:
            self._matter = self._matter._replace(following=self.loads.following(self._columns))
        if SHARE.name in store:
            self._matter = self._matter._replace(share=store[SHARE.name][self._columns])
        self._moment = tuple(of[self._columns] for of in store[MOMENT.name])
        if self._cracks:
            self._cracks.weaken(self._around[1], self._moment)
            self._matter = self._matter._replace(intact=self._cracks.intact)

    def _make_tables(self, ids: np.ndarray, wanted: np.ndarray, unknown: bool) -> None:
        """Lists in places of the tables, and the messages that fill the places of partners; where shares are
        ``unknown`` yet, they too, from all bonds that there ever were."""
        if self.halo is not None:
            self.halo.free()
        self.halo = PartnerHalo(self.comm, ids, wanted)
        everyone = np.concatenate([ids, self.halo.ids])
        counts, partners = self._rows.chosen(ids)
        order = np.argsort(everyone, kind="stable")
        entries = order[np.searchsorted(everyone[order], partners)]
        whole = counts, entries
        if self._cracks:
            counts, entries = self._cracks.left(self._columns, counts, entries, Metres.lanes)
        lists = padded_lists(counts, entries, Metres.lanes)
        longest = int(whole[0].max(initial=0))
        self._weights = self._weights._replace(
            softening=softening(Metres(self.domain.periods), self._h, longest)
        )
        tables = [SolidRecords(widths, len(everyone), self._volume) for widths in self._widths]
        self._tables = tables
        self._around = tuple(Rows(one.view, one.records, lists) for one in tables)
        begin, end = tables[0].places[PLACES][0], tables[0].places[self._moving[-1]][1]
        self._to_first = self.halo.channel(tables[0].records, begin, end)
        end = tables[1].places[LOOSENED if self._cracks else FLUX][1]
        self._to_second = self.halo.channel(tables[1].records, tables[1].places[FLUX][0], end)
        self._force = tuple(np.zeros(self._owned) for _ in range(self.store.dimensions))
        self._places = self.halo.channel(tables[1].records, *tables[1].places[PLACES])
        for table in tables:
            self._put(table, "reference", 0, self._owned)
            self._bring_of(table, "reference")
        if unknown and SHARE.name in self.store:
            every = padded_lists(*whole, Metres.lanes)
            held = ~among(self.store.group[self._columns], self.scene.layout.parts.movers)
            shares = shares_of(self._weights, tables[0], every, held, self._bring_of)
            shared = np.array([one.shared for one in self._planned.solids])[self._matter.number]
            self.store[SHARE.name][self._columns] = np.where(shared, shares, 1.0)
        if self._cracks:
            strength = self._cracks.strengths(ids, self._matter.number)
            tables[1].records[: self._owned, tables[1].places[STRENGTH][0]] = strength
            self._bring_of(tables[1], STRENGTH)

    def sum(self, time: float, dt: float) -> None:
        """The acceleration of all particles of solids at ``time``, s, where they stand ``dt`` s after the
        last sum; collective."""
        self.strain(dt)
        self.push(time, dt)

    def before_sums(self, dt: float) -> None:
        """Stress and faces, where solids touch."""
        if self._planned.alone:
            self.strain(dt)

    def after_sums(self, time: float, dt: float) -> None:
        """All forces of solids that touch or stand alone; those in a fluid have steps of their own."""
        if self._planned.alone:
            self.push(time, dt)
        elif not self._planned.immersed:
            self.sum(time, dt)

    def strain(self, dt: float) -> None:
        """The stress of all particles of solids, and their faces, ``dt`` s after the last; collective."""
        rows, inner = self._owned, self._inner
        memory = memory_of(self._planned.solids, self.store, self._columns, dt)
        first, second = self._tables
        if self.loads:
            self.loads.book(dt, self._columns, self._matter.number, self.masses)
        with self.ledger("records"):
            for name in self._moving:
                self._put(first, name, 0, rows)
        with self.ledger("halo"):
            self._start(self._to_first)
        with self.ledger("records"):
            self._put(second, PLACES, 0, rows)
        with self.ledger("solids"):
            self._sum_gradients(0, inner, memory)
        with self.ledger("halo"):
            self._finish(self._to_first)
        with self.ledger("records"):
            place, end = first.places[PLACES]
            to = second.places[PLACES][0]
            second.records[rows:, to : to + end - place] = first.records[rows:, place:end]
        with self.ledger("solids"):
            self._sum_gradients(inner, rows, memory)
            if self._faces:
                seen = self._matter.sums[:1], self._weights, self._around[0], self._moment
                self._faces.carry(self._each, dt, *seen)

    def push(self, time: float, dt: float) -> None:
        """The acceleration by the stress, and by what contacts do to the faces; collective."""
        store, rows, inner = self.store, self._owned, self._inner
        if self._faces:
            with self.ledger("solids"):
                flux = getattr(self._tables[1].view, FLUX)
                self._faces.turn(self._each, self._moment, self._volume, flux)
        with self.ledger("halo"):
            self._start(self._to_second)
        with self.ledger("solids"):
            self._sum_forces(0, inner)
        with self.ledger("halo"):
            self._finish(self._to_second)
        with self.ledger("solids"):
            self._sum_forces(inner, rows)
            number, loads = self._matter.number, self.loads
            self._each(
                self._push,
                0,
                rows,
                None if self._planned.touching else self.plan.pulls.bonded,
                store.view(),
                self._columns,
                self._inverse_density,
                self._force,
                store[DRAWN.name] if loads else None,
                loads.share(time)[number] if loads else None,
                store["acceleration"],
            )
            if loads:
                loads.book(dt, self._columns, number, self.masses)
            if self.clamps:
                self.clamps.book(dt)
            self._crack()

    def _crack(self) -> None:
        """Cut the bonds that are stretched too far: it counts from the next step on."""
        cracks, second = self._cracks, self._around[1]
        if cracks and cracks.cut(second, self._columns, self._matter.number):
            self._find_moments()
            cracks.weaken(second, self._moment)

    def measure(self) -> None:
        """Stored energy and stress of the particles where they stand; collective."""
        store, n = self.store, self._owned
        self._put(self._tables[1], PLACES, 0, n)
        self._bring(self._places)
        stress = tuple(np.zeros(n) for _ in store.rows[STRESS.name])
        measured = (np.zeros(n), stress, np.zeros(n), np.zeros(n))
        matter = self._matter._replace(sums=self._matter.sums[:1])
        memory = memory_of(self._planned.solids, store, self._columns, 0.0)
        seen = (matter, self._weights, self._around[1], self._moment, memory)
        self._each(self._measure, 0, n, *seen, measured)
        if self._cracks:
            self._cracks.measure(self._columns)
        store[STORED.name][self._columns] = measured[0]
        store[VON_MISES.name][self._columns] = measured[2]
        if STRESS_ZZ.name in store:
            store[STRESS_ZZ.name][self._columns] = measured[3]
        for of, values in zip(store[STRESS.name], stress):
            of[self._columns] = values

    def with_pressure(self, pressure: np.ndarray) -> np.ndarray:
        """The ``pressure`` (owned,) of this rank's particles, Pa, with −tr σ/3 of the last
        :meth:`measure` for those of solids: what these carry themselves is what they show a fluid."""
        store, rows = self.store, self._columns.astype(np.int64) - self.store.low
        across = store.shown(STRESS_ZZ.name)[rows] if STRESS_ZZ.name in store else None
        shown = pressure.copy()
        shown[rows] = pressure_of(store.shown(STRESS.name)[rows], across, store.dimensions)
        return shown

    def energy(self) -> float:
        """Stored energy of all solids and their contacts, J; the same bits on any number of ranks,
        collective."""
        self.measure()
        names = [name for name in (STORED.name, CONTACT_ENERGY.name) if name in self.store]
        energies = exact_sums(self.comm, np.column_stack([self.store.shown(name) for name in names]))
        return float(energies.sum())

    @property
    def neighbours(self) -> float:
        """Neighbours in the reference of a particle of this rank, on average."""
        lists = self._around[0].lists
        return float(lists.lengths.mean()) if self._owned else 0.0

    def pairs(self) -> int:
        """In the reference."""
        return round(self.neighbours * self._owned)

    def booked(self) -> tuple[float]:
        """Their stored energy, J."""
        return (self.energy(),)

    def bytes_held(self) -> int:
        """Bytes of tables, lists and rows."""
        arrays = [*self._around[0].lists, *self._rows, *(table.records for table in self._tables)]
        return sum(array.nbytes for array in arrays)

    def _listed(self) -> ReferenceRows:
        """The rows of reference lists, from X, of the particles that this rank owns now."""
        store, scene = self.store, self.scene
        body = self._solid_of[store.group[store.inner]]
        own = body != NOT_BONDED
        extent = Extent(scene.layout.axis, scene.layout.lower, scene.layout.upper, scene.layout.periods)
        reference = store.shown("reference")[own]
        ids = store.id[store.inner][own]
        return reference_rows(self.comm, extent, self.supports, ids, reference, body[own])

    def _sum_gradients(self, first: int, last: int, memory: Memory | None) -> None:
        second = self._tables[1]
        flux = getattr(second.view, FLUX)
        matter, weights, around = self._matter, self._weights, self._around[0]
        self._each(self._gradients, first, last, matter, weights, around, self._moment, memory, flux)

    def _sum_forces(self, first: int, last: int) -> None:
        self._each(self._forces, first, last, self._matter, self._weights, self._around[1], self._force)

    def _put(self, table: SolidRecords, name: str, first: int, last: int) -> None:
        """Bring a field of some rows of a table up to date."""
        rows = np.array(self.store.rows[name], np.uint64)
        place = table.places[name][0]
        self._each(self._fill, first, last, self.store.data, rows, self._columns, table.records, place)

    def _each(self, loop, first: int, last: int, *args) -> None:
        if last > first:
            in_threads(loop, first, last, *args)

    def _bring_of(self, table: SolidRecords, name: str) -> None:
        self._bring(self.halo.channel(table.records, *table.places[name]))

    def _bring(self, channel) -> None:
        self._start(channel)
        self._finish(channel)

    @staticmethod
    def _start(channel) -> None:
        for request in channel:
            request.Start()

    @staticmethod
    def _finish(channel) -> None:
        for request in channel:
            request.Wait()
