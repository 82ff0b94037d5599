"""Fluids under their own weight at the start, column by column."""

import functools
import math
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from psph.composition.reflections import ABOVE, BELOW
from psph.physics.rigid.pose import in_space, inertia
from psph.rows import projected
from psph.scene.census import Census
from psph.scene.columns import columns, connected, order_of
from psph.scene.layout import NONE, Layout
from psph.scene.walls import with_surroundings


class Still(NamedTuple):
    """A fluid under its own weight and that of others: p = above + weight (surface − height), m and Pa.

    ``above`` Pa at the ``surface`` m, and ``weight`` Pa/m: numbers, or one at each site of the lattice, whose
    ``first`` site and ``spacing`` are in m, in the order of the axes ``order``; off the fluid's own sites
    those of its nearest one.  Heights are along ``up``, the unit vector against gravity; over the surface
    p = 0.  ``highest`` Pa is that of the fluid's sites.
    """

    up: tuple[float, ...]
    surface: Any
    above: Any
    weight: Any
    highest: float
    first: np.ndarray | None = None
    spacing: float = 0.0
    order: tuple[int, ...] = ()

    @property
    def level(self) -> bool:
        """Whether it has one surface."""
        return np.ndim(self.surface) == 0

    def pressure(self, position: np.ndarray) -> np.ndarray:
        """p at ``position`` (n, dim), Pa (n,)."""
        surface, above, weight = self.surface, self.above, self.weight
        if not self.level:
            order = list(self.order)
            sites = np.rint((position[:, order] - self.first[order]) / self.spacing).astype(int)
            sites = tuple(np.clip(sites, 0, np.array(surface.shape) - 1).T)
            surface, above, weight = surface[sites], above[sites], weight[sites]
        depth = surface - projected(position, self.up)
        return np.where(depth > 0.0, above + weight * depth, 0.0)


def felt_gravity(layout: Layout) -> tuple[float, ...]:
    """What a fluid feels as gravity at the start along axes that do not repeat, m/s².

    In a frame of reference that is accelerated without a turn g less its acceleration.
    """
    if layout.frame is None:
        return layout.height_gravity
    added = inertia(layout.frame.pose(0.0), in_space(layout.gravity), layout.dimensions)
    if added[:, :, 1:].any():
        return layout.height_gravity
    both = zip(layout.gravity, added[0, :, 0].tolist(), layout.periods)
    return tuple(g + a if period is None else 0.0 for g, a, period in both)


def stills_of(census: Census, resting: list[int]) -> dict[int, Still]:
    """How the ``resting`` fluids start, under their own weight, by their numbers.

    Along gravity, a column of fluid bears what stands over it up to the air: its own weight, that of the
    fluids on it, and the pressure of one whose pressure is given. What hangs within a connected fluid, with
    that above and below, has the pressure of this fluid around it, be it a drop, a bubble or a solid: it
    will rise or sink, and does not rest on what is below. Under a roof, of a wall or of what floats, the
    surface is that of the nearest open column of the same connected fluid; where all of it is closed in, it
    has the pressure of another fluid that it meets, or none at its highest point. A fluid that nothing
    solid bears from below falls, and has no pressure. Where gravity is oblique to the axes each connected
    part of a fluid has one surface, its highest point, and bears those that are above all of it.
    """
    gravity = felt_gravity(census.layout)
    axes = [d for d, g in enumerate(gravity) if g]
    if not resting or not axes:
        return {n: _one_level(census, n, gravity) for n in resting}
    if len(axes) > 1:
        return _Slanted(census, gravity, resting).stills()
    if _is_level(census, axes[0], gravity[axes[0]]):
        return {0: _one_level(census, 0, gravity)}
    return _Columns(census, axes[0], gravity[axes[0]], resting).stills()


def _against(gravity) -> tuple[float, ...]:
    """The unit vector against ``gravity``, m/s²; zeros without."""
    pull = math.hypot(*gravity)
    return tuple(-g / pull if pull else 0.0 for g in gravity)


