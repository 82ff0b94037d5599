"""Probes: fields interpolated at fixed points, and how far the fluid reaches."""

import math
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np

from psph.composition.mirrors import image, images
from psph.composition.pair import take
from psph.engine.jit import call_by_type, elementwise
from psph.engine.settled import settled
from psph.fields import PRESSURE, SAVED, by_name, view_of
from psph.output.flowing import ALL, counted
from psph.parallel.reductions import Contribution, Total, totals
from psph.particles.store import Store
from psph.particles.wetting import WET
from psph.physics.walls.dry import DryWall
from psph.smoothing import unit_kernel, weight
from psph.vectors import at, dot, inside, nearest_image, subtract

MEASURED = by_name(SAVED)

ROUNDING = 1e-9
"""In spacings: a length that is a whole number of them but for rounding has that many points."""

WET_MARK = DryWall.marks.name
"""The field that tells which walls have fluid in reach."""

NONE = -1
"""In the place of the number of a row: there is none."""

FRONT = "front"
"""The quantity of a probe that follows the fluid."""


class FieldProbe:
    """Fields of the fluid at a point, f = Σ_j W V_j f_j / Σ_j W V_j (Shepard 1968), or their mean over some.

    The sums are over the fluid and the walls that it wets, so that at a wall the mean is not that of
    one side alone; beside mirrors (psph.composition.mirrors) over images too.  Where particles have sizes of
    their own, each has the weight of its own smoothing length.  ``points`` (n, dim) m:
    of a sensor those of its area.  A point without fluid in reach bears no pressure: it counts as 0 Pa, and
    for nothing else.  ``fields`` names of saved fields; ``rows`` counts the values taken so far, ``dry``
    those without fluid in reach of any point.
    """

    def __init__(self, name: str, points: np.ndarray, fields: tuple[str, ...]):
        self.name, self.points, self.fields = name, np.atleast_2d(points), fields
        self.rows = self.dry = 0
        self._weigh = settled(weigh_near)

    def columns(self, dimensions: int) -> list[str]:
        """Names of the values: ``P1.pressure``, ``P1.velocity_x``."""
        return [
            f"{self.name}.{field}{suffix}"
            for field in self.fields
            for suffix in ([f"_{axis}" for axis in "xyz"[:dimensions]] if MEASURED[field].composed else [""])
        ]

    def sample(self, simulation) -> np.ndarray:
        """Values in the order of :meth:`columns` on every rank; where no fluid is near, 0 for a pressure and
        NaN for all else.  Collective."""
        return self.values(simulation.store, *totals(simulation.comm, [self.share(simulation)]))

    def ranges(self, simulation) -> Iterator[tuple[int, int]]:
        """For each point and image of it the first column, and that after the last, among which all stand
        that it sees."""
        around = simulation.neighbourhood
        return (around.columns_near(place, around.reach) for _, place in self._places(around.mirrors))

    def share(self, simulation) -> Contribution:
        """What this rank adds to the sums that :meth:`values` takes: for each point W V_j in the fluid,
        W V_j, W V_j f_j, a row for each particle and image near.

        Every rank finds the near ones among its own particles, wherever these have drifted since
        the lists were made; the sums do not depend on how particles are spread.
        """
        rows = np.array([row for field in self.fields for row in simulation.store.rows[field]], np.int64)
        mirrors = simulation.neighbourhood.mirrors
        seen = [self._seen(simulation, place, m, rows) for m, place in self._places(mirrors)]
        if len(seen) == 1:
            return Contribution(seen[0])
        terms = np.zeros((sum(map(len, seen)), len(self.points) * (2 + len(rows))))
        last = 0
        for k, near in enumerate(seen):
            first, last = last, last + len(near)
            place = k // images(mirrors) * (2 + len(rows))
            terms[first:last, place : place + 2 + len(rows)] = near
        return Contribution(terms)

    def values(self, store: Store, total: Total) -> np.ndarray:
        """What :meth:`sample` returns, of what the :meth:`share` of all ranks come to."""
        sums = total.sums.reshape(len(self.points), -1)
        wet = sums[:, 0] > 0.0
        reached = int(np.count_nonzero(wet))
        self.rows += 1
        self.dry += not reached
        if reached == len(wet):
            return (sums[:, 2:] / sums[:, 1:2]).sum(axis=0) / reached
        # What no fluid reaches bears no pressure.
        counted = [len(wet) if f == PRESSURE.name else reached for f in self.fields for _ in store.rows[f]]
        with np.errstate(invalid="ignore"):
            return (sums[wet, 2:] / sums[wet, 1:2]).sum(axis=0) / counted  # 0/0 where all is dry

    def _places(self, mirrors) -> Iterator[tuple[int, tuple[float, ...]]]:
        """Of each point the place of every image m in ``mirrors``, and of itself as m = 0, m."""
        # An image is as far from the point as the particle from the image of the point.
        for point in self.points:
            yield 0, tuple(map(float, point))
            for m in range(1, images(mirrors)):
                yield m, mirrors.reflections[m].seen(point)

    def _seen(self, simulation, place: tuple[float, ...], m: int, rows: np.ndarray) -> np.ndarray:
        """The :meth:`terms` of one point, of this rank's particles in reach of it or of its image m at
        ``place``."""
        store, periods, reach = simulation.store, simulation.domain.periods, simulation.neighbourhood.reach
        first, last = simulation.neighbourhood.columns_near(place, reach)
        weighs, view = _weighing(simulation.plan, store)
        around = Nearby(place, reach**2, weighs, simulation.domain.lower, periods)
        near, terms = np.empty(last - first, np.int64), np.empty((last - first, 2 + len(rows)))
        [wet] = store.rows[WET_MARK] if WET_MARK in store else [NONE]
        groups = store.group, counted(store.kinds, ALL)
        count = self._weigh(first, last, around, view, *groups, store.data, wet, rows, near, terms)
        near, terms = near[:count], terms[:count]
        if m:
            values = values_behind(simulation.neighbourhood.mirrors.reflections[m], store, near, self.fields)
            terms[:, 2:] = terms[:, 1:2] * np.column_stack(list(values))
        return terms


