"""Fluids that start relaxed find their places: from a shaken lattice they go to where it is less crowded.

A lattice is a special state: flow shears its rows apart, and where it breaks it sounds.  Relaxed particles
stand as those of a flow do after a while, without order but evenly.  Colagrossi, Bouscasse, Antuono & Marrone
(2012), Comput. Phys. Commun. 183, 1641, pack particles so, by an acceleration −β Σ V ∇W and a friction.
"""

from typing import NamedTuple

import numpy as np

from psph.composition.reflections import mirrors_of
from psph.engine.jit import elementwise
from psph.engine.threads import in_threads
from psph.fields import LISTED_POSITION, POSITION, VECTOR, Field, view_of
from psph.parallel.domain import Domain, Extent, Travels
from psph.parallel.reductions import largest
from psph.particles.store import Store
from psph.scene.particles import ParticleSet, settled_at
from psph.scene.relaxing import ITERATIONS, held_sites, relaxing, wider
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

STEP = Field("step", "m", "the last step of a particle", VECTOR)
WHOSE = Field("whose", "1", "number of the part that has it; −1 less that of who stands still")
"""Ghosts have no group, and so it travels."""


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


def relaxed(scene, found: ParticleSet, comm) -> ParticleSet:
    """The particles ``found`` of a scene, of which each rank has a part: those of fluids that relax are where
    they come to stand, on whichever rank, with the state that the scene has there; collective."""
    fluids = relaxing(scene.layout)
    if not fluids:
        return found
    moving = np.isin(found.material, fluids)
    domain = _domain(scene, comm, found.where(moving))
    _relax(scene, domain)
    store = domain.store
    free = store["whose"][store.inner] >= 0.0
    position = domain.inside(store.owned_rows("position"))[free]
    return found.where(~moving).joined(
        settled_at(scene.starts, store.id[store.inner][free], store.group[store.inner][free], position)
    )


def _domain(scene, comm, moving: ParticleSet) -> Domain:
    """The domain of the particles that move, and of the sites that hold them."""
    layout, lattice = scene.layout, wider(scene.layout)
    fields = (POSITION, LISTED_POSITION, WHOSE, STEP)
    store = Store(layout.dimensions, fields, {}, view_of(("position",)))
    ends = [lattice.planes * rank // comm.size for rank in (comm.rank, comm.rank + 1)]
    held = held_sites(layout, *ends)
    behind = held.id + int(scene.census.counts.sum())
    both = (
        (moving.id, moving.material, moving.material.astype(float), moving.position),
        (behind, held.part, -1.0 - held.part, held.position),
    )
    for ids, part, whose, position in both:
        block = np.zeros((len(store.data), len(ids)))
        block[list(store.rows["position"])] = position.T
        block[store.rows["whose"].start] = whose
        store.append(ids, part, block)
    lower = tuple(map(min, layout.lower, lattice.lower))
    upper = tuple(map(max, layout.upper, lattice.upper))
    return Domain(
        comm,
        store,
        Extent(layout.axis, lower, upper, layout.periods),
        layout.reach.cutoff,
        Travels(("whose",), ("position",)),
    )


def _relax(scene, domain: Domain) -> None:
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
        in_threads(find_ways, *inner, store["position"], store["whose"], store.low, domain.lists, by, way)
        moved += float(largest(domain.comm, [_step(store, way, *step)])[0])


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
def find_ways(first, last, position, whose, low, lists, crowd, way):
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
                pull = crowd.volume * slope_over_r(crowd.kernel, r, 1.0 / r)
                total = add(total, scale(away, -pull * (1.0 + crowd.near * (w2 * w2))))
        put(way, k, total)
