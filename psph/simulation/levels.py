"""Levels of sizes on a rank: who leads and who follows, with which state, who is born and who dies."""

import math
from collections.abc import Iterator
from itertools import product

import numpy as np

from psph.composition.pair import take
from psph.composition.terms import displacement
from psph.engine.jit import elementwise
from psph.engine.settled import settled
from psph.engine.threads import in_rooms, in_threads, threads
from psph.fields import seen_at, view_of
from psph.parallel.reductions import all_rows, whole_sums
from psph.particles.named_rows import Naming, find_beside
from psph.particles.neighbours import empty
from psph.scene.levels import CORNER, DIVIDED, LASTS, LENGTH, TIE, Levels
from psph.simulation.following import OfLeaders, WhoIsLed, bear, follow, tell_rows
from psph.simulation.level_clock import LevelClock
from psph.simulation.level_faces import FaceShares
from psph.simulation.level_fit import ORDER, TIPS, Followed, Leaders, Weighed, find_leaders, room_for
from psph.simulation.level_images import LeaderImages, images_in
from psph.simulation.level_loops import FAR, LEADING, NEAR, PARTS, SELDOM, LevelLoops
from psph.simulation.level_regions import GoingAlong
from psph.simulation.surface_rows import rows_of
from psph.simulation.unevenness import Unevenness
from psph.smoothing import kernel
from psph.vectors import add, at, put, scale
from psph.work import Rank, Work

OF_FORCES = ("acceleration", "density_rate", "density_rate_1", "density_rate_2")
"""What forces give, and those who follow do not have: no pass has sums of it for them."""

MAY = 2.0
"""Supports from a border, in water that leads, beyond which walls see none that leads on another level."""

BEYOND = 0.5
"""Supports from the region of its level beyond which a wall follows: next to none of what it sees there leads
and would hold back its density.  By 1.0 a block that sinks onto another, a border between them, bore 3.4
times its buoyancy, with the finer spacing all over 1.6, by 0.5 2.0 to 2.4."""

BORN, DIED, GONE, COME = range(4)
"""What is counted of each level: who is born and dies, who begins to follow and who to lead."""


class Side:
    """``some`` of those who follow on a ``level``, walls where they ``stand``, beside whoever leads or
    farther off, whom they have ``followed`` since lists were made, and that they do in each ``every``-th
    step of theirs."""

    def __init__(self, some: slice, level: int, followed: Followed, every: int, stand: bool):
        self.some, self.level, self.followed, self.every, self._begun = some, level, followed, every, False
        self.stand = stand

    def begin(self) -> bool:
        """Whether that is still to be found; it is from now on."""
        anew, self._begun = not self._begun, True
        return anew


