"""How long the lists hold: a bound on how far any two neighbours may have drifted apart."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from psph.composition.reflections import Plane
from psph.parallel.domain import Domain
from psph.parallel.reductions import largest
from psph.particles.drift import bounding_boxes, largest_differences

PART_OF_CUTOFF = 0.5
"""A particle strays from its listed place by less than this part of the cutoff: two with two blocks
of cells between them, each a cutoff wide, cannot meet before new lists."""

WORN = 0.8
"""Part of the skin beyond which new lists cost less than to measure, some steps running, that the old
ones hold: of 0.7, 0.8 and 0.9 the best in a dam break in 2D."""

PART_OF_PERIOD = 0.25
"""Nor does it by more than this part of any period: the nearest image takes one period off at the
most."""

NEAR_PLANE = 1.5
"""Cutoffs from a mirror within which particles count as near it: whoever crosses it before new lists is."""


def nearer(planes: Sequence[Plane]) -> float:
    """By how much an image may be nearer than its particle, over how far one is beyond one of the ``planes``.

    Their distances squared differ by 4 d_i d_j, d those from the plane; √n times as much in a corner of n.
    """
    return 2.0 * len({plane.axis for plane in planes}) ** 0.5


def beyond(domain: Domain, planes: Sequence[Plane], velocity: str) -> tuple[float, float]:
    """How far this rank's particles are beyond one of the ``planes``, m, negative before it, and how fast
    they go there by the field ``velocity``, m/s, at the most; of those that were before it when they were
    listed."""
    store, farthest, fastest = domain.store, -math.inf, -math.inf
    for plane in planes:
        x, listed, v = (
            store[name][plane.axis][store.inner] for name in ("position", "listed_position", velocity)
        )
        way = plane.side * (x - plane.at)
        near = (way > -NEAR_PLANE * domain.cutoff) & (plane.side * (listed - plane.at) <= 0.0)
        farthest = max(farthest, float(way[near].max(initial=-math.inf)))
        fastest = max(fastest, float((plane.side * v[near]).max(initial=-math.inf)))
    return farthest, fastest


class Bounds(NamedTuple):
    """Between which widths, m, a skin is chosen, for pairs within ``support`` m in so many ``dimensions``,
    which a step goes through in so many ``passes``.

    Lists that serve n passes by a skin s, a part of the support, serve as many the longer the wider it is:
    with the wear σ = s/n a pass costs P (1 + s)^d + R σ/s, P for the pairs within the support, R for new
    lists, and s = √(σR/(dP)) is the best.  Both take about as long in the default scheme; where new lists ask
    for more, they are so many times as ``dear``, R/P.
    """

    least: float
    most: float
    support: float
    dimensions: int
    passes: int
    dear: float = 1.0

    def wide_enough(self, width: float, served: int) -> float:
        """The width after lists of this ``width``, m, that have served so many steps: half-way to the best,
        as each of the last lists may have been the exception."""
        wear = width / (self.support * served * self.passes)
        best = self.support * (self.dear * wear / self.dimensions) ** 0.5
        return min(max((width * best) ** 0.5, self.least), self.most)


class Unlisted:
    """In the place of a skin where no particle looks for neighbours in space: nothing to list."""

    farthest = math.inf
    """Nothing bounds how far particles are from where they were listed."""

    def choose(self) -> None:
        """Nothing reaches anywhere."""

    def renew(self) -> None:
        """Nothing changes."""

    def state(self) -> dict[str, float | None]:
        """Nothing is known."""
        return {}

    def reach_as(self, state: dict[str, float | None]) -> None:
        """Nor does it anywhere else."""

    def restore(self, state: dict[str, float | None]) -> None:
        """Nothing was."""

    def holds(self, dt: float, speed: float, acceleration: float, shift: float = 0.0) -> bool:
        """Particles stay on their ranks."""
        return True


class Skin:
    """Keeps the lists of ``domain`` until two neighbours could differ by ``width`` m.

    What counts is the displacement of neighbours relative to each other, not their speed: a body
    of water that falls as one needs new lists only now and then, unless it meets another one.
    It is measured now and then; in between it is bounded by |Δx| ≤ |Δx|₀ + t (|Δv|₀ + 2 s +
    2 a (t + Δt)), with the fastest shift s of a particle beside its velocity.  The predicted velocity
    that is measured still contains half a step of the acceleration before, and lacks half a step of
    the present one: a is the largest of both and of all since, Δt the longest of these steps.
    An image in one of the ``planes`` is farther away than its particle, which is listed.  So images count
    only where a particle is beyond a plane (:func:`nearer`).  No particle is more than ``farthest`` m from
    where it was listed.  The same on every rank. With ``bounds`` the skin is as wide as pays by how long the
    last lists have served."""

    remembered: tuple[str, ...] = (
        "width",
        "_served",
        "drifted",
        "_apart",
        "_since",
        "_closing",
        "_beyond",
        "_crossing",
        "_acceleration",
        "_shift",
        "_before",
        "_longest_step",
    )
    """What is known of the lists since they were made, and of the step before."""

    def __init__(
        self, domain: Domain, width: float, planes: Sequence[Plane] = (), bounds: Bounds | None = None
    ):
        self.domain, self.width, self._planes, self._bounds = domain, width, planes, bounds
        self._nearer = nearer(planes)
        self._shortest = min((p for p in domain.periods if p is not None), default=math.inf)
        self._before = [0.0, 0.0]
        self.renew()
        self._support = domain.reach - width
        self._served = 0  # there are no lists yet

    @property
    def farthest(self) -> float:
        """Bound on how far a particle is from where it was listed, m."""
        return min(PART_OF_CUTOFF * self.domain.cutoff, PART_OF_PERIOD * self._shortest)

    def choose(self) -> None:
        """How far lists reach that are made now."""
        if self._bounds is not None and self._served:
            self._take(self._bounds.wide_enough(self.width, self._served))

    def _take(self, width: float) -> None:
        """Lists reach so many m beyond the kernel."""
        # By no sum of earlier changes, whose rounding a restart would not have.
        self.domain.reach, self.width = self._support + width, width

    def renew(self) -> None:
        """The lists are new."""
        self._served = 1
        self.drifted = self._apart = self._since = 0.0
        self._closing: float | None = None
        self._beyond = self._crossing = -math.inf
        self._acceleration = self._shift = self._longest_step = 0.0

    def state(self) -> dict[str, float | None]:
        """All that the next answers rest on, but for the particles."""
        return {name: getattr(self, name) for name in self.remembered}

    def reach_as(self, state: dict[str, float | None]) -> None:
        """Lists reach as far as those did that are known so well."""
        self._take(state["width"])

    def restore(self, state: dict[str, float | None]) -> None:
        """Go on as if the lists had been in use since they were made."""
        for name in self.remembered:
            setattr(self, name, state[name])

    def holds(self, dt: float, speed: float, acceleration: float, shift: float = 0.0) -> bool:
        """Whether the lists still hold after a step of ``dt`` s; collective where it must measure.

        ``speed``, ``acceleration`` and ``shift`` (m/s) are the largest of the scene.
        """
        # All of these are the same on every rank, so all ranks measure, keep or rebuild together.
        before, self._before = self._before, [acceleration, dt]
        self._add(acceleration, dt, shift)
        if self._closing is None or not self._bounded(dt, speed):
            if self._worn:
                return False  # a measurement would hardly buy a step
            self._measure()
            self._acceleration = self._shift = self._longest_step = 0.0
            self._add(acceleration, dt, shift)
            self._add(*before, shift)
            if not self._bounded(dt, speed):
                return False
        self._served += 1
        self._since += dt
        self.drifted += self._way(dt, speed)
        return True

    def _add(self, acceleration: float, dt: float, shift: float) -> None:
        """Take a step into the bounds; NaN counts as more."""
        if not acceleration <= self._acceleration:
            self._acceleration = acceleration
        if not shift <= self._shift:
            self._shift = shift
        self._longest_step = max(self._longest_step, dt)

    @property
    def _worn(self) -> bool:
        """Whether hardly any skin is left, by what was measured last."""
        known = self._closing is not None
        return known and self._apart + self._since * self._closing > WORN * self.width

    def _bounded(self, dt: float, speed: float) -> bool:
        t = self._since + dt
        pushed = self._acceleration * (t + self._longest_step)
        apart = self._apart + t * (self._closing + 2.0 * self._shift + 2.0 * pushed)
        beyond = max(self._beyond + t * (self._crossing + self._shift + pushed), 0.0)
        return (
            apart + self._nearer * beyond < self.width and self.drifted + self._way(dt, speed) < self.farthest
        )

    def _way(self, dt: float, speed: float) -> float:
        return dt * (speed + self._shift + 0.5 * dt * self._acceleration)

    def _measure(self) -> None:
        domain, store = self.domain, self.domain.store
        rows = (
            np.array(store.rows[name], np.int64)
            for name in ("position", "listed_position", "predicted_velocity")
        )
        grid = domain.grid
        boxes = bounding_boxes(
            store.data, *rows, domain.starts, domain.planes, grid.counts, grid.reach, grid.periodic
        )
        # Ghosts are in the boxes, so that a pair across two slabs is seen by at least one of their ranks.
        mine = largest_differences(*boxes, domain.planes, grid.counts[1], grid.of_counts, grid.periodic)
        across = beyond(self.domain, self._planes, "predicted_velocity") if self._planes else ()
        apart, closing, drifted, *across = largest(domain.comm, [*mine, *across]).tolist()
        if across:
            self._beyond, self._crossing = across
        self._apart, self._closing = apart**0.5, closing**0.5
        self.drifted = drifted**0.5
        self._since = 0.0
