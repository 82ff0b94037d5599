"""Fluids that start relaxed find their places: from a shaken lattice they go to where it is less crowded.  So
do those beside what is fitted (psph.simulation.fitting), from the sites that they have.

A lattice is a special state: flow shears its rows apart, and where it breaks it sounds.  Relaxed particles
stand as those of a flow do after a while, without order but evenly.  Colagrossi, Bouscasse, Antuono & Marrone
(2012), Comput. Phys. Commun. 183, 1641, pack particles so, by an acceleration −β Σ V ∇W and a friction.
"""

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np

from psph.composition.reflections import mirrors_of
from psph.engine.jit import elementwise
from psph.engine.threads import in_threads
from psph.fields import LISTED_POSITION, POSITION, VECTOR, Field, view_of
from psph.parallel.domain import Domain, Extent, Travels
from psph.parallel.reductions import largest
from psph.particles.store import Store
from psph.scene.fitting import fitted_parts, near_faces
from psph.scene.layout import NONE
from psph.scene.particles import ParticleSet, settled_at
from psph.scene.relaxing import ITERATIONS, held_sites, relaxing, wider
from psph.simulation.along_faces import OUTSIDE, SIDE, Along
from psph.smoothing import slope_over_r, weight
from psph.vectors import add, at, dot, multiply, nearest_image, put, scale, subtract, zero_like

STRENGTH = 0.25
"""Of a step, in h² times the gradient of crowding; with 0.5 neighbours oscillate and never come to rest."""

LONGEST = 0.1
"""A step, in spacings."""

NEAR = 0.2
"""Weight R of the term that keeps pairs from clumping, in the first half of the steps: it takes pairs apart,
but what it leaves is less even."""

KEPT = 0.9
"""Of a step, by the next one."""

CORNERS = 4
"""How often what is left at the end is put on its side: in a corner one face leads through the other."""

SELDOM = 5
"""Steps after which faces are looked for anew: in between they are planes."""

STEP = Field("step", "m", "the last step of a particle", VECTOR)
WHOSE = Field("whose", "1", "number of the part that has it; −1 less that of who stands still")
"""Ghosts have no group, and so it travels."""
FILLED = Field("filled", "1", "part of its volume that crowds others")


class Crowd(NamedTuple):
    """What crowds particles: the ``kernel``, R/W(dx)⁴ as ``near``, m^4d, the volume of each, m^d, its support
    squared, m², ``periods``, m, and ``turn`` x + ``shift``, m, the images of x, x itself first."""

    kernel: object
    near: float
    volume: float
    reach2: float
    periods: tuple
    turn: tuple
    shift: tuple


class Resting(NamedTuple):
    """What crowds those that move, and stands still: its ids (n,), ``whose`` it is (n,), where it stands,
    ``position`` (n, dim) m, and which part of a particle's volume it fills, ``filled`` (n,)."""

    id: np.ndarray
    whose: np.ndarray
    position: np.ndarray
    filled: np.ndarray

    @classmethod
    def of(cls, ids: np.ndarray, part: np.ndarray, position: np.ndarray) -> "Resting":
        """Of some parts (n,)."""
        return cls(ids, -1.0 - part, position, np.ones(len(ids)))

    def filled_by(self, part: np.ndarray) -> "Resting":
        """Those of which a ``part`` (n,) of the volume is filled, above nothing."""
        return Resting(*(values[part > 0.0] for values in self._replace(filled=part)))

    def and_also(self, other: "Resting") -> "Resting":
        """Both."""
        return Resting(*map(np.concatenate, zip(self, other)))


class Sides(Protocol):
    """Faces on whose one side particles stay."""

    def look(self, store: Store) -> None:
        """Find the faces beside all particles here."""

    def hold(self, store: Store, step: tuple) -> None:
        """Keep the particles on their side, and their last ``step`` from leading them to the other."""


def relaxed(scene, found: ParticleSet, comm) -> ParticleSet:
    """The particles ``found`` of a scene, of which each rank has a part: those of fluids that relax, and of
    all that flows those beside fitted walls and bodies, are where they come to stand, on whichever rank, with
    the state that the scene has there; collective."""
    layout, parts = scene.layout, relaxing(scene.layout)
    moving, along = np.isin(found.material, parts), fitted_parts(layout)
    if along:
        parts = [part.number for part in layout.parts if part.flows]
        flows = np.flatnonzero(np.isin(found.material, parts) & ~moving)
        moving[flows] = near_faces(layout, along, found.position[flows])
    if not parts:
        return found
    still = sites_beside(scene, comm, parts, ~np.isin(np.arange(NONE + 1), along))
    # Fitted particles are not where their sites are; of what flows those farther off stand still.
    stands = ~moving & np.isin(found.material, (*along, *parts))
    whose = np.where(np.isin(found.material, parts), NONE, found.material)[stands]
    still = still.and_also(Resting.of(found.id[stands], whose, found.position[stands]))
    domain = domain_of(scene, comm, found.where(moving), still, SIDE if along else ())
    settle(scene, domain, Along(layout, along, OUTSIDE) if along else None)
    return found.where(~moving).joined(settled_at(scene.starts, *places_in(domain)))


