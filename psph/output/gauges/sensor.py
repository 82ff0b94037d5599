"""Pressure on the face of a wall, as a transducer there has it: the force across its area."""

import math
from itertools import product
from typing import NamedTuple

import numpy as np

from psph.composition.reflections import BELOW
from psph.output.gauges.carried import Carrier
from psph.output.gauges.points import disc
from psph.parallel.reductions import exact_sums
from psph.physics.rigid.pose import PLACE

FINE = 0.5
"""Spacings between the points of a sensor, each of which counts for the rows of sites beside it."""

LEAST = 0.05
"""Of the faces of sites before a sensor, the part on which the fluid presses along its axis, at the least:
less is the rounding of what presses a wall that it lies across from both sides."""


class SensorFace(NamedTuple):
    """The particles of walls of one spacing behind a sensor, by the sites where they start, and their shares
    in it.

    They are those of some ``groups``; ``shares`` is an array over a box of sites, the lowest of which is at
    ``lowest``, m (dim,), each ``spacing`` m from the next; ``inwards`` (dim,) the unit vector into the
    wall; ``area``, m^(dim−1), is what an even pressure of 1 Pa comes to.
    """

    groups: tuple[int, ...]
    shares: np.ndarray
    lowest: np.ndarray
    spacing: float
    inwards: np.ndarray
    area: float

    def columns(self, simulation) -> tuple[int, int]:
        """The first of a rank's own particles, and that after the last, between which all stand that started
        in the box, where they stay."""
        axis, low = simulation.domain.axis, simulation.store.low
        half = 0.5 * self.spacing * self.shares.shape[axis]
        middle = self.lowest[axis] + half - 0.5 * self.spacing
        first, last = simulation.neighbourhood.columns_across(middle, half + self.spacing)
        return first - low, last - low

    def shares_of(self, places: np.ndarray, periods) -> np.ndarray:
        """Of particles that started at ``places`` (n, dim), m; zeros beyond the box."""
        sites = np.empty(places.shape, np.int64)
        for d, (period, count) in enumerate(zip(periods, self.shares.shape)):
            x = places[:, d] - self.lowest[d]
            if period is not None:
                first = _window(count, self.spacing, period) - 0.5
                x = x - period * np.floor((x - first * self.spacing) / period)
            sites[:, d] = np.rint(x / self.spacing)
        within = ((sites >= 0) & (sites < self.shares.shape)).all(axis=1)
        shares = np.zeros(len(places))
        shares[within] = self.shares[tuple(sites[within].T)]
        return shares


class SensorGauge(NamedTuple):
    """Pressure on a round sensor in the face of a wall: the push of the fluid across it over its area, Pa.

    p = Σ_w s_w m_w a_w·n / Σ_w s_w A_w over the particles w of walls in the rows behind the sensor, a_w by
    their neighbours in the fluid alone (psph.composition.loads), n into the wall.  Of 1 Pa one bears A_w =
    2 dx^2d Σ −∂W/∂n over the sites before the wall that no wall holds, so an even pressure is read as it
    is, on edges and in corners too, and a film or a drop by the force that it has.  The shares s_w = c_w
    (1 − κz) fall with the depth z of a row, so that what presses the back of a thin wall counts for
    nothing: Σ_w s_w B_w = 0, with B_w as A_w of the sites behind it.  c_w is the part of the sensor at the
    row of w, shared linearly between the two rows beside each point.  Among levels of sizes p is the sum
    of those of the ``faces`` of all levels, each of which tells its share (psph.simulation.level_faces).
    """

    name: str
    every: float
    faces: tuple[SensorFace, ...]
    carrier: Carrier | None = None

    def columns(self, scene) -> list[str]:
        """Its name, without the time: ``P1.pressure``."""
        return [f"{self.name}.pressure"]

    def row(self, simulation) -> np.ndarray:
        """The value, the same on every rank."""
        return np.sum([self._of_face(simulation, face) for face in self.faces], axis=0)

    def _of_face(self, simulation, face: SensorFace) -> np.ndarray:
        """What presses on the walls of one spacing, Pa."""
        store, poses = simulation.store, simulation.engine.poses
        first, last = face.columns(simulation) if self.carrier is None else (0, store.owned)
        own = first + np.flatnonzero(store.of_groups(face.groups)[first:last])
        places, inwards = store.shown("position")[own], face.inwards
        periods = simulation.domain.periods
        if self.carrier is not None:
            row = simulation.plan.materials.pose_of[self.carrier.group]
            places = self.carrier.taken_back(simulation, places)
            inwards = poses.maps[row, PLACE][:, 1:] @ inwards
        shares = face.shares_of(places, periods)
        behind = np.flatnonzero(shares)
        push = store.shown("mass")[own[behind], None] * store.shown("load")[own[behind]]
        across = sum(push[:, d] * inwards[d] for d in range(store.dimensions))
        return exact_sums(simulation.comm, (shares[behind] * across)[:, None]) / face.area


