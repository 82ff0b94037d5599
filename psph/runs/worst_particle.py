"""The particle that went wrong: who it is, what pushed it, and who stands around it."""

from typing import Any, NamedTuple

import numpy as np

from psph.composition import terms
from psph.composition.mirrors import at_look, image, images
from psph.composition.pair import geometry, take
from psph.composition.terms import added, pushed
from psph.fields import KINDS, seen_at, with_length
from psph.particles.store import Store
from psph.simulation.step import Simulation
from psph.vectors import add, nearest_image, subtract, zero_like

INNER = "stress and hourglass control"
"""What the neighbours in the reference do to a particle of a solid."""

SEEN = 6.0
"""Spacings around the particle that are looked at, or the kernel's support if that is more."""


class Share(NamedTuple):
    """What one effect does to a particle: m/s², kg/(m^d s), and the speed of a displacement, m/s.

    All are those at the end of the step, by the pressure of its forces: one of two passes
    (psph.simulation.midway) has changed the density by the rate at its middle instead.
    """

    name: str
    acceleration: np.ndarray
    density_rate: float
    shift: np.ndarray


class Suspect(NamedTuple):
    """A particle, the particles of its size around it in the order of their ids, and its forces' shares:
    none of one that follows others.

    ``offset`` (n, dim) is where they stand as seen from it, m; ``column`` its own place there; ``scene`` has
    the spacing and the kernel of its ``level`` of sizes; ``follow`` tells who around it follows others;
    a step takes so many ``passes``.
    """

    id: int
    place: np.ndarray
    around: Store
    offset: np.ndarray
    column: int
    shares: tuple[Share, ...]
    scene: Any
    level: int
    follow: np.ndarray
    passes: int

    def value(self, name: str):
        """A field of the particle itself: a number, or (dim,)."""
        return self.around.shown(name)[self.column]

    @property
    def name(self) -> str:
        """Who it is, in words: with its spacing where there are several."""
        sized = len(self.scene.finer) > 0 or self.level
        return f"particle {self.id}" + (f" (level {self.level}, {self.scene.spacing:g} m)" if sized else "")

    @property
    def follows(self) -> bool:
        """Whether it goes as those of another size around it do."""
        return bool(self.follow[self.column])

    def kind(self, k: int) -> str:
        """What one of those around it is, in words."""
        return "fluid that follows" if self.follow[k] else KINDS[self.around.shown("kind")[k]]

    @property
    def speed(self) -> float:
        """m/s."""
        return float(np.linalg.norm(self.value("velocity")))

    @property
    def distance(self) -> np.ndarray:
        """Of each particle from it, m (n,)."""
        return np.linalg.norm(self.offset, axis=1)

    def hardest(self) -> Share | None:
        """The effect that pushes it hardest; one whose push is not finite before all others."""
        first = max(self.shares, key=lambda share: _size(share.acceleration), default=None)
        return first if first and _size(first.acceleration) else None

    def fastest_change(self) -> Share | None:
        """The effect that changes its density fastest."""
        first = max(self.shares, key=lambda share: _size([share.density_rate]), default=None)
        return first if first and _size([first.density_rate]) else None


def find(simulation: Simulation, scene, badness: np.ndarray) -> Suspect:
    """The particle of largest ``badness`` (owned,), of several that of the lowest id; collective.

    Its forces are those of the last pass over the pairs, so nothing may have touched the pressure
    since.  The same on any number of ranks.
    """
    store, plan, species = simulation.store, simulation.plan, simulation.plan.materials.species
    ids, mine = store.shown("id"), (-np.inf, 0, None, 0)
    if store.owned:
        k = np.lexsort((ids, -badness))[0]
        mine = float(badness[k]), -int(ids[k]), _places(store)[k].copy(), int(store.shown("group")[k])
    _, least, place, group = max(simulation.comm.allgather(mine), key=lambda one: one[:2])
    level = species[group].level
    scene, plan = (scene, *scene.finer)[level], (plan, *plan.finer)[level]
    reach = max(SEEN * scene.spacing, scene.support)
    around = _gathered(simulation, scene, place, reach, ~plan.materials.others[level])
    column = int(np.flatnonzero(around.shown("id") == -least)[0])
    offset = _away(_places(around), place, scene.layout.periods)
    place = simulation.domain.inside(place[None])[0]
    follow = plan.materials.where(lambda one: one.follows)[around.shown("group")]
    shares = () if follow[column] else _shares(simulation, scene, plan, around, column, offset)
    if any(kind.pushes_within for kind in simulation.plan.matter):
        others = sum((one.acceleration for one in shares), np.zeros(scene.dimensions))
        inner = around.shown("acceleration")[column] - others
        shares = (*shares, Share(INNER, inner, 0.0, np.zeros(scene.dimensions)))
    return Suspect(-least, place, around, offset, column, shares, scene, level, follow, plan.rate_passes)