def sensor(position, extent, spacing: float) -> np.ndarray:
    """Points (n, dim) of a sensor around ``position``: so many per length of ``extent`` (dim,), m, that they
    stand at most a ``spacing`` apart."""
    counts = [max(1, math.ceil(length / spacing - ROUNDING)) for length in extent]
    along = [length * ((np.arange(n) + 0.5) / n - 0.5) for length, n in zip(extent, counts)]
    grid = np.meshgrid(*along, indexing="ij")
    return np.array(position) + np.column_stack([x.ravel() for x in grid])


class Front:
    """How far the fluids of the groups ``of`` reach along an ``axis`` (0, 1 or 2): their largest coordinate,
    m, of those that are ``within`` a region (psph.output.gauges.volume.Within) where one is given; NaN where
    there are none."""

    def __init__(self, name: str, axis: int, of: tuple[int, ...] = ALL, within=None):
        self.name, self.axis, self.of, self.within = name, axis, of, within

    def columns(self, dimensions: int) -> list[str]:
        """The name of the value: ``tip.front``."""
        return [f"{self.name}.{FRONT}"]

    def sample(self, simulation) -> np.ndarray:
        """The value on every rank; collective."""
        return self.values(simulation.store, *totals(simulation.comm, [self.share(simulation)]))

    def ranges(self, simulation) -> Iterable[tuple[int, int]]:
        """It reads nothing that would have to be settled."""
        return ()

    def share(self, simulation) -> Contribution:
        """How far those of this rank reach."""
        store = simulation.store
        fluid = counted(store.kinds, self.of)[store.shown("group")]
        places = simulation.domain.inside(store.shown("position"))
        if self.within is not None:
            fluid = fluid & self.within.holds(places, simulation.domain.periods)
        reach = places[:, self.axis].max(where=fluid, initial=-np.inf)
        return Contribution(tops=[float(reach)])

    def values(self, store: Store, total: Total) -> np.ndarray:
        """What :meth:`sample` returns, of what the :meth:`share` of all ranks come to."""
        return np.where(np.isfinite(total.tops), total.tops, np.nan)