def _one_level(census: Census, number: int, gravity) -> Still:
    """A fluid whose surface is at its highest point, with nothing on it."""
    weight = census.layout.parts[number].table.density * math.hypot(*gravity)
    surface = census.surface_of(number)
    highest = weight * max(surface - float(census.bottom[number]), 0.0)
    return Still(_against(gravity), surface, 0.0, weight, highest)


def _is_level(census: Census, axis: int, pull: float) -> bool:
    """Whether the only fluid has one surface that is open everywhere, and rests on something: most scenes are
    so, and need no columns.  Looks at some planes at a time."""
    layout = census.layout
    if len(layout.case.fluids) > 1 or layout.up[axis] != -math.copysign(1.0, pull):
        return False
    borne = _mirrored(layout, axis, pull)[1]
    top = float(census.top[0])
    for first, last in layout.lattice.chunks():
        held = with_surroundings(layout, first, last, 1)
        inner = [slice(1, -1)] * held.ndim
        low, high = ([*inner], [*inner])
        place = layout.lattice.axes.index(axis)
        low[place], high[place] = slice(None, -2), slice(2, None)
        over, under = (held[tuple(one)] for one in ((high, low) if pull < 0.0 else (low, high)))
        fluid = held[tuple(inner)] == 0
        height = np.broadcast_to(layout.up[axis] * layout.lattice.grid(first, last)[axis], fluid.shape)
        roofed = (fluid & (over > 0) & (over < NONE)).any()
        if roofed or (height[fluid & (over == NONE)] != top).any():
            return False
        borne |= bool((fluid & (under > 0) & (under < NONE)).any())
    return borne


def _mirrored(layout: Layout, axis: int, pull: float) -> tuple[bool, bool]:
    """Whether a mirror is above, and whether one is below."""
    sides = (ABOVE, BELOW) if pull < 0.0 else (BELOW, ABOVE)
    found = [any(p.axis == axis and p.side == side for p in layout.mirror_planes) for side in sides]
    return found[0], found[1]