def face_of(scene, beside, asked, axis: int) -> SensorFace | None:
    """The face, across an ``axis``, of the walls ``beside`` (psph.scene.outside.WallRegion) in which a sensor
    is ``asked`` for, of the level of sizes of the ``scene``; None where no particles behind it bear a
    pressure."""
    layout, dx = scene.layout, scene.spacing
    points = (disc(asked.position, axis, asked.diameter, FINE * dx) - layout.lattice.origin) / dx - 0.5
    reach = math.ceil(scene.support / dx)
    sites = _sites(scene, beside, np.floor(points.min(axis=0)), np.ceil(points.max(axis=0)), reach)
    # Arrays from here on have the axis last, and go into the wall along it.
    turned = np.moveaxis(np.array([sites.walls, sites.bearing]), 1 + axis, -1)
    middle = turned.shape[-1] // 2
    across = _shares_of_rows(
        np.delete(points, axis, axis=1) - np.delete(sites.first, axis), turned.shape[1:-1]
    )
    ahead, behind = ((across * turned[1][..., place]).sum() for place in (middle, middle - 1))
    inwards = 1 if ahead >= behind else -1
    walls, bearing = turned[..., ::inwards]
    shares, area = _shares(walls, bearing, across, _slopes(scene.kernel, dx, reach, scene.dimensions))
    if not area > LEAST:
        return None
    shares = _seen_once(layout, dx, sites.first, np.moveaxis(shares[..., ::inwards], -1, axis))
    lowest = (sites.first + 0.5) * dx + layout.lattice.origin
    into, level = inwards * np.eye(scene.dimensions)[axis], getattr(scene, "level", 0)
    groups = tuple(
        part.number
        for part, one in zip(layout.parts, scene.species)
        if part.origin in beside.groups and one.level == level
    )
    return SensorFace(groups, shares, lowest, dx, into, area * dx ** (scene.dimensions - 1))


class _Sites(NamedTuple):
    """A box of sites from ``first`` (dim,) on: where ``walls`` are, and which particles are ``bearing``."""

    first: np.ndarray
    walls: np.ndarray
    bearing: np.ndarray


def _sites(scene, beside, low: np.ndarray, high: np.ndarray, reach: int) -> _Sites:
    """Those around the sites from ``low`` to ``high``, twice a kernel's ``reach`` around."""
    layout, dx = scene.layout, scene.spacing
    first = low.astype(int) - 2 * reach
    counts = high.astype(int) + 2 * reach + 1 - first
    grid = np.meshgrid(
        *((first[d] + np.arange(n) + 0.5) * dx + layout.lattice.origin[d] for d, n in enumerate(counts)),
        indexing="ij",
    )
    grid = [layout.folded(d, x) for d, x in enumerate(grid)]
    for plane in layout.mirror_planes:
        nearest = np.maximum if plane.side == BELOW else np.minimum
        grid[plane.axis] = nearest(grid[plane.axis], 2.0 * plane.at - grid[plane.axis])
    held = layout.held(grid, tuple(counts))
    places = np.stack([x.ravel() for x in grid], axis=1)
    walls = layout.stands(held) | beside.deep(places, 0.0).reshape(held.shape)
    told = [n for n in beside.groups if scene.species[n].bearing and scene.species[n].loaded]
    return _Sites(first, walls, np.isin(held, told))