def _places(store: Store) -> np.ndarray:
    """Where the particles are (n, dim), or were when they were last seen anywhere."""
    now, seen = store.shown("position"), store.shown("listed_position")
    return np.where(np.isfinite(now).all(axis=1, keepdims=True), now, seen)


def _away(places: np.ndarray, centre: np.ndarray, periods) -> np.ndarray:
    """The nearest image of each place as seen from the centre, m (n, dim)."""
    away = places - centre
    for d, period in enumerate(periods):
        if period is not None:
            away[:, d] -= period * np.rint(away[:, d] / period)
    return away


def _gathered(simulation: Simulation, scene, centre: np.ndarray, reach: float, groups: np.ndarray) -> Store:
    """The particles of some ``groups``, of all ranks, within ``reach`` m of a place, on every rank, by their
    ids."""
    store = simulation.store
    with np.errstate(over="ignore", invalid="ignore"):
        near = np.linalg.norm(_away(_places(store), centre, scene.layout.periods), axis=1) <= reach
    near &= groups[store.shown("group")]
    names = ("id", "group", *store.rows)
    parts = simulation.comm.allgather({name: store.shown(name)[near] for name in names})
    every = {name: np.concatenate([part[name] for part in parts]) for name in names}
    order = np.argsort(every["id"])
    gathered = Store(
        store.dimensions, store.fields.values(), store.constants, type(store.view()), store.kinds
    )
    block = np.empty((len(gathered.data), len(order)))
    for name, rows in gathered.rows.items():
        block[rows.start : rows.stop] = every[name][order].reshape(len(order), -1).T
    gathered.append(every["id"][order], every["group"][order], block)
    return gathered


def _shares(simulation, scene, plan, around: Store, column: int, offset: np.ndarray) -> tuple:
    """What each effect of the ``plan`` of its level does to a particle, by its plain formulas over its
    neighbours, in mirrors too."""
    view = seen_at(around.view(), simulation.previous_speed)
    view = with_length(view, scene.smoothing_length) if simulation.plan.finer else view
    reach = scene.support
    near = np.flatnonzero((np.linalg.norm(offset, axis=1) <= reach) & bool(plan.passes))
    i = take(view, column)
    mirrors = plan.mirrors
    pairs = []
    with np.errstate(all="ignore"):
        for m in range(images(mirrors)):
            for k in near if m else near[near != column]:
                j = image(at_look(mirrors, 2 * m), i, take(view, k))
                x_ij = nearest_image(subtract(i.position, j.position), scene.layout.periods)
                pairs.append((j, geometry(scene.kernel, x_ij, simulation.engine.softening[0], i, j)))
        return tuple(_share(call, i, pairs, simulation.dt) for call in plan.called)


def _share(call, i, pairs, dt: float) -> Share:
    alone = (call.effect,)
    sums = alone if hasattr(call.effect, "start") else ()
    a, rate, totals = zero_like(i.position), 0.0, terms.start(sums, i)
    for j, pair in pairs:
        rate = rate + terms.density_rate(alone, i, j, pair)
        a = pushed(a, pair.x_ij, terms.radial(alone, i, j, pair))
        a = pushed(a, pair.u_ij, terms.shear(alone, i, j, pair))
        a = added(a, terms.push(alone, i, j, pair))
        totals = terms.gather_each(sums, totals, i, j, pair)
    a = add(add(a, terms.finish_acceleration(sums, totals, i)), terms.body(alone, i))
    shift = terms.displacement(alone, i, dt)
    return Share(call.title, np.array(a), float(rate), np.array(shift) / dt if dt else np.zeros(len(a)))


def _size(numbers) -> float:
    """The length of a vector; of one that is not finite more than of any other."""
    length = float(np.linalg.norm(numbers))
    return length if np.isfinite(length) else np.inf
