"""Levels of sizes on a rank: who leads and who follows, with which state, who is born and who dies."""

from collections.abc import Iterator

import numpy as np

from psph.composition.pair import take
from psph.composition.terms import displacement
from psph.engine.jit import elementwise
from psph.engine.settled import settled
from psph.engine.threads import in_threads
from psph.fields import seen_at, view_of
from psph.parallel.reductions import all_rows, whole_sums
from psph.particles.level_lists import Membership, part_levels
from psph.particles.neighbours import empty
from psph.scene.levels import REACHES, Levels
from psph.simulation.level_fit import ORDER, Followed, Leaders, OfLeaders, Weighed, follow
from psph.smoothing import kernel
from psph.vectors import add, at, put, scale
from psph.work import Rank, Work

LENGTH, DIVIDED, CORNER = "own_length", "divided", "corner"
"""Names of the fields: the smoothing length of its level; 1 where finer ones stand in its place; which corner
of a coarser particle's cell it is."""

TIE = 1e-3
"""Spacings about a border within which particles go on as they are: where a row stands on it, rounding would
let the coarse ones change sides without their corners."""

LASTS = 0.5
"""Spacings of the coarser level beyond a margin at which particles die, and the coarser one may divide once
more: where it went that far, they went with it.  Two distances would lose or double whoever turns between."""

SELDOM = 8
"""Steps for which the velocity serves of those who follow deep in a finer region."""

HELD_STILL = ("acceleration", "density_rate")
"""What forces give to those who follow, and they do not take."""

BORN, DIED, GONE, COME = range(4)
"""What is counted of each level: who is born and dies, who begins to follow and who to lead."""


