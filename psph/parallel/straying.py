"""How long the lists hold where each particle has its own size: a bound on how far each has strayed."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from psph.composition.reflections import Plane
from psph.engine.threads import in_threads
from psph.parallel.domain import Domain
from psph.parallel.reductions import exact_sums, largest
from psph.parallel.skin import PART_OF_CUTOFF, PART_OF_PERIOD, Bounds, beyond, nearer
from psph.particles.drift_by_size import shares_moved, stray
from psph.particles.sizes import Sizes

ENOUGH = 1.1
"""Growth left to all by their own ways alone, with which nobody looks how far neighbours have come."""

ROUNDING = 1e-9
"""Part of a support by which a bound is beyond what is bounded, more than both are rounded by."""


class Look(NamedTuple):
    """What was seen when neighbours were last looked at: that they had come ``apart`` from each other by no
    more than this, over their support, the ``narrowest`` of all supports, m, and where own particles stood,
    ``places`` (dim,) (owned,) m."""

    apart: float
    narrowest: float
    places: tuple[np.ndarray, ...]


class Straying:
    """Keeps the lists of ``domain`` while they reach as far as particles have strayed and grown.

    Lists reach so far beyond the larger support of a pair (psph.particles.sizes).  How
    far each has strayed is measured where it stands at the end of a step, less the way that all matter has
    gone in the mean: a cloud that drifts as one needs no new lists for it.  Where that is too much, what
    counts is how far neighbours have come from each other at the most, over their sizes: a gas that a shock
    drives on goes together.  Images in ``planes`` count as in :class:`psph.parallel.skin.Skin`; beside those
    that move nobody asks who goes together.  Where sizes stay, nobody looks at that again before a bound by
    the last look asks for it.  No particle is more than ``farthest`` m from where it was listed.  By
    ``growth`` (owned,) a smoothing length may be larger than then for lists to hold.  Where sizes say so, the
    skin is as wide as pays by how long the last lists have served, and half-way between its bounds at first.
    The same on every rank.
    """

    def __init__(self, domain: Domain, sizes: Sizes, planes: Sequence[Plane] = ()):
        self.domain, self._sizes = domain, sizes
        self._planes = [plane for plane in planes if plane.motion is None]
        self._together = len(self._planes) == len(planes)
        self._shortest = min((p for p in domain.periods if p is not None), default=math.inf)
        self._drift, self._since = (0.0,) * domain.store.dimensions, 0.0
        self.growth = np.zeros(0)
        self._look: Look | None = None
        self._narrowest: float | None = None
        self._served, self._bounds = 0, None  # there are no lists yet
        if sizes.least is not None:
            self._bounds = Bounds(sizes.least, sizes.skin, 1.0, domain.store.dimensions, 1, sizes.dear)
            self._take((sizes.least * sizes.skin) ** 0.5)

    @property
    def farthest(self) -> float:
        """Bound on how far a particle is from where it was listed, m."""
        usual = min(PART_OF_CUTOFF * self.domain.cutoff, PART_OF_PERIOD * self._shortest)
        return min(usual, self._sizes.strays)

    def choose(self) -> None:
        """How far lists reach that are made now."""
        if self._bounds is not None and self._served:
            self._take(self._bounds.wide_enough(self._sizes.skin, self._served))

    def _take(self, skin: float) -> None:
        """Lists reach so much farther, as a part of the support."""
        self._sizes = self.domain.sizes = self._sizes._replace(skin=skin)

    def reach_as(self, state) -> None:
        """Lists reach as far as those did that are known so well."""
        self._take(state["skin"])

    def renew(self) -> None:
        """The lists are new; collective."""
        store, inner = self.domain.store, self.domain.store.inner
        terms = [store.shown("mass"), *(store.shown("mass") * v[inner] for v in store["velocity"])]
        mass, *momentum = exact_sums(self.domain.comm, np.stack(terms, axis=1)).tolist()
        self._drift, self._since, self._served = tuple(p / mass for p in momentum), 0.0, 1
        self.growth = np.full(store.owned, self._sizes.growth_left(0.0, 0.0))
        self._look = self._narrowest = None

    def holds(self, dt: float, speed: float, acceleration: float, shift: float = 0.0) -> bool:
        """True: it is measured once particles have moved by the step of ``dt`` s, see :meth:`reach`."""
        self._since += dt
        self._served += 1
        return True

    def reach(self) -> bool:
        """Whether the lists reach far enough for where particles stand now; collective."""
        store, since = self.domain.store, self._since
        share = np.empty(store.owned) if self._sizes.grow else None
        own = tuple(v * since for v in self._drift), self._sizes.support, store.low, share
        told = store["position"], store["listed_position"], store[self._sizes.listed], *own
        tops = np.max(in_threads(stray, store.low, store.low + store.owned, *told), axis=0)
        apart2, most, mirrored = largest(self.domain.comm, [*tops, self._mirrored()]).tolist()
        most += 0.5 * mirrored
        if share is not None:
            self.growth = self._sizes.growth_left(share + 0.5 * mirrored, most)
        # Written so that NaN asks for new lists.
        near = apart2 < self.farthest**2
        enough = ENOUGH if self._sizes.grow else self._sizes.least_growth
        if near and self._together and not self._sizes.growth_left(most, most) > enough:
            if self._look is not None and most < math.inf:
                bound = self._bound(self._look) + 0.5 * mirrored
                if self._sizes.growth_left(bound, bound) > self._sizes.least_growth:
                    return True
            most = min(most, self._see_who_goes_together(mirrored) + 0.5 * mirrored)
        return near and self._sizes.growth_left(most, most) > self._sizes.least_growth

    def _mirrored(self) -> float:
        """How much nearer than its particle an image may be on this rank, over the narrowest support."""
        if not self._planes:
            return 0.0
        if self._narrowest is None:
            store = self.domain.store
            self._narrowest = store[self._sizes.listed][: store.total].min(initial=math.inf)
        away = max(beyond(self.domain, self._planes, "velocity")[0], 0.0)
        return nearer(self._planes) * away / (self._sizes.support * self._narrowest)

    def _see_who_goes_together(self, mirrored: float) -> float:
        """More growth where neighbours have come little from each other, and images have come nearer by what
        is ``mirrored``; half of the most that any have, over their support.  Collective."""
        domain, store, support = self.domain, self.domain.store, self._sizes.support
        domain.halo.refresh(("position",))  # ghosts stand where they were
        names = "position", "listed_position", "velocity"
        rows = [np.array(store.rows[name], np.int64) for name in names]
        length = store[self._sizes.listed][: store.total]
        share, across = shares_moved(store.data, rows, length, domain.starts, domain.planes, domain.grid)
        share = share[store.inner] / support
        told = share.max(initial=0.0), across / support, -length.min(initial=math.inf)
        most, across, narrowest = largest(domain.comm, [*told]).tolist()
        if not self._sizes.grow:
            places = tuple(x[store.inner].copy() for x in store["position"])
            self._look = Look(max(most, across), -narrowest * support, places)
        else:
            found = self._sizes.growth_left(np.maximum(share, across) + mirrored, 0.0)
            self.growth = np.maximum(self.growth, found)
        return 0.5 * max(most, across)

    def _bound(self, look: Look) -> float:
        """Half of the most that a look would find now, over their support, at the most; collective.

        The range of a way in a box of particles, by which neighbours are told, is wider than it was then by
        the range R_d of the ways since then of all particles, at the most: so with the narrowest support r
        none have come apart by more than A + |R|/r, A then.  Where that suffices a look would say the same,
        so a run that goes on without it, from a checkpoint, has the same lists.
        """
        store = self.domain.store
        ways = [x[store.inner] - then for x, then in zip(store["position"], look.places)]
        ends = [end.max(initial=-math.inf) for way in ways for end in (way, -way)]
        ranges = largest(self.domain.comm, ends).reshape(-1, 2).sum(axis=1)
        return 0.5 * (look.apart + math.hypot(*ranges) / look.narrowest + ROUNDING)

    def state(self) -> dict:
        """What :meth:`reach` rests on beside the particles."""
        known = {"drift": self._drift, "since": self._since}
        return known | {"skin": self._sizes.skin, "served": self._served}

    def restore(self, state: dict) -> None:
        """Go on as if the lists had been in use since they were made."""
        self._drift, self._since = tuple(state["drift"]), state["since"]
        self._look = self._narrowest = None
        self._served = state["served"]