class _Columns:
    """The columns of a scene along ``axis``, the sites of each from above, and what the ``resting`` fluids in
    them bear under ``pull``, m/s² along that axis."""

    def __init__(self, census: Census, axis: int, pull: float, resting: list[int]):
        layout = census.layout
        self.layout, self.resting, self.spacing = layout, resting, layout.spacing
        self.order = tuple(order_of(layout.dimensions, axis))
        self.up = tuple(-math.copysign(1.0, pull) if d == axis else 0.0 for d in range(layout.dimensions))
        self.downwards = slice(None, None, -1 if pull < 0.0 else 1)
        self.held = columns(layout, axis)[..., self.downwards]
        self.heights = (self.up[axis] * layout.lattice.coordinates(axis))[self.downwards]
        liquids = range(len(layout.case.fluids))
        masks = [self.held == n for n in liquids]
        self.air, self.wet = self.held == NONE, np.logical_or.reduce(masks)
        self.around = [place for place, d in enumerate(self.order) if layout.periods[d] is not None]
        self.part = connected([masks[n] for n in resting], self.around)
        self.count = int(self.part.max())
        self.weights = np.zeros(self.count + 1)
        for n in resting:
            self.weights[np.unique(self.part[masks[n]])] = layout.parts[n].table.density * abs(pull)
        self.given = {n: layout.parts[n].table.pressure for n in liquids if n not in resting}
        self.roofed, self.floored = _mirrored(census.layout, axis, pull)

    def stills(self) -> dict[int, Still]:
        """What each resting fluid bears."""
        around = self._around()
        surface, above = self._bearing(around)
        weight = self.weights[around]
        weight[self._falling], above[self._falling] = 0.0, 0.0
        return {n: self._still(n, surface, above, weight) for n in self.resting}

    def _around(self) -> np.ndarray:
        """The connected part of a fluid at each site: its own, or that around it in its column."""
        from scipy.ndimage import find_objects  # late: most scenes have one part

        around = self.part.copy()
        sizes = np.bincount(self.part.ravel(), minlength=self.count + 1)
        places = find_objects(self.part)
        for number in np.argsort(sizes[1:], kind="stable") + 1:  # the largest last: others are within it
            if (place := places[number - 1]) is None:
                continue
            own, gaps = self.part[place] == number, self.air[place].cumsum(axis=-1)
            over = np.maximum.accumulate(np.where(own, gaps, -1), axis=-1)
            under = np.where(own, gaps, np.iinfo(gaps.dtype).max)[..., ::-1]
            under = np.minimum.accumulate(under, axis=-1)[..., ::-1]
            around[place][(over == gaps) & (under == gaps) & ~self.air[place]] = number
        return around

    def _bearing(self, around: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The surface, m, and the pressure there, Pa, from which the weight counts at each site."""
        surface, above = np.zeros(around.shape), np.zeros(around.shape)
        known = np.zeros(around.shape, bool)
        inside = around > 0
        while not known[inside].all():
            before = np.count_nonzero(known)
            self._walk_down(around, surface, above, known)
            self._spread(around, surface, above, known)
            if np.count_nonzero(known) == before and not self._meet(around, surface, above, known):
                self._close(around, surface, above, known)
        self._walk_down(around, surface, above, known)
        return surface, np.where(inside, above, 0.0)

    def _walk_down(self, around, surface, above, known) -> None:
        """Take surface and pressure from site to site downwards, from where they are known."""
        start = around.shape[:-1]
        level, load, told = np.zeros(start), np.zeros(start), np.zeros(start, bool)
        open_air, before = np.full(start, not self.roofed), np.zeros(start, around.dtype)
        given = np.full(start, np.nan)
        for k, height in enumerate(self.heights):
            here = around[..., k]
            begins, top = (here > 0) & (here != before), height + 0.5 * self.spacing
            roofed = begins & ~open_air & (before == 0) & np.isnan(given) | begins & (before > 0) & ~told
            on_it = np.where(before > 0, load + self.weights[before] * (level - top), 0.0)
            on_it = np.where(np.isnan(given), on_it, given)
            load = np.where(begins, np.where(roofed, above[..., k], on_it), load)
            level = np.where(begins, np.where(roofed, surface[..., k], top), level)
            told = np.where(begins, np.where(roofed, known[..., k], (before == 0) | told), told)
            surface[..., k], above[..., k], known[..., k] = level, load, told & (here > 0)
            open_air, before, given = self.air[..., k], here, self._given_at(k, here)

    def _given_at(self, k: int, here: np.ndarray) -> np.ndarray:
        """The pressure of fluids at height ``k`` where the case gives it, Pa; NaN elsewhere."""
        found = np.full(here.shape, np.nan)
        for n, pressure in self.given.items():
            told = pressure if isinstance(pressure, float) else 0.0
            found[(self.held[..., k] == n) & (here == 0)] = told
        return found

    def _spread(self, around, surface, above, known) -> None:
        """Under a roof: as in the nearest column of the same part that is known."""
        from scipy.ndimage import distance_transform_edt, find_objects  # late, as above

        places = find_objects(around)
        for number in np.unique(around[(around > 0) & ~known]).tolist():
            place = places[number - 1]
            own = around[place] == number
            told = own & known[place]
            if told.any():
                nearest = tuple(distance_transform_edt(~told, return_distances=False, return_indices=True))
                for array in (surface, above):
                    array[place][own] = array[place][nearest][own]
                known[place] |= own

    def _meet(self, around, surface, above, known) -> bool:
        """What is closed in beside another fluid that is known has its pressure where they meet, below it or
        else at its side; False where nothing is so."""
        for place in reversed(range(around.ndim)):
            low, high = ([slice(None)] * around.ndim for _ in range(2))
            low[place], high[place] = slice(None, -1), slice(1, None)
            for here, there in ((tuple(low), tuple(high)), (tuple(high), tuple(low))):
                meets = (around[here] > 0) & ~known[here] & known[there]
                if meets.any():
                    site = np.unravel_index(meets.argmax(), meets.shape)
                    own = around == around[here][site]
                    beside = around[there][site]
                    face = 0.5 * (self.heights[here[-1]][site[-1]] + self.heights[there[-1]][site[-1]])
                    top = self.heights[own.any(axis=tuple(range(own.ndim - 1))).argmax()] + 0.5 * self.spacing
                    met = above[there][site] + self.weights[beside] * (surface[there][site] - face)
                    weight = self.weights[around[here][site]]
                    surface[own], above[own], known[own] = top, met - weight * (top - face), True
                    return True
        return False

    def _close(self, around, surface, above, known) -> None:
        """What is closed in all around has no pressure at its highest point: of the parts that are not known
        that one whose highest point is highest."""
        closed = (around > 0) & ~known
        k = int(closed.any(axis=tuple(range(closed.ndim - 1))).argmax())
        number = int(around[..., k][closed[..., k]].min())
        own = around == number
        surface[own], above[own], known[own] = self.heights[k] + 0.5 * self.spacing, 0.0, True

    @cached_property
    def _falling(self) -> np.ndarray:
        """Where a fluid falls, since nothing solid is below it and what is connected with it."""
        blob = connected([self.wet], self.around)
        solid = ~self.wet & ~self.air
        borne = np.zeros(int(blob.max()) + 1, bool)
        borne[blob[..., :-1][self.wet[..., :-1] & solid[..., 1:]]] = True
        if self.floored:
            borne[blob[..., -1]] = True
        return self.wet & ~borne[blob]

    def _still(self, number: int, surface, above, weight) -> Still:
        """What one fluid bears."""
        own = self.held == number
        numbers = [array[own] for array in (surface, above, weight)]
        depth = numbers[0] - np.broadcast_to(self.heights, own.shape)[own]
        highest = float((numbers[1] + numbers[2] * depth).max())
        if all((one == one[0]).all() for one in numbers):
            found = [one[0].item() for one in numbers]
        else:
            from scipy.ndimage import distance_transform_edt  # late, as above

            nearest = tuple(distance_transform_edt(~own, return_distances=False, return_indices=True))
            found = [array[nearest][..., self.downwards] for array in (surface, above, weight)]
        lattice = self.layout.lattice
        first = np.array([lattice.coordinates(d)[0] for d in range(self.layout.dimensions)])
        return Still(self.up, *found, highest, first, self.spacing, self.order)


class _Slanted(_Columns):
    """The same where gravity, m/s², is oblique to the axes: columns are along the axis nearest to it.

    They tell what is within what, and what falls; steps of the lattice along a slope are no surface.
    """

    def __init__(self, census: Census, gravity: tuple[float, ...], resting: list[int]):
        layout = census.layout
        axis = max(range(layout.dimensions), key=lambda d: abs(gravity[d]))
        super().__init__(census, axis, gravity[axis], resting)
        pull = math.hypot(*gravity)
        self.level = [place for place, d in enumerate(self.order) if abs(gravity[d]) < 0.5 * pull]
        self.weights *= pull / abs(gravity[axis])
        self.up = _against(gravity)
        grid = np.ix_(*(self.up[d] * layout.lattice.coordinates(d) for d in self.order))
        self.heights = functools.reduce(np.add, grid)[..., self.downwards]

    def _bearing(self, around: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The highest point of the part at each site, m, and the weight of those above it, Pa."""
        from scipy.ndimage import extrema, find_objects  # late, as above

        numbers = np.arange(1, self.count + 1)
        low, high = (np.append(0.0, one) for one in extrema(self.heights, self.part, numbers)[:2])
        falls = np.append(True, [self._falling[self.part == n].any() for n in numbers])
        places = [None, *find_objects(self.part)]
        load = np.zeros(self.count + 1)
        for one in numbers[~falls[1:]]:
            for other in numbers[~falls[1:]]:
                # layers that are drawn along a slope are half a spacing into each other: steps fit into steps
                higher = other != one and low[other] > high[one] - 0.5 * self.spacing
                if higher and all(_overlap(places[one][k], places[other][k]) for k in self.level):
                    load[one] += self.weights[other] * (high[other] - low[other])
        return (high + 0.5 * self.spacing)[around], load[around]


def _overlap(one: slice, other: slice) -> bool:
    """Whether two ranges of sites have one in common."""
    return one.start < other.stop and other.start < one.stop
