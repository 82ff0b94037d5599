"""The open ends of a simulation on a rank."""

from collections.abc import Iterator

import numpy as np

from psph.engine.settled import settled
from psph.fields import FLUID, LISTED_POSITION
from psph.parallel.reductions import whole_sums
from psph.scene.end_columns import side_by_side
from psph.scene.ends import FRONT, SEEN, EndFace, faces_of
from psph.simulation.end_fit import FITTED, Flowing, Listed, Planes, Vicinity, room_for, see_fronts
from psph.simulation.end_means import (
    BY_LEVEL,
    BY_PRESSURE,
    BY_SPEED,
    TERMS,
    Standing,
    Told,
    Units,
    fill_behind,
    sum_before,
    sum_behind,
)
from psph.simulation.end_passage import Passage, within
from psph.simulation.end_state import Books, EndState
from psph.simulation.materials import tell_of_groups
from psph.work import Rank, Work

MOVED = 0.4
"""Spacings past the plane at which particles change sides before lists are due."""

LISTED = LISTED_POSITION.name

HELD_STILL = ("acceleration", "density_rate")
"""What forces give the particles of a buffer, and they do not take."""

OFF = 0.05
"""Part of the energy that has come in and gone out by which books of it may be off."""

PAID_IN = 50.0
"""Rows in whose time a pump brings a row that it owes."""

WHAT = {"pressure": BY_PRESSURE, "level": BY_LEVEL}


def planes_of(faces, layout) -> Planes:
    """The planes of ``faces`` before anything is added behind them."""
    stand = [(face.axis, face.at, 0.0, float(face.sign), 0.0, 0.0) for face in faces]
    return Planes(
        *map(np.array, zip(*stand)),
        *(np.array([face.sides[n] for face in faces]) for n in (0, 1)),
        np.array([face.middle for face in faces]),
        *side_by_side([face.column for face in faces]),
        np.array(layout.up),
        float(np.linalg.norm(layout.height_gravity)),
        np.array([face.height > 0.0 for face in faces]),
    )


