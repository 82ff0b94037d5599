"""What a part of the walls bears where parts meet: on edges and in corners."""

from collections.abc import Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np

from psph.fields import WALL
from psph.output.gauges.seams import BareFaces, Particles, Seams, seams_of
from psph.physics.motion import FIXED, RIGID
from psph.physics.rigid.pose import PLACE

OPEN = 0.8
"""Spacings from a site beside a particle within which another particle of a wall closes it."""

MOST = 64
"""BareFaces, the nearest ones, among which that of a particle is looked for."""

TOUCH = 1.5
"""Spacings within which particles of two parts touch: what is farther apart shares no edge."""

TIE = 1e-6
"""Spacings by which the face of another part must be nearer than that of the particle's own."""


class Shares(NamedTuple):
    """Which parts bear the load of particles, by their ``ids`` (n,), in order; ``groups`` (n,) are theirs.

    ``bearers`` (n, dim, 2) are the groups that bear it along each axis of the particle's own group, where it
    is positive and where it is negative.  What passes along ``seams`` comes besides.
    """

    ids: np.ndarray
    groups: np.ndarray
    bearers: np.ndarray
    seams: Seams


class Sharers(NamedTuple):
    """This rank's particles with a share: ``rows`` (n,) of its store, the ``place`` (n,) of each among
    ``shares``, and the rows ``beside`` (k,) seams, in the order of their ids."""

    shares: Shares
    rows: np.ndarray
    place: np.ndarray
    beside: np.ndarray


class Corners:
    """The ``gauged`` parts of rigid walls and bodies that meet others, and who bears what there.

    A face bears, across it, what the fluid before it does to all that lies beyond its plane.  A part that
    summed over its own particles alone would miss what lies beyond its end: on a gate that stands on a floor,
    the last half row of the pressure, which the particles of the floor behind the edge have.  So each
    component of the load of a particle goes to its own part, or one that touches it, with the nearest face
    across it that the particle lies beyond, within the ``support`` of the kernel, m.  Sums over all parts
    stay what they are.  Two parts in one plane exchange along it what they bear wrongly there
    (:class:`Seams`), ``crossing`` of what presses them (:func:`psph.moments.seam_shares`).
    BareFaces are those of the particles, a ``spacing`` in m apart, that have no neighbour at the next site.
    """

    def __init__(self, gauged: Sequence[int], spacing: float, support: float, crossing: Sequence[float]):
        self.gauged, self.spacing, self.support = tuple(sorted(set(gauged))), spacing, support
        self.crossing = np.array(crossing)
        self._placed: np.ndarray | None = None
        self._shares: Shares | None = None
        self._sharers: tuple[int, Sharers] | None = None

    def sharers(self, simulation) -> Sharers:
        """Where those of :meth:`shares` are on this rank, looked up again with new lists; collective."""
        shares, store, rebuilds = self.shares(simulation), simulation.store, simulation.domain.rebuilds
        if self._sharers is None or self._sharers[0] != rebuilds or self._sharers[1].shares is not shares:
            ids = store.shown("id")
            rows = np.flatnonzero(store.of_groups(shares.groups))
            place = np.searchsorted(shares.ids, ids[rows]) % max(len(shares.ids), 1)
            known = shares.ids[place] == ids[rows]
            beside = np.flatnonzero(np.isin(ids, shares.seams.ids))
            beside = beside[np.argsort(ids[beside])]
            self._sharers = rebuilds, Sharers(shares, rows[known], place[known], beside)
        return self._sharers[1]

    def shares(self, simulation) -> Shares:
        """Of the particles where parts meet now, the same on every rank; collective."""
        maps = simulation.engine.poses.maps
        placed = np.zeros(0) if maps is None else maps[:, PLACE]
        if self._shares is None or not np.array_equal(placed, self._placed):
            self._placed, self._shares = placed.copy(), self._found(simulation)
        return self._shares

    def _found(self, simulation) -> Shares:
        plan, domain = simulation.plan, simulation.domain
        space = _Torus(domain.periods)
        kinds = np.array(plan.materials.kinds)
        parts = (kinds == WALL) & plan.materials.bearing & np.isin(plan.materials.motion_of, (FIXED, RIGID))
        ids, groups, places, meeting = self._near_others(simulation, space, parts)
        frames = axes_of(simulation)
        faces = [
            self._faces(space, places, groups, way * frames[:, :, axis])
            for axis in range(places.shape[1])
            for way in (-1.0, 1.0)
        ]
        own, touch = groups[meeting], self._touch(space, places, groups, len(kinds))
        bearers = np.stack([self._bearer(space, places[meeting], own, touch, one) for one in faces], axis=1)
        shared = (bearers != own[:, None]).any(axis=1)
        bearers = bearers[shared].reshape(-1, places.shape[1], 2)
        every = BareFaces(*(np.concatenate(part) for part in zip(*faces)))
        told = space, self.spacing, self.crossing, Particles(ids, places), every, frames, touch
        return Shares(ids[meeting][shared], own[shared], bearers, seams_of(*told))

    def _near_others(self, simulation, space: "_Torus", parts: np.ndarray):
        """Ids in order, groups and places of what is near where parts meet, and whether it is there."""
        comm, store = simulation.comm, simulation.store
        every = simulation.domain.groups()
        here = np.flatnonzero(parts[every])
        groups = every[here]
        places = np.column_stack([x[here] for x in store["position"]])
        places = space.wrapped(places - simulation.domain.lower)
        owned = (here >= store.low) & (here < store.low + store.owned)
        meets = np.zeros(len(here), bool)
        for group in self.gauged:
            one = groups == group
            for some, others in ((one, ~one), (~one, one)):
                meets[some] |= space.near(places[some], places[others], self.support)
        meets &= owned
        meeting = np.concatenate(comm.allgather(places[meets]))
        around = owned & space.near(places, meeting, self.support + 2.0 * self.spacing)
        told = (store.id[here][around], groups[around], places[around], meets[around])
        ids, groups, places, meets = (np.concatenate(part) for part in zip(*comm.allgather(told)))
        order = np.argsort(ids)
        return ids[order], groups[order], places[order], meets[order]

    def _touch(self, space: "_Torus", places: np.ndarray, groups: np.ndarray, count: int) -> np.ndarray:
        """Whether two of the ``count`` groups touch (count, count); each touches itself."""
        touch = np.eye(count, dtype=bool)
        for one, other in combinations(np.unique(groups), 2):
            pair = places[groups == one], places[groups == other]
            touch[one, other] = touch[other, one] = space.near(*pair, TOUCH * self.spacing).any()
        return touch

    def _faces(self, space: "_Torus", places, groups, outward: np.ndarray) -> BareFaces:
        """The faces that look in the direction ``outward`` (groups, dim) of their group."""
        normal = outward[groups]
        beside = space.wrapped(places + self.spacing * normal)
        bare = ~space.near(beside, places, OPEN * self.spacing)
        middle = space.wrapped(places + 0.5 * self.spacing * normal)
        return BareFaces(middle[bare], normal[bare], groups[bare])

    def _bearer(self, space: "_Torus", places, own, touch, faces: BareFaces) -> np.ndarray:
        """The group whose face bears what presses particles at ``places`` (n, dim) inwards from there."""
        middle, normal, groups = faces
        if not len(middle) or not len(places):
            return own
        distance, face = space.nearest(places, middle, MOST, self.support)
        near = np.isfinite(distance)
        face = np.where(near, face, 0)
        depth = -(space.apart(places[:, None], middle[face]) * normal[face]).sum(axis=2)
        beyond = near & (depth > 0.0) & (depth < self.support - 0.5 * self.spacing)
        beyond &= touch[own[:, None], groups[face]]
        distance = distance + np.where(groups[face] == own[:, None], 0.0, TIE * self.spacing)
        best = np.where(beyond, distance, np.inf).argmin(axis=1)
        rows = np.arange(len(places))
        return np.where(beyond.any(axis=1), groups[face[rows, best]], own)