class Resizing(Work):
    """The levels of sizes of a scene on a rank."""

    name = "refine"

    def __init__(self, rank: Rank):
        scene, self.plan, self.store, self.domain, self.ledger = rank
        self.levels, self.comm = Levels(scene.layout), rank.domain.comm
        self.going = GoingAlong(rank, self.levels)
        self.gravity = np.array(scene.gravity)
        species = self.plan.materials.species
        self.level_of = np.array([one.level for one in species])
        self.mass_of = np.array([one.mass for one in species])
        self.fluid_of = np.array([one.is_fluid for one in species])
        self.follows = np.array([one.follows for one in species])
        materials = self.plan.materials
        self._evolves = ~self.fluid_of & materials.bearing & ~materials.given_pressure
        leads = np.array([one.is_fluid and one.mobile and not one.follows for one in species])
        self._velocities = Unevenness(rank, leads)
        self._holds = np.array([float(one.no_slip and not one.is_fluid) for one in species])
        # Fluid behind an open end neither turns nor divides.
        fluids = [(not one.ends_fluid and one.fluid, one.level, one.mobile) for one in species]
        self._turned = np.array(
            [
                fluids.index((fluid, level, not mobile)) if fluid else n
                for n, (fluid, level, mobile) in enumerate(fluids)
            ],
            np.uint8,
        )
        self._finer = np.array(
            [
                fluids.index((fluid, level + 1, False)) if fluid and level + 1 < self.levels.count else n
                for n, (fluid, level, _) in enumerate(fluids)
            ],
            np.uint8,
        )
        self.counts = np.zeros((self.levels.count, 4), np.int64)
        cell = (scene.spacing / scene.smoothing_length) ** scene.dimensions
        unit = kernel(scene.case.space.kernel, 1.0, scene.dimensions)
        self._weighing = Weighed(unit, cell, tuple(scene.layout.periods), ORDER, rows_of(scene), TIPS)
        self._follow, self._bear, self._go = map(settled, (follow, bear, go_along))
        self._find, self._tell = map(settled, (find_leaders, tell_rows))
        self._others, self._alike, self._walls = Naming(1), Naming(1), Naming(1)
        self._pushing, self._mirrors = Naming(rank.plan.space.lanes), rank.plan.mirrors
        if any(plane.motion for plane in rank.plan.planes):
            self._mirrors = self._mirrors._replace(reach=math.inf)  # wherever they go
        self.columns, self._aside, self._flowing = np.zeros(0, np.int64), np.zeros(0), 0
        self.clock = LevelClock([one.pace for one in (self.plan, *self.plan.finer)], self.level_of)
        self.own_steps = self.clock.own
        self._loops = LevelLoops(self.plan, self.store, self.clock)
        self._loaded = self.plan.materials.loaded
        self._shares = FaceShares(rank, self.levels)
        if self._loaded is not None:
            self._loops.push_by(empty(0, 0), None)

    def meet(self, maps: np.ndarray) -> None:
        """Regions go with what carries them, and faces with walls and bodies."""
        self.going.meet(maps)
        self._shares.meet(maps)

    # Who is there.

    def sort(self, population=None) -> None:
        """Let particles lead and follow by where they are, and with a ``population`` be born and die; new
        lists have to follow.  Collective."""
        store = self.store
        places = self.domain.inside(store.owned_rows("position"))
        group = store.group[store.inner]
        fluid, level = self.fluid_of[group], self.level_of[group]
        self.going.move(store.owned_rows("position")[fluid & ~self.follows[group]])
        self._shares.turn()
        away = np.full(len(group), -np.inf)
        within = np.full(len(group), np.inf)
        corner = store[CORNER][store.inner]
        for one in range(self.levels.count):
            own = fluid & (level == one)
            away[own] = self.levels.away(one, places[own], corner[own])
            within[own] = self.levels.outside(one + 1, places[own])
        slack = np.where(self.follows[group], -TIE, TIE) * self.levels.layout.spacing
        follows = fluid & ((away >= slack) | (within < -slack))
        turns = fluid & (follows != self.follows[group])
        self._count(GONE, level[turns & follows])
        self._count(COME, level[turns & ~follows])
        group[turns] = self._turned[group[turns]]
        wide = np.array([0.0, *(self.levels.margin(one) for one in range(1, self.levels.count)), -np.inf])
        dx = self.levels.layout.spacing * 0.5**level
        divided = store[DIVIDED][store.inner]
        divides = fluid & (within < wide[level + 1]) & (divided == 0.0)
        divided[fluid & (within > wide[level + 1] + LASTS * dx)] = 0.0
        divided[divides] = 1.0
        if population is None:
            return
        dies = fluid & (level > 0) & (away > wide[level] + 2.0 * LASTS * dx)
        self._count(DIED, level[dies])
        newborn = self._divide(np.flatnonzero(divides), population)
        staying = np.flatnonzero(~dies)
        store.reorder((store.low + staying).astype(np.uint32), 0, 0)
        store.append(*newborn)

    def _count(self, what: int, level: np.ndarray) -> None:
        self.counts[:, what] += np.bincount(level, minlength=self.levels.count)

    def _divide(self, parents: np.ndarray, population) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Ids, groups and numbers of the daughters of some rows, which follow; all ranks agree on the ids."""
        store, dimensions = self.store, self.store.dimensions
        many = 2**dimensions
        own = store.id[store.inner][parents]
        everyone = np.sort(all_rows(self.comm, own[:, None])[:, 0])
        columns = store.low + np.repeat(parents, many)
        block, group = store.data[:, columns].copy(), self._finer[store.group[columns]]
        first = population.next_id + many * np.searchsorted(everyone, own)
        ids = (first[:, None] + np.arange(many)).ravel()
        population.next_id += many * len(everyone)
        level = self.level_of[group]
        self._count(BORN, level)
        corner = np.tile(np.arange(many), len(parents))
        block[list(store.rows["position"])] += (
            self.levels.to_corners(1)[corner] * 0.5 ** (level - 1)[:, None]
        ).T
        block[store.rows[CORNER].start] = corner
        block[store.rows["mass"].start] = self.mass_of[group]
        block[store.rows[LENGTH].start] *= 0.5
        block[store.rows[DIVIDED].start] = 0.0
        return ids, group, block

    def listed(self) -> None:
        """Who follows has rows of those who lead on its own level and on others, and of walls; what bears a
        load of the fluid on its own."""
        group = self.domain.groups()
        fluid, level = self.fluid_of[group], self.level_of[group]
        follows, leads = self.follows[group], fluid & ~self.follows[group]
        store, lists = self.store, self.domain.lists
        listed, owned = tuple(store["listed_position"]), (store.low, store.owned)
        stands, may = self._stands(group, level, listed)
        others = self._others.find(self.domain.others, *owned, leads, follows | may)
        beside, shares = np.zeros((2, store.owned), bool)
        find_beside(store.owned, store.low, lists, leads, beside)
        stands[store.inner] |= may[store.inner] & ~beside & (others.lengths > 0)
        if self._loaded is not None:
            shares = self._shares.tell(lists)
            pushing = self._pushing.find(lists, *owned, fluid, self._loaded[group])
            self._loops.push_by(pushing, self._mirrors)
        alike = self._alike.find(lists, *owned, leads, follows | stands)
        walls = self._walls.find(lists, *owned, ~fluid, follows)
        beside, inner = beside | shares, group[store.inner]
        stands = stands[store.inner]
        following, told = self.follows[inner] | stands, self.plan.materials.given_pressure[inner]
        part = np.where(following & beside, NEAR, np.where((following | told) & ~beside, FAR, LEADING))
        self._loops.role = (len(PARTS) * level).astype(np.uint8)
        self._loops.role[store.inner] += part.astype(np.uint8)
        kinds = list(product((False, True), (1, SELDOM), range(self.levels.count)))
        own = [
            following & (stands == stand) & (beside == (every == 1)) & (level[store.inner] == one)
            for stand, every, one in kinds
        ]
        ends = np.cumsum([0, *map(np.count_nonzero, own)])
        own = np.concatenate([*map(np.flatnonzero, own)])
        self.columns, self._flowing = store.low + own, int(np.count_nonzero(~stands[own]))
        for row in (row for name in OF_FORCES for row in store.rows[name]):
            store.data[row, self.columns] = 0.0
        holds = self._holds[group]
        self._leaders = Leaders(store.low, alike, others, walls, store[LENGTH], listed, holds)
        where = np.stack([x[store.inner][own] for x in listed], axis=1)
        self._scale = self.levels.layout.spacing * 0.5 ** self._followed(where, level[self.columns])
        self._aside = self._steps_aside(where, level[self.columns])
        seen = alike.lengths[own].astype(np.int64) + others.lengths[own] + walls.lengths[own]
        images = self._images(self._mirrors)
        seen *= images.shown_to(where)
        begins, many = np.cumsum(seen) - seen, np.zeros((2, len(own), len(images.deeper)), np.int64)
        normal, (held, deeper) = np.zeros((store.dimensions, len(own))), np.zeros((2, len(own)))
        size, longest = int(seen.sum()), int(seen.max(initial=0))
        entries = np.empty(size, np.uint32), *np.empty((3, size))
        self._led = WhoIsLed(store.total)
        self._sides = [
            Side(
                some,
                one,
                Followed(
                    begins[some],
                    *many[:, some],
                    tuple(normal[:, some]),
                    held[some],
                    deeper[some],
                    *entries,
                    longest,
                ),
                every,
                stand,
            )
            for (stand, every, one), some in zip(kinds, map(slice, ends[:-1], ends[1:]))
        ]

    def _stands(self, group: np.ndarray, level: np.ndarray, listed) -> tuple[np.ndarray, np.ndarray]:
        """Which walls see next to none of their ``level`` who lead (columns,), wherever fluid is: they push
        nobody to speak of, so that nothing would hold back a density that summed up the rates of what flows
        by; and which may see none (columns,)."""
        places, (found, may) = self.domain.inside(np.stack(listed, axis=1)), np.zeros((2, len(group)), bool)
        for one in range(self.levels.count):
            own = np.flatnonzero(self._evolves[group] & (level == one))
            beyond, finer = (self.levels.outside(n, places[own]) for n in (one, one + 1))
            away, support = np.maximum(beyond, -finer), self.levels.support(one)
            found[own], may[own] = away > BEYOND * support, away > -MAY * support
        return found, may

    def _followed(self, where: np.ndarray, level: np.ndarray) -> np.ndarray:
        """The level of those whom particles of a ``level`` (n,) at some places (n, dim), m, follow: the next
        finer one in its region."""
        found, finest = level - 1.0, self.levels.count - 1
        for one in range(finest):
            at_level = np.flatnonzero(level == one)
            if one:
                away = self.levels.outside(one + 1, self.domain.inside(where[at_level]))
                at_level = at_level[away < 0.0]
            found[at_level] += 2.0
        return found

    def _steps_aside(self, where: np.ndarray, level: np.ndarray) -> np.ndarray:
        """1 of those who see no end of a margin, else 0 (n,): behind it nobody is, and who steps there dies.
        Where waves stir them, a margin loses more than are born, and in time the region does."""
        found = np.ones(len(level))
        for one in range(1, self.levels.count):
            at_level = np.flatnonzero(level == one)
            away = self.levels.outside(one, self.domain.inside(where[at_level]))
            found[at_level[away > self.levels.margin(one) - self.levels.support(one)]] = 0.0
        return found

    # What they are like.

    def advance(self, time: float, dt: float, largest_speed: float) -> None:
        """Who follows drifts with its velocity, and steps aside as others do, but for the end of a margin."""
        view, names = self.store.view(), self.plan.carried
        shown = seen_at(view_of(names)(*(getattr(view, name) for name in names)), largest_speed)
        arrays = self.store["position"], self.store["velocity"]
        self._go(self.columns[: self._flowing], self._aside, dt, self.plan.carriers, shown, *arrays)

    def uneven(self) -> float:
        """Of those who lead, beside what all of them may do alike.

        Shifts as large as an even stream is fast would stir it, level by level: at 0.3 m/s, 0.8 m deep, up to
        0.12 m/s across in 2 s, and a region at rest would take 8 % of its momentum in 5 s.
        """
        return self._velocities.uneven()

    def impose(self, simulation) -> None:
        """The state of who follows at the new time; collective."""
        if simulation.listed:
            with self.ledger("halo"):
                self.domain.halo.refresh(self.plan.refreshed)
            simulation.listed = False  # ghosts are fresh, but for what follows
        images = self._images(simulation.engine.neighbourhood.mirrors)
        due = [side for side in self._sides if self.clock.every(side.every)[side.level]]
        names = "velocity", "predicted_velocity", "specific_volume", "pressure", "density"
        state = OfLeaders(*(self.store[name] for name in names))
        with self.ledger("refine"):
            for side in due:
                self._look_for(side, images)
            led, rows = self._led.rows(), self._weighing.rows
            in_threads(self._tell, 0, len(led.columns), self._leaders.length, rows, state, led)
            for side in due:
                fall = side.every * int(self.clock.pace[side.level]) * simulation.dt * self.gravity
                whom = self.columns[side.some], self._leaders, images, self._weighing, side.followed
                if side.stand:
                    in_threads(self._bear, 0, len(whom[0]), *whom, state, led)
                else:
                    in_threads(self._follow, 0, len(whom[0]), *whom, state, led, fall)

    def _images(self, mirrors) -> LeaderImages:
        """What ``mirrors`` show of the fluid."""
        return images_in(mirrors, self.gravity, self._weighing.rows.density)

    def is_due(self, one) -> bool:
        """Whether any level needs a pass."""
        return bool(self.clock.due(one).any())

    def _look_for(self, side: Side, images: LeaderImages) -> None:
        """Whom a ``side`` follows until there are new lists, of all their ``images``."""
        if not side.begin():
            return
        columns, spacing = self.columns[side.some], self._scale[side.some]
        whom = columns, spacing, self._leaders, images, self._weighing, side.stand, side.followed
        fit = self.store.dimensions, self._weighing.order, side.followed.longest
        in_rooms(self._find, 0, len(columns), [(room_for(*fit),) for _ in range(threads())], *whom)
        self._led.number(side.followed)

    def loops(self, one, loop, seen: tuple, sums) -> Iterator[tuple]:
        """A pass level by level."""
        return self._loops.of(one, loop, seen, sums)

    # What is kept and told.

    def passed(self) -> Iterator[str]:
        """Who was born and died on each level."""
        for level, counts in enumerate(whole_sums(self.comm, self.counts)):
            born, died, gone, come = counts.tolist()
            yield (
                f"level {level}: {born:,} particles were born and {died:,} died; {come:,} began to lead and "
                f"{gone:,} to follow"
            )

    def state(self) -> dict:
        """What is counted, and where regions were when lists were made."""
        counts = whole_sums(self.comm, self.counts).tolist()
        stood = {"moved": self.levels.moved.tolist(), "places": self._shares.places.tolist()}
        return {self.name: {"counts": counts} | stood}

    def restore(self, state: dict) -> None:
        """Go on from there: rank 0 has counted all."""
        self.counts[:] = state[self.name]["counts"] if self.comm.rank == 0 else 0
        self.levels.moved[:] = state[self.name]["moved"]
        self._shares.places = np.array(state[self.name]["places"])


@elementwise
def go_along(columns, aside, dt, effects, view, position, velocity):
    """Move some ``columns`` by their velocity in ``dt`` s, and those with a 1 in ``aside`` by what they step
    aside, not those with a 0."""
    for n in range(len(columns)):
        k = np.uint64(columns[n])
        move = add(scale(at(velocity, k), dt), displacement(effects, take(view, k), dt * aside[n]))
        put(position, k, add(at(position, k), move))