class Buffers(Work):
    """The buffers of the open ends of a scene on a rank.

    Particles behind a plane go with the velocity that the end gives them, and show the fluid the density
    that goes with its pressure; forces do not move them.
    """

    name = "ends"

    def __init__(self, rank: Rank):
        scene, self.plan, self.store, self.domain = rank.scene, rank.plan, rank.store, rank.domain
        self.comm, self.ledger = rank.domain.comm, rank.ledger
        self.faces, self.dx, self.time = faces_of(scene), scene.spacing, 0.0
        self.states = [EndState.at_start(face) for face in self.faces]
        self.passages = [Passage(face, rank) for face in self.faces]
        self.vicinity = Vicinity(
            scene.kernel, scene.spacing, tuple(scene.gravity), tuple(scene.layout.periods)
        )
        fluids = [one for one in self.plan.materials.species if one.is_fluid]
        # Fluids of one density are one to the fit: ghosts tell no more.
        self.densities = sorted({one.density for one in fluids})
        c = max(one.sound_speed for one in fluids)
        self.planes = planes_of(self.faces, scene.layout)
        self._rides = [face.ride.place for face in self.faces], [face.pace for face in self.faces]
        self._what = np.array([WHAT.get(face.kind, BY_SPEED) for face in self.faces])
        self.units = Units(self.densities[-1] * c * c, self.densities[-1] * c, c, self.dx)
        loops = see_fronts, sum_behind, sum_before, fill_behind
        self._see, self._sum_behind, self._sum_before, self._fill = map(settled, loops)
        self._fastest, self._whole = np.zeros(2), True
        self.settle()

    # Who is where.

    def settle(self) -> None:
        """The particles of the buffers, and the fluid in front of each plane, by the places at which lists
        were made: a run that is resumed finds them again."""
        store = self.store
        fluid = store.shown("kind") == FLUID
        behind, front = [], []
        for face in self.faces:
            depth = face.depth(store[LISTED][face.axis][store.inner], face.ride.place(self.time))
            near = fluid & (depth > -SEEN * self.dx) & (depth < face.layers * self.dx)
            behind.append(np.flatnonzero(store.of_groups(face.groups)))
            front.append(within(face, self.domain, np.flatnonzero(near), LISTED))
        self.behind, self.front = self._standing(behind), self._standing(front)
        self.matter = self._matter()
        self._fixed = self._column("rest_density"), self._column("sound_speed")
        self._fit = room_for(store.dimensions)
        self._seen = np.zeros((len(self.behind.columns), FITTED + 1 + store.dimensions))

    def _standing(self, rows: list[np.ndarray]) -> Standing:
        """Particles in some ``rows`` of each end."""
        ends = [np.full(len(own), face.number) for face, own in zip(self.faces, rows)]
        columns = self.store.low + np.concatenate(rows)
        return Standing(columns, np.concatenate(ends), np.ones(len(columns)))

    def _find_shapes(self) -> None:
        """The shape of what comes in, where particles behind the planes stand now."""
        behind, position = self.behind, self.store["position"]
        for face in self.faces:
            if face.shaped:
                own = behind.end == face.number
                places = np.stack([x[behind.columns[own]] for x in position], axis=1)
                behind.shape[own] = face.shape(self.domain.inside(places))

    def _matter(self) -> np.ndarray:
        """For each column the number of its fluid, with a minus behind a plane; 0: no fluid."""
        rest, behind, flows = (self._column(name) for name in ("rest_density", "ends_fluid", "is_fluid"))
        number = 1 + np.searchsorted(self.densities, rest)
        return (number * (flows > 0.0) * np.where(behind > 0.0, -1, 1)).astype(np.int64)

    def _column(self, name: str) -> np.ndarray:
        """Of what materials fix, an array over all columns."""
        return np.broadcast_to(self.store.value(name), self.store.capacity)

    def renew(self, simulation) -> None:
        """Let particles change sides, be born and die, where lists are due or some have come too far."""
        self.time = simulation.then
        if not (simulation.whole and any(state.due for state in self.states)):
            return
        with self.ledger("ends"):
            for passage, state in zip(self.passages, self.states):
                passage.renew(state, self.time, simulation.population)
            tell_of_groups(self.store, self.plan.materials)
        simulation.listed = False

    # What they are like.

    def advance(self, time: float, dt: float, largest_speed: float) -> None:
        """They drift with their velocity."""
        own = self.behind.columns
        for x, v in zip(self.store["position"], self.store["velocity"]):
            x[own] += dt * v[own]

    def impose(self, simulation) -> None:
        """The state of the buffers at the new time, from the fluid in front of the planes, where that ends a
        step of its own; collective."""
        self._whole = simulation.whole
        if not self._whole:
            return
        if simulation.listed:
            with self.ledger("halo"):
                self.domain.halo.refresh(self.plan.refreshed)
            simulation.listed = False  # ghosts are fresh, but for what follows
        with self.ledger("ends"):
            self._impose(simulation.then, self.plan.pace * simulation.dt)

    def _impose(self, time: float, dt: float) -> None:
        self.time = time
        self._find_shapes()
        planes, flowing, behind, seen = self._planes(), self._flowing(), self.behind, self._seen
        listed = Listed(self.store.low, self.domain.lists, self.matter)
        self._see(behind.columns, behind.end, planes, self.vicinity, listed, flowing, self._fit, seen)
        sums = np.zeros((len(self.faces), TERMS), np.int64)
        told = self._told(time)
        limits = self.units, MOVED * self.dx
        self._sum_behind(behind, planes, told, flowing, *limits, seen, sums)
        self._sum_before(self.front, planes, told, flowing, *limits, FRONT * self.dx, sums)
        for face, state, one in zip(self.faces, self.states, whole_sums(self.comm, sums).tolist()):
            state.measure(face, one, self.units, dt)
        for face, state in zip(self.faces, self.states):
            pace = face.pace(time)
            told = self._mean_speed(face, time) + pace
            state.answer(face, told, pace, self.units.speed, dt)
            state.follow_surface(face, told, pace, face.level(time), self.units, dt)
        materials = self.plan.materials
        self._fastest[:] = 0.0
        fixed = materials.laws, materials.law_of, self.units, dt
        self._fill(behind, self._planes(), self._told(time), flowing, *fixed, seen, self._fastest)
        self._fastest[0] /= dt * dt if dt else np.inf

    def _planes(self) -> Planes:
        added = np.array([(one.added.pressure, one.added.speed + one.faster) for one in self.states])
        pressure, speed = np.ascontiguousarray(added.T)
        place, pace = (np.array([f(self.time) for f in of]) for of in self._rides)
        return self.planes._replace(place=place, pace=pace, pressure=pressure, speed=speed)

    def _told(self, time: float) -> Told:
        """What the ends give at ``time``, s."""
        rows = []
        for face, state in zip(self.faces, self.states):
            u, means = self._mean_speed(face, time), state.means
            given = state.given(face, time) if face.by_pressure else u
            out = 1.0 if u < 0.0 and means.rows else 0.0
            rows.append((given, out, means.inflow, state.slope or 0.0))
        return Told(self._what, *np.ascontiguousarray(np.array(rows).T))

    def _flowing(self) -> Flowing:
        store = self.store
        fields = ("position", "velocity", "predicted_velocity", "density", "specific_volume", "pressure")
        return Flowing(*(store[name] for name in fields), *self._fixed, store.group)

    def _mean_speed(self, face: EndFace, time: float) -> float:
        """The mean inward speed that a velocity end tells, beside its plane, m/s; 0 of a pressure end."""
        if face.kind == "velocity" or face.by_pressure:
            return 0.0 if face.by_pressure else face.given(time)
        rows = self.states[face.number].means.rows
        area = (rows or face.rows) * self.dx ** (self.store.dimensions - 1)
        if face.kind == "flow":
            return face.given(time) / area if area else 0.0
        return self._pumped(face, self.states[face.number].books, rows or face.rows)

    def _pumped(self, face: EndFace, own: Books, rows: float) -> float:
        """The mean speed of what a pump brings, m/s: that of what leaves at its ``source``, and what it owes
        by the books, a row in the time of PAID_IN rows."""
        source = self.states[face.feeding]
        away = self.faces[face.feeding].pace(self.time) - source.means.speed - source.faster
        left = source.books.number_out - source.books.number_in
        owed = (left - own.number_in + own.number_out) / rows if rows else 0.0
        speed = away * source.means.rows / rows if rows else 0.0
        return speed * (1.0 + owed / PAID_IN)

    # What forces do not do.

    def after_sums(self, time: float, dt: float) -> None:
        """Nothing accelerates a buffer."""
        store, own = self.store, self.behind.columns
        for name in HELD_STILL:
            for row in store.rows[name]:
                store.data[row, own] = 0.0

    def kick(self, dt: float) -> tuple[float, ...] | None:
        """The largest |a|² and |v|² of the buffers, where these are new."""
        if not self._whole:
            return None
        change2, speed2 = self._fastest.tolist()
        return 0.0, change2, 0.0 if np.isfinite(speed2) else np.inf, 0.0, speed2

    # What is kept and told.

    def given(self) -> tuple[float, float]:
        """Energy that has come in, J, and how far off that may be: work is by means over the faces."""
        books = [state.books for state in self.states]
        turned_over = sum(abs(one.energy) + abs(one.work) for one in books)
        return sum(one.energy + one.work for one in books), OFF * turned_over

    def passed(self) -> Iterator[str]:
        """What has come in and gone out through each end."""
        for face, state in zip(self.faces, self.states):
            books = state.books
            came = f"{books.number_in:,} particles ({books.mass_in:.6g} kg) came in"
            went = f"{books.number_out:,} ({books.mass_out:.6g} kg) went out"
            energy = f"{books.energy:.4g} J, and {books.work:.4g} J as work of the pressure"
            push = f"{books.momentum:.4g} kg m/s, and {books.impulse:.4g} N s as its push"
            yield f"ends.{face.name}: {came}, {went}; in less out with {energy}; inward {push}"

    def state(self) -> dict:
        """The states of all ends."""
        return {"ends": [state.kept() for state in self.states], "ends_at": self.time}

    def restore(self, state: dict) -> None:
        """Go on from there."""
        self.states = [EndState.restored(one) for one in state["ends"]]
        self.time = state["ends_at"]
