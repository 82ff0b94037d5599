"""Probes: fields interpolated at fixed points, and how far the fluid reaches."""

import math
from collections.abc import Iterator

import numpy as np

from psph.composition.mirrors import image, images
from psph.composition.pair import take
from psph.engine.jit import elementwise
from psph.fields import FLUID, PRESSURE, SAVED, by_name, view_of
from psph.output.flowing import ALL, counted
from psph.parallel.domain import Domain
from psph.parallel.reductions import alone, exact_sums, largest
from psph.particles.store import Store
from psph.physics.walls.dry import DryWall
from psph.smoothing import weight
from psph.vectors import at, dot, nearest_image, subtract

MEASURED = by_name(SAVED)

ROUNDING = 1e-9
"""In spacings: a length that is a whole number of them but for rounding has that many points."""

FRONT = "front"
"""The quantity of a probe that follows the fluid."""


class FieldProbe:
    """Fields of the fluid at a point, f = Σ_j W V_j f_j / Σ_j W V_j (Shepard 1968), or their mean over some.

    The sums are over the fluid and the walls that it wets, so that at a wall the mean is not that of
    one side alone; beside ``mirrors`` (psph.composition.mirrors) over images too.  ``points`` (n, dim) m:
    of a sensor those of its area.  A point without fluid in reach bears no pressure: it counts as 0 Pa, and
    for nothing else.  ``fields`` names of saved fields; ``rows`` counts the values taken so far, ``dry``
    those without fluid in reach of any point.
    """

    def __init__(self, name: str, points: np.ndarray, fields: tuple[str, ...], mirrors=None):
        self.name, self.points, self.fields = name, np.atleast_2d(points), fields
        self.mirrors = mirrors
        self.rows = self.dry = 0

    def columns(self, dimensions: int) -> list[str]:
        """Names of the values: ``P1.pressure``, ``P1.velocity_x``."""
        return [
            f"{self.name}.{field}{suffix}"
            for field in self.fields
            for suffix in ([f"_{axis}" for axis in "xyz"[:dimensions]] if MEASURED[field].composed else [""])
        ]

    def sample(self, domain: Domain, kernel) -> np.ndarray:
        """Values in the order of :meth:`columns` on every rank; where no fluid is near, 0 for a pressure and
        NaN for all else.  Collective."""
        return self.values(domain.store, exact_sums(domain.comm, self.terms(domain, kernel)))

    def terms(self, domain: Domain, kernel) -> np.ndarray:
        """What this rank adds to the sums that :meth:`values` take: for each point W V_j in the fluid, W V_j,
        W V_j f_j, a row for each particle and image near.

        Every rank finds the near ones among its own particles, wherever these have drifted since
        the lists were made; the sums do not depend on how particles are spread.
        """
        rows = np.array([row for field in self.fields for row in domain.store.rows[field]], np.int64)
        seen = [
            self._seen(domain, kernel, point, m, rows)
            for point in self.points
            for m in range(images(self.mirrors))
        ]
        if len(seen) == 1:
            return seen[0]
        terms = np.zeros((sum(map(len, seen)), len(self.points) * (2 + len(rows))))
        last = 0
        for k, near in enumerate(seen):
            first, last = last, last + len(near)
            place = k // images(self.mirrors) * (2 + len(rows))
            terms[first:last, place : place + 2 + len(rows)] = near
        return terms

    def of_all(self, store: Store, terms: list[np.ndarray]) -> np.ndarray:
        """What :meth:`sample` returns, of the :meth:`terms` of each rank."""
        return self.values(store, exact_sums(alone(), np.concatenate(terms)))

    def values(self, store: Store, sums: np.ndarray) -> np.ndarray:
        """What :meth:`sample` returns, of the sums of the :meth:`terms` of all ranks."""
        sums = sums.reshape(len(self.points), -1)
        wet = sums[:, 0] > 0.0
        reached = int(np.count_nonzero(wet))
        self.rows += 1
        self.dry += not reached
        # What no fluid reaches bears no pressure.
        counted = [len(wet) if f == PRESSURE.name else reached for f in self.fields for _ in store.rows[f]]
        with np.errstate(invalid="ignore"):
            return (sums[wet, 2:] / sums[wet, 1:2]).sum(axis=0) / counted  # 0/0 where all is dry

    def _seen(self, domain: Domain, kernel, point, m: int, rows: np.ndarray) -> np.ndarray:
        """The :meth:`terms` of one point, of this rank's particles in reach or of their images m in
        mirrors."""
        store = domain.store
        # An image is as far from the point as the particle from the image of the point.
        point = self.mirrors.reflections[m].seen(point) if m else tuple(map(float, point))
        radius = kernel.support / kernel.inverse_h
        near = np.empty(store.owned, np.int64)
        first, last = store.low, store.low + store.owned
        count = find_near(point, domain.periods, store["position"], first, last, radius * radius, near)
        near = near[:count]
        if DryWall.marks in store:
            near = near[store[DryWall.marks][near] > 0.0]
        terms = np.empty((len(near), 2 + len(rows)))
        weigh(point, kernel, domain.periods, _weighed(store), near, store.data, rows, terms)
        if m:
            values = values_behind(self.mirrors.reflections[m], store, near, self.fields)
            terms[:, 2:] = terms[:, 1:2] * np.column_stack(list(values))
        np.multiply(terms[:, 1], (store.kinds == FLUID)[store.group[near]], out=terms[:, 0])
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
    m."""

    def __init__(self, name: str, axis: int, of: tuple[int, ...] = ALL):
        self.name, self.axis, self.of = name, axis, of

    def columns(self, dimensions: int) -> list[str]:
        """The name of the value: ``tip.front``."""
        return [f"{self.name}.{FRONT}"]

    def sample(self, domain: Domain, kernel) -> np.ndarray:
        """The value on every rank; collective."""
        return np.array(largest(domain.comm, self.terms(domain, kernel)))

    def terms(self, domain: Domain, kernel) -> np.ndarray:
        """How far those of this rank reach (1,)."""
        store = domain.store
        fluid = counted(store.kinds, self.of)[store.shown("group")]
        reach = store["position"][self.axis][store.inner].max(where=fluid, initial=-np.inf)
        return np.array([float(reach)])

    def of_all(self, store: Store, terms: list[np.ndarray]) -> np.ndarray:
        """What :meth:`sample` returns, of the :meth:`terms` of each rank."""
        return np.max(terms, axis=0)


def values_behind(reflection, store, near: np.ndarray, fields: tuple[str, ...]) -> Iterator[np.ndarray]:
    """Each component of some ``fields`` of the images of the columns ``near`` in a reflection."""

    def at_near(name: str):
        value = store[name] if name in store else store.constants[name]
        return at(value, near) if isinstance(value, tuple) else value[near] if np.ndim(value) else value

    shown = tuple(dict.fromkeys(("position", *fields)))
    own = view_of(("rest_density", "sound_speed"))(*map(at_near, ("rest_density", "sound_speed")))
    seen = image(reflection, own, view_of(shown)(*map(at_near, shown)))
    for field in fields:
        value = getattr(seen, field)
        yield from value if isinstance(value, tuple) else (value,)


WEIGHED = ("position", "mass", "specific_volume")
"""What the weight of a particle at a point is made of."""


def _weighed(store: Store):
    """The particles with no more than that: so scenes of other effects share the loop."""
    return view_of(WEIGHED)(*map(store.value, WEIGHED))


@elementwise
def find_near(point, periods, position, first, last, radius2, near):
    """Columns from ``first`` to ``last`` within the radius of ``point``; returns how many."""
    found = 0
    for k in range(np.uint64(first), np.uint64(last)):
        x = nearest_image(subtract(point, at(position, k)), periods)
        near[found] = k
        found += dot(x, x) < radius2
    return found


@elementwise
def weigh(point, kernel, periods, view, near, data, rows, terms):
    """Fill ``terms`` but the first: W V_j and W V_j f_j of each near column, f the ``rows`` of ``data``."""
    for n in range(len(near)):
        j = take(view, near[n])
        x = nearest_image(subtract(point, j.position), periods)
        share = weight(kernel, math.sqrt(dot(x, x))) * j.mass * j.specific_volume
        terms[n, 1] = share
        for m in range(len(rows)):
            terms[n, m + 2] = share * data[rows[m], near[n]]