def values_behind(reflection, store, near: np.ndarray, fields: tuple[str, ...]) -> Iterator[np.ndarray]:
    """Each component of some ``fields`` of the images of the columns ``near`` in a reflection."""

    def at_near(name: str):
        # A gas has no rest, and its images bear no weight: any number will do.
        value = store[name] if name in store else store.constants.get(name, 1.0)
        return at(value, near) if isinstance(value, tuple) else value[near] if np.ndim(value) else value

    shown = tuple(dict.fromkeys(("position", *fields)))
    own = view_of(("rest_density", "sound_speed"))(*map(at_near, ("rest_density", "sound_speed")))
    seen = image(reflection, own, view_of(shown)(*map(at_near, shown)))
    for field in fields:
        value = getattr(seen, field)
        yield from value if isinstance(value, tuple) else (value,)


WEIGHED = ("position", "mass", "specific_volume")
"""What the weight of a particle at a point is made of."""


class OfOneSize(NamedTuple):
    """The weight of particles that have one smoothing length, by their ``kernel``."""

    kernel: Any

    def weight(self, r, j):
        """W of a particle ``j`` that is ``r`` m away, 1/m^d."""
        return weight(self.kernel, r)


class OfOwnSizes(NamedTuple):
    """That of particles that have each its own, by a ``kernel`` with h = 1 m."""

    kernel: Any

    def weight(self, r, j):
        """W of a particle ``j`` that is ``r`` m away, 1/m^d."""
        inverse = 1.0 / j.length
        return weight(self.kernel, r * inverse) * inverse ** len(j.position)


weigh = call_by_type("weight")


def _weighing(plan, store: Store):
    """What weighs particles by a ``plan``, and these with no more than that reads: so scenes of other effects
    share the loop."""
    values = [*map(store.value, WEIGHED)]
    if plan.sizes is None:
        return OfOneSize(plan.kernel), view_of(WEIGHED)(*values)
    own = OfOwnSizes(unit_kernel(plan.kernel, store.dimensions))
    return own, view_of((*WEIGHED, "length"))(*values, store.value(plan.sizes.length))


class Nearby(NamedTuple):
    """The particles within the square of a radius, m², of a ``place`` (dim,), m, and their weights there;
    ``periods``, m, count from the corner ``lower``."""

    place: tuple[float, ...]
    radius2: float
    weighs: Any
    lower: tuple[float, ...]
    periods: tuple


@elementwise
def weigh_near(first, last, around, view, group, fluid, data, wet, rows, near, terms):
    """Fill ``near`` with the columns from ``first`` to ``last`` that are ``around`` a place, and the rows of
    ``terms`` with W V_j in the groups of ``fluid``, W V_j and W V_j f_j of each, f the ``rows`` of ``data``.

    Returns how many they are.  Where ``wet`` is the number of a row, walls count that show a pressure by it.
    """
    count = 0
    for k in range(np.uint64(first), np.uint64(last)):
        j = take(view, k)
        there = inside(j.position, around.lower, around.periods)
        x = nearest_image(subtract(around.place, there), around.periods)
        r2 = dot(x, x)
        if r2 < around.radius2 and (wet < 0 or data[wet, k] >= WET):
            share = weigh(around.weighs, math.sqrt(r2), j) * j.mass * j.specific_volume
            terms[count, 0] = share if fluid[group[k]] else 0.0
            terms[count, 1] = share
            for m in range(len(rows)):
                terms[count, m + 2] = share * data[rows[m], k]
            near[count] = k
            count += share > 0.0  # how finely a sum is rounded goes by the number of its terms
    return count