class Resizing(Work):
    """The levels of sizes of a scene on a rank."""

    name = "refine"

    def __init__(self, rank: Rank):
        scene, self.plan, self.store, self.domain, self.ledger = rank
        self.levels, self.comm = Levels(scene.layout), rank.domain.comm
        self.gravity = np.array(scene.gravity)
        species = self.plan.materials.species
        self.level_of = np.array([one.level for one in species])
        self.mass_of = np.array([one.mass for one in species])
        self.fluid_of = np.array([one.is_fluid for one in species])
        self.follows = np.array([one.is_fluid and not one.mobile for one in species])
        fluids = [(one.fluid, one.level, one.mobile) for one in species]
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
        self._weighing = Weighed(unit, cell, tuple(scene.layout.periods), ORDER)
        self._follow, self._go = settled(follow), settled(go_along)
        self._lanes = rank.plan.space.lanes
        self._led = empty(0, 0)
        self.columns = np.zeros(0, np.int64)

    # Who is there.

    def sort(self, population=None) -> None:
        """Let particles lead and follow by where they are, and with a ``population`` be born and die; new
        lists have to follow.  Collective."""
        store = self.store
        places = self.domain.inside(store.owned_rows("position"))
        group = store.group[store.inner]
        fluid, level = self.fluid_of[group], self.level_of[group]
        away = np.full(len(group), -np.inf)
        within = np.full(len(group), np.inf)
        corner = store[CORNER][store.inner]
        for one in range(self.levels.count):
            own = fluid & (level == one)
            away[own] = self.levels.outside(one, self.levels.middles(one, places[own], corner[own]))
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
        """Pairs of one level stay in the lists; who follows has rows of those who lead on other levels."""
        group = self.domain.groups()
        fluid, level = self.fluid_of[group], self.level_of[group]
        follows, leads = self.follows[group], fluid & ~self.follows[group]
        store = self.store
        reach2 = self.plan.sizes.reach(store[LENGTH][: store.total]) ** 2
        listed, periods = tuple(store["listed_position"]), self._weighing.periods
        of = Membership(level, follows, leads, listed, reach2, periods)
        self._led = part_levels(self.domain.lists, store.low, store.owned, of, self._lanes)
        own, deep, finer = self._followers(np.flatnonzero(follows[store.inner]))
        self.columns, near = store.low + own, np.count_nonzero(~deep)
        self._leaders = Leaders(store.low, self.domain.lists, self._led, leads, store[LENGTH], listed)
        self._scale = self.levels.layout.spacing * 0.5 ** np.where(
            finer, level[self.columns] + 1, level[self.columns] - 1.0
        )
        seen = self.domain.lists.lengths[own].astype(np.int64) + self._led.lengths[own]
        longest, ends = int(seen.max(initial=0)), np.cumsum(seen[:near])
        size, many = int(ends[-1]) if near else 0, np.zeros(len(own), np.int64)
        self._near = Followed(
            ends - seen[:near], many[:near], np.empty(size, np.uint32), np.empty(size), longest
        )
        none = np.zeros(0, np.int64)
        self._deep = Followed(none, many[near:], np.empty(0, np.uint32), np.empty(0), longest)
        self._anew = True

    def _followers(self, own: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Some rows, those last that are deep in a finer region, where nobody sees them who leads; whether
        each is deep, and whether it is in a finer region at all."""
        places = self.domain.inside(self.store.owned_rows("position")[own])
        level = self.level_of[self.store.group[self.store.inner][own]]
        away = np.full(len(own), np.inf)
        for one in range(self.levels.count - 1):
            at_level = level == one
            away[at_level] = self.levels.outside(one + 1, places[at_level])
        far = np.array([REACHES * self.levels.support(one) for one in range(self.levels.count)])
        deep = away < -far[level] - self.levels.support(0) * 0.5
        order = np.argsort(deep, kind="stable")
        return own[order], deep[order], away[order] < 0.0

    # What they are like.

    def advance(self, time: float, dt: float, largest_speed: float) -> None:
        """Who follows drifts with its velocity, and steps aside as others do."""
        view, names = self.store.view(), self.plan.carried
        shown = seen_at(view_of(names)(*(getattr(view, name) for name in names)), largest_speed)
        arrays = self.store["position"], self.store["velocity"]
        self._go(self.columns, dt, self.plan.carriers, shown, *arrays)

    def impose(self, simulation) -> None:
        """The state of who follows at the new time; collective."""
        if simulation.listed:
            with self.ledger("halo"):
                self.domain.halo.refresh(self.plan.refreshed)
            simulation.listed = False  # ghosts are fresh, but for what follows
        with self.ledger("refine"):
            near, fall = len(self._near.many), simulation.dt * self.gravity
            self._impose(slice(0, near), self._near, self._anew, fall)
            self._anew = False
            if simulation.steps % SELDOM == 0:
                self._impose(slice(near, None), self._deep, True, fall)

    def _impose(self, some: slice, followed: Followed, anew: bool, fall: np.ndarray) -> None:
        """The state of ``some`` of them, by those whom they have ``followed`` since lists were made, or
        ``anew``."""
        names = "velocity", "predicted_velocity", "specific_volume", "pressure", "density"
        state = OfLeaders(*(self.store[name] for name in names))
        columns, scale = self.columns[some], self._scale[some]
        told = columns, scale, self._leaders, self._weighing, anew, followed, state, fall
        in_threads(self._follow, 0, len(columns), *told)

    def after_sums(self, time: float, dt: float) -> None:
        """Forces do not act on who follows."""
        store = self.store
        for name in HELD_STILL:
            for row in store.rows[name]:
                store.data[row, self.columns] = 0.0

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
        """What is counted."""
        return {self.name: whole_sums(self.comm, self.counts).tolist()}

    def restore(self, state: dict) -> None:
        """Go on from there: rank 0 has counted all."""
        self.counts[:] = state[self.name] if self.comm.rank == 0 else 0


@elementwise
def go_along(columns, dt, effects, view, position, velocity):
    """Move some ``columns`` by their velocity, and by what they step aside, in ``dt`` s."""
    for n in range(len(columns)):
        k = np.uint64(columns[n])
        move = add(scale(at(velocity, k), dt), displacement(effects, take(view, k), dt))
        put(position, k, add(at(position, k), move))