def axes_of(simulation) -> np.ndarray:
    """The axes of the lattice of each group as it has turned, in the columns (groups, dim, dim)."""
    plan = simulation.plan
    axes = np.repeat(np.eye(simulation.store.dimensions)[None], len(plan.materials.kinds), axis=0)
    for group in np.flatnonzero(plan.materials.motion_of == RIGID):
        axes[group] = simulation.engine.poses.maps[plan.materials.pose_of[group], PLACE][:, 1:]
    return axes


class _Torus:
    """Places from the lower corner of a domain, m, along axes that repeat after ``periods``, or None."""

    def __init__(self, periods):
        self.periods = [0.0 if one is None else one for one in periods]

    def wrapped(self, places: np.ndarray) -> np.ndarray:
        """The images of ``places`` (n, dim) within a period."""
        places = places.copy()
        for axis, period in enumerate(self.periods):
            if period:
                places[:, axis] %= period
                places[places[:, axis] >= period, axis] = 0.0  # rounding
        return places

    def apart(self, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """a − b between nearest images."""
        difference = a - b
        for axis, period in enumerate(self.periods):
            if period:
                difference[..., axis] -= period * np.rint(difference[..., axis] / period)
        return difference

    def near(self, some: np.ndarray, others: np.ndarray, distance: float) -> np.ndarray:
        """Whether any of the ``others`` is so near each of ``some`` (n,)."""
        if not len(some) or not len(others):
            return np.zeros(len(some), bool)
        return np.isfinite(self.nearest(some, others, 1, distance)[0][:, 0])

    def nearest(self, some: np.ndarray, others: np.ndarray, most: int, distance: float):
        """Distances and rows of the nearest ``others`` (n, most), infinite where there are no more."""
        from scipy.spatial import cKDTree  # late: most runs have no such gauge

        tree = cKDTree(others, boxsize=self.periods if any(self.periods) else None)
        return tree.query(some, k=np.arange(1, most + 1), distance_upper_bound=distance)