def places_in(domain: Domain) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of those that move the ids (n,), parts (n,) and places (n, dim), m, that this rank has of them."""
    store = domain.store
    free = store["whose"][store.inner] >= 0.0
    position = domain.inside(store.owned_rows("position"))[free]
    return store.id[store.inner][free], store.group[store.inner][free], position


def sites_beside(scene, comm, parts: list[int], some: np.ndarray) -> Resting:
    """This rank's share of the sites that hold ``parts`` in their shapes, of ``some`` parts (NONE + 1,)."""
    planes = wider(scene.layout).planes
    held = held_sites(
        scene.layout, parts, *(planes * rank // comm.size for rank in (comm.rank, comm.rank + 1))
    )
    stand = some[held.part]
    behind = held.id[stand] + int(scene.census.counts.sum())
    return Resting.of(behind, held.part[stand], held.position[stand])


def domain_of(scene, comm, moving: ParticleSet, still: Resting, more: Sequence[Field] = ()) -> Domain:
    """The domain of particles that move, and of what stands still; with ``more`` fields."""
    layout, lattice = scene.layout, wider(scene.layout)
    fields = (POSITION, LISTED_POSITION, WHOSE, FILLED, STEP, *more)
    store = Store(layout.dimensions, fields, {}, view_of(("position",)))
    both = (
        (moving.id, moving.material, moving.material.astype(float), moving.position, 1.0),
        (still.id, np.full(len(still.id), NONE, np.uint8), *still[1:]),
    )
    for ids, part, whose, position, filled in both:
        block = np.zeros((len(store.data), len(ids)))
        block[list(store.rows["position"])] = position.T
        block[store.rows["whose"].start], block[store.rows["filled"].start] = whose, filled
        store.append(ids, part, block)
    lower = tuple(map(min, layout.lower, lattice.lower))
    upper = tuple(map(max, layout.upper, lattice.upper))
    return Domain(
        comm,
        store,
        Extent(layout.axis, lower, upper, layout.periods),
        layout.reach.cutoff,
        Travels(("whose", "filled"), ("position",)),
    )


def settle(scene, domain: Domain, faces: Sides | None = None) -> None:
    """Let particles of the ``domain`` go to where it is less crowded; some come to stand along ``faces``."""
    store, layout = domain.store, scene.layout
    skin, moved = domain.cutoff - layout.support, np.inf
    crowd = _crowd(scene)
    even = crowd._replace(near=0.0)
    step = STRENGTH * layout.smoothing_length**2, LONGEST * layout.spacing
    for k in range(ITERATIONS):
        if 2.0 * moved > skin:
            domain.rebuild()
            moved = 0.0
        else:
            domain.halo.refresh(("position",))
        way = tuple(np.zeros(store.total) for _ in range(layout.dimensions))
        inner = store.low, store.low + store.owned
        by = crowd if 2 * k < ITERATIONS else even
        told = store["position"], store["whose"], store["filled"], store.low, domain.lists
        in_threads(find_ways, *inner, *told, by, way)
        if faces and (k % SELDOM == 0 or k == ITERATIONS - 1):
            faces.look(store)
        moved += float(largest(domain.comm, [_step(store, way, *step)])[0])
        if faces:
            faces.hold(store, store[STEP.name])
    for _ in range(CORNERS if faces else 0):
        faces.look(store)
        faces.hold(store, store[STEP.name])


def _step(store: Store, way: tuple, strength: float, longest: float) -> float:
    """Move all particles here by 0.9 of their last step and ``strength`` m² times their ``way``, at most by
    ``longest`` m; how far the fastest of them goes, m."""
    inner = store.inner  # a ghost's step is its owner's to take
    steps = [own[inner] for own in store[STEP.name]]
    for own, along in zip(steps, way):
        own *= KEPT
        own += strength * along[inner]
    size = np.sqrt(sum(own * own for own in steps))
    shorter = 1.0 / np.maximum(1.0, size / longest)
    for x, own in zip(store["position"], steps):
        own *= shorter
        x[inner] += own
    return float((size * shorter).max(initial=0.0))


def _crowd(scene) -> Crowd:
    layout = scene.layout
    volume = layout.spacing**layout.dimensions
    mirrors = mirrors_of(layout.mirror_planes, layout.gravity, layout.reach.cutoff, ())
    still = (1.0,) * layout.dimensions, (0.0,) * layout.dimensions
    seen = [(one.turn, one.shift) for one in mirrors.reflections] if mirrors else [still]
    near = NEAR / float(weight(layout.kernel, layout.spacing)) ** 4
    return Crowd(layout.kernel, near, volume, layout.support**2, layout.periods, *zip(*seen))


@elementwise
def find_ways(first, last, position, whose, filled, low, lists, crowd, way):
    """The way out of the crowd, −Σ V [1 + R (W/W(dx))⁴] ∇W in 1/m, of the particles in some columns.

    Those of one part and the sites of all others crowd; what stands still has no way.
    """
    for k in range(first, last):
        own = whose[k]
        if own < 0.0:
            continue
        x = at(position, k)
        total = zero_like(x)
        row = k - low
        begin = np.int64(lists.begin[row])
        end = begin + np.int64(lists.lengths[row])
        for m in range(len(crowd.turn)):
            turn, shift = crowd.turn[m], crowd.shift[m]
            if m > 0:
                away = subtract(x, add(multiply(turn, x), shift))
                if dot(away, away) >= 4.0 * len(x) * crowd.reach2:
                    continue
            for entry in range(begin - (1 if m > 0 else 0), end):
                j = k if entry < begin else np.int64(lists.lists[entry])
                other = whose[j]
                if other != own and (other >= 0.0 or other == -1.0 - own):
                    continue
                image = add(multiply(turn, at(position, j)), shift)
                away = nearest_image(subtract(x, image), crowd.periods)
                r2 = dot(away, away)
                if r2 >= crowd.reach2 or r2 == 0.0:
                    continue
                r = np.sqrt(r2)
                w2 = weight(crowd.kernel, r) ** 2
                pull = filled[j] * crowd.volume * slope_over_r(crowd.kernel, r, 1.0 / r)
                total = add(total, scale(away, -pull * (1.0 + crowd.near * (w2 * w2))))
        put(way, k, total)