def _window(count: int, spacing: float, period: float) -> int:
    """The first site of the period about the middle of ``count`` sites."""
    return (count - round(period / spacing)) // 2


def _seen_once(layout, dx: float, first: np.ndarray, shares: np.ndarray) -> np.ndarray:
    """The shares of the sites from ``first`` on, ``dx`` m apart, those of images added to what a period or a
    mirror shows."""
    for d, period in enumerate(layout.periods):
        if period is not None:
            along, own = np.moveaxis(shares, d, 0), _window(shares.shape[d], dx, period)
            sites = round(period / dx)
            for k in (*range(own), *range(own + sites, len(along))):
                along[own + (k - own) % sites] += along[k]
                along[k] = 0.0
    for plane in layout.mirror_planes:
        d = plane.axis
        along = np.moveaxis(shares, d, 0)
        behind = round((plane.at - layout.lattice.origin[d]) / dx) - first[d]
        images = range(min(behind, len(along))) if plane.side == BELOW else range(max(behind, 0), len(along))
        for k in images:
            if 0 <= (own := 2 * behind - 1 - k) < len(along):
                along[own] += along[k]
            along[k] = 0.0
    return shares


def _shares_of_rows(points: np.ndarray, counts: tuple[int, ...]) -> np.ndarray:
    """The part of ``points`` (n, dim − 1), in spacings from the first row, at each of so many rows."""
    across = np.zeros(counts)
    for point in points:
        low = np.floor(point).astype(int)
        for corner in product((0, 1), repeat=len(point)):
            across[tuple(low + corner)] += math.prod(1.0 - abs(low + corner - point)) / len(points)
    return across


def _slopes(kernel, dx: float, reach: int, dimensions: int) -> np.ndarray:
    """2 dx^(d+1) (−∂W/∂z) of neighbours at the sites of a cube around a particle, z the last axis."""
    offsets = range(-reach, reach + 1)
    slopes = np.zeros((len(offsets),) * dimensions)
    for site in product(offsets, repeat=dimensions):
        r = math.hypot(*site)
        if r > 0.0:
            place = tuple(k + reach for k in site)
            slopes[place] = -2.0 * kernel.dw(r * dx) * site[-1] / r * dx ** (dimensions + 1)
    return slopes


def _shares(walls, bearing, across, slopes) -> tuple[np.ndarray, float]:
    """The shares of all sites of a box, and what they come to of an even pressure, in faces of sites.

    Of each row with a part of the sensor ``across`` (rows), the particles that are ``bearing`` from the
    middle of the box on, without a gap, as far as ``slopes`` reach.
    """
    reach, middle = len(slopes) // 2, walls.shape[-1] // 2
    shares, depth = np.zeros(walls.shape), np.zeros(walls.shape)
    front, back = np.zeros(walls.shape), np.zeros(walls.shape)
    for row in np.ndindex(across.shape):
        if not across[row] or not bearing[row][middle : middle + 2].any():
            continue
        begin = middle + int(np.argmax(bearing[row][middle:]))
        end = begin + int(np.argmin(np.append(bearing[row][begin:], False)))
        for along in range(begin, min(end, begin + reach)):
            place = (*row, along)
            around = tuple(slice(k - reach, k + reach + 1) for k in place)
            open_sites = np.where(walls[around], 0.0, slopes)
            last = end - along + reach
            shares[place], depth[place] = across[row], along - begin
            front[place] = -open_sites[..., :last].sum()
            back[place] = open_sites[..., last:].sum()
    behind = (shares * depth * back).sum()
    shares *= 1.0 - depth * ((shares * back).sum() / behind if behind > 0.0 else 0.0)
    return shares, float((shares * front).sum())
