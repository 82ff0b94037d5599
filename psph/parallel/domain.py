"""A rank's part of the domain: rebuild it (wrap, balance, migrate, sort, halo, list), refresh it."""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from mpi4py import MPI

from psph.composition.space import Metres
from psph.engine.settled import settled
from psph.fields import CROSSED
from psph.parallel.halo import Halo
from psph.parallel.migration import migrate
from psph.parallel.reductions import largest
from psph.parallel.slabs import Prices, rebalanced
from psph.particles import neighbours
from psph.particles.cells import Grid, make_grid, number_cells, planes_of, sort_by_cell
from psph.particles.level_grids import Slab
from psph.particles.levels import list_by_levels
from psph.particles.sizes import Sizes
from psph.particles.store import Store

GROWTH = 3.0
"""The grid follows particles that leave the domain up to this many of its lengths outside."""

STEPS_A_LENGTH = 8
"""It does so in steps of this part of the domain's length: a new grid at each rebuild would order
neighbours differently each time."""

CELLS_A_PARTICLE = 2.0
"""It follows them no farther than where it has so many cells per particle, or as many as the domain."""


class Extent(NamedTuple):
    """The corners of a domain, m, with a period in m or None for each axis; slabs cut it across ``axis``."""

    axis: int
    lower: tuple[float, ...]
    upper: tuple[float, ...]
    periods: tuple[float | None, ...]


class Travels(NamedTuple):
    """Names of the fields that ghosts need once at a rebuild, and of those that they need in each step.

    ``sought``, one of the first, is above 0 in particles that every other looks for: whoever has none in the
    cells around has no neighbours listed.  None: everyone lists everyone.  ``sizes`` is there where particles
    differ in size.
    """

    at_rebuild: tuple[str, ...]
    refreshed: tuple[str, ...]
    sought: str | None = None
    sizes: Sizes | None = None


class Domain:
    """The slab of one rank, its ghosts and its neighbour lists.

    ``cutoff`` is the kernel's support and the widest skin together, m, and follows the largest particle where
    sizes differ; lists name who is within ``reach``, m, which may be less, and where levels of sizes do not
    see each other rows of ``others`` those of other levels.  ``travels`` says what ghosts need; ``lanes`` is
    how many entries of a list the pair loop takes at once, None where there is no such loop and nothing to
    list.
    """

    def __init__(
        self,
        comm: MPI.Comm,
        store: Store,
        extent: Extent,
        cutoff: float,
        travels: Travels,
        lanes: int | None = Metres.lanes,
    ):
        self.comm, self.store, self.cutoff = comm, store, cutoff
        self.reach = cutoff
        self.axis, self.periods = extent.axis, tuple(extent.periods)
        self.lower, self.upper = tuple(extent.lower), tuple(extent.upper)
        self._home = (self.lower, self.upper)
        self.ghost_fields, self.refreshed, self.sought, self.sizes = travels
        self.lanes = lanes
        self.bounds: np.ndarray | None = None
        self.prices = Prices(comm.size)
        self.grid: Grid | None = None
        self.halo: Halo | None = None
        self.starts = np.zeros(1, np.int64)
        self.lists = self.others = neighbours.empty(0, 0)
        self._fill = settled(neighbours.fill_lists)
        self.rebuilds = 0

    @property
    def planes(self) -> int:
        """Planes of cells that this rank owns."""
        return int(self.bounds[self.comm.rank + 1] - self.bounds[self.comm.rank])

    def groups(self) -> np.ndarray:
        """Those of this rank's particles and of its ghosts (total,), which no message of a step carries;
        collective."""
        found = self.store.group[: self.store.total].copy()
        if self.halo is not None:
            self.halo.carry(found)
        return found

    def rebuild(self, spent: float = 0.0) -> None:
        """Put every particle where it belongs and list its neighbours; collective.

        ``spent`` are the seconds that this rank's pairs took since the last rebuild: they weigh
        its planes, so that slow ranks get fewer.
        """
        self._wrap()
        if self.sizes is not None:
            self.store[self.sizes.listed][self.store.inner] = self.store[self.sizes.length][self.store.inner]
            self._reach_farthest(self.sizes)
        self.grid = self._fit_grid()
        self._arrange(spent)
        self.rebuilds += 1

    def relist(self, lower, upper) -> None:
        """List the neighbours of particles where they stand, on the grid of an earlier rebuild.

        ``lower`` and ``upper`` are the corners that the domain had then; collective.
        """
        self.lower, self.upper = tuple(lower), tuple(upper)
        if self.sizes is not None:
            self._reach_farthest(self.sizes)
        self.grid = make_grid(self.axis, self.cutoff, self.lower, self.upper, self.periods)
        self._arrange(0.0)

    def _reach_farthest(self, sizes: Sizes) -> None:
        """Cells as wide as the particle reaches that was listed as the largest of all."""
        length = self.store[sizes.listed][self.store.inner].max(initial=0.0)
        self.cutoff = sizes.cutoff(float(largest(self.comm, [length])[0]), self.periods)

    def _arrange(self, spent: float) -> None:
        # In this order: who owns which plane is known once cells are counted on the new grid, and only in
        # sorted columns is a plane one slice, of which the halo and the lists are made.
        self._sort(self._balance_and_migrate(spent))
        if self.lanes is not None:
            self._list(self.lanes)
        # Ghosts too, though their owners hold the same number: no message carries listed positions.
        for now, listed in zip(self.store["position"], self.store["listed_position"]):
            listed[: self.store.total] = now[: self.store.total]

    def _list(self, lanes: int) -> None:
        """Ghosts, and the neighbours of every owned particle."""
        # Ids and groups of ghosts do not travel: a loop may ask a ghost for fields alone.
        told = () if self.sizes is None else (self.sizes.listed,)
        self.halo.refresh(self.ghost_fields + self.refreshed + told)
        sought = None if self.sought is None else self.store[self.sought]
        if self.sizes is not None:
            store, listed = self.store, self.store[self.sizes.listed]
            across = self.sizes.looks_across(store.group[: store.total])
            told = store["position"], listed, across, self.sizes, self._slab(), lanes, sought
            self.lists, self.others = list_by_levels(self._used_lists(), *told)
            return
        self.lists = neighbours.build(
            self._used_lists(),
            self.store,
            self.grid,
            self.starts,
            self.planes,
            self.reach,
            self.periods,
            lanes,
            sought,
            self._fill,
        )

    def _slab(self) -> Slab:
        """Where this rank's planes begin and end."""
        store, grid = self.store, self.grid
        begin, end = self.bounds[self.comm.rank : self.comm.rank + 2] / grid.inverse[0] + grid.lower[0]
        sides = store.low, store.owned, store.high
        return Slab(self.axis, begin, end, *sides, self.periods, self.lower, self.cutoff)

    def interior(self) -> tuple[int, int]:
        """Columns of the owned particles that have no ghost among their neighbours."""
        per_plane = self.grid.plane_cells
        # Plane 0 of ``starts`` holds the ghosts below, planes 1 to ``planes`` are owned.  A cell is
        # as wide as the cutoff, so that only the outermost owned plane on either side sees ghosts.
        first = self.starts[2 * per_plane] if self._partner(-1) != MPI.PROC_NULL else self.store.low
        last = self.store.low + self.store.owned
        if self._partner(1) != MPI.PROC_NULL:
            last = self.starts[self.planes * per_plane]
        return int(first), int(max(first, last))

    def columns_near(self, place: float, reach: float) -> tuple[int, int]:
        """The first owned column, and that after the last, of the planes of all that were listed within
        ``reach`` m of ``place`` m along the slab axis."""
        grid, top = self.grid, float(self.grid.counts[0] - 1)
        reach = reach * (1.0 + 1e-9) + 1e-9 / grid.inverse[0]  # rounding may move an edge
        least, most = ((place + away - grid.lower[0]) * grid.inverse[0] for away in (-reach, reach))
        if self.periods[self.axis] is not None and not 0.0 <= least <= most < top + 1.0:
            least, most = 0.0, top  # images may be near
        # As cells are numbered: what stood outside counts to the outermost planes.
        first, last = (int(min(top, max(0.0, plane))) for plane in (least, most))
        begin, end = self.bounds[self.comm.rank : self.comm.rank + 2].tolist()
        first = min(max(first, begin), end)
        last = max(first, min(last + 1, end))
        # The first plane of ``starts`` has ghosts.
        return tuple(int(self.starts[(plane - begin + 1) * grid.plane_cells]) for plane in (first, last))

    def _used_lists(self) -> neighbours.Neighbours:
        """The old lists, to be filled again, and given back where they are too short."""
        # The domain lets go of them, or both would be held while longer ones are made.
        room, self.lists = self.lists, neighbours.empty(0, 0)
        self.others = self.lists
        return room

    def _partner(self, step: int) -> int:
        rank = self.comm.rank + step
        if self.periods[self.axis] is not None:
            return rank % self.comm.size  # of one rank itself: its ghosts are its own far plane
        return rank if 0 <= rank < self.comm.size else MPI.PROC_NULL

    def inside(self, position: np.ndarray) -> np.ndarray:
        """Positions (n, dim) as people read them: within the periods, m; a copy if there are any.

        Between two rebuilds a particle may have left the domain on one side.
        """
        return self.taken_back(position)[0] if any(self.periods) else position

    def taken_back(self, position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Positions as of :meth:`inside`, and by how many periods each was beyond (n, dim): both copies."""
        position, beyond = position.copy(), np.zeros(position.shape)
        for d, periods in self._folded(position.T):
            beyond[:, d] = periods
        return position, beyond

    def _wrap(self) -> None:
        store, inner = self.store, self.store.inner
        for d, periods in self._folded([x[inner] for x in store["position"]]):
            if CROSSED.name in store:
                store[CROSSED.name][d][inner] += periods

    def _folded(self, components) -> Iterator[tuple[int, np.ndarray]]:
        """Take components back into the domain; along each axis that repeats, how many periods each went."""
        for d, (x, low, period) in enumerate(zip(components, self.lower, self.periods)):
            if period is not None:
                periods = np.floor((x - low) / period)
                x -= period * periods
                over = x >= low + period  # rounding may land on the upper edge
                x[over] = low
                yield d, periods + over

    def _fit_grid(self) -> Grid:
        """The grid over the domain and particles outside it; the same on any number of ranks.

        It depends on where particles are now, and how many, and on nothing before: it shrinks as they
        come back, and a run that is resumed after births has the same.
        Where it would have too many cells, its longest side beyond the domain is halved, again and
        again; particles farther out are counted to the outermost cells.
        """
        steps = self._steps_outside()
        grid = self._grid_with(steps)
        allowed = CELLS_A_PARTICLE * self.comm.allreduce(self.store.owned) if steps.any() else 0.0
        while steps.any() and math.prod(grid.counts) > allowed:
            steps[np.argmax(steps)] //= 2
            grid = self._grid_with(steps)
        return grid

    def _steps_outside(self) -> np.ndarray:
        """Steps by which particles of all ranks leave the domain below and above, (2 dimensions,)."""
        dimensions = self.store.dimensions
        reach = np.full(2 * dimensions, -np.inf)
        if self.store.owned:
            for d, x in enumerate(self.store["position"]):
                inner = x[self.store.inner]
                reach[d], reach[dimensions + d] = -np.fmin.reduce(inner), np.fmax.reduce(inner)
        self.comm.Allreduce(MPI.IN_PLACE, reach, MPI.MAX)
        low, high = map(np.array, self._home)
        outside = (reach - np.concatenate([-low, high])) / np.tile(self._step(), 2)
        outside[np.tile([p is not None for p in self.periods], 2)] = 0.0
        return np.clip(np.nan_to_num(np.ceil(outside)), 0, GROWTH * STEPS_A_LENGTH).astype(int)

    def _step(self) -> np.ndarray:
        """A step of the grid's growth along each axis, m."""
        low, high = map(np.array, self._home)
        return (high - low + self.cutoff) / STEPS_A_LENGTH

    def _grid_with(self, steps: np.ndarray) -> Grid:
        """The grid over the domain and so many steps below and above it."""
        below, above = np.split(steps, 2)
        low, high = map(np.array, self._home)
        self.lower = tuple((low - below * self._step()).tolist())
        self.upper = tuple((high + above * self._step()).tolist())
        return make_grid(self.axis, self.cutoff, self.lower, self.upper, self.periods)

    def _cells(self) -> np.ndarray:
        store, grid = self.store, self.grid
        cells = np.empty(store.owned, np.int64)
        position = store["position"]
        first = store.low
        number_cells(
            tuple(position[d] for d in grid.axes),
            first,
            first + store.owned,
            grid.lower,
            grid.inverse,
            grid.along_axes,
            cells,
        )
        return cells

    def _balance_and_migrate(self, spent: float) -> np.ndarray:
        cells = self._cells()
        if self.comm.size == 1:
            self.bounds = np.array([0, self.grid.counts[0]])
            return cells
        planes = planes_of(cells, self.grid)
        histogram = np.bincount(planes, minlength=self.grid.counts[0])
        # Each rank computes the bounds from sums over all: none is told by another which planes it owns.
        self.bounds = rebalanced(self._costs(histogram, spent), self.bounds, self.comm.size)
        owner = np.repeat(np.arange(self.comm.size, dtype=np.int32), np.diff(self.bounds))[planes]
        # Cells follow the columns, and those have changed wherever particles came or went.
        return self._cells() if migrate(self.comm, self.store, owner) else cells

    def _costs(self, mine: np.ndarray, spent: float) -> np.ndarray:
        """What each plane costs, from this rank's particles in each plane; the same on all ranks."""
        numbers = np.zeros(len(mine) + self.comm.size, np.int64)
        numbers[: len(mine)] = mine
        numbers[len(mine) + self.comm.rank] = round(1e9 * spent)  # counts and times in one message
        self.comm.Allreduce(MPI.IN_PLACE, numbers, MPI.SUM)
        histogram, times = numbers[: len(mine)], numbers[len(mine) :]
        if self.bounds is None:
            return histogram
        self.prices.learn(histogram, self.bounds, times)
        return self.prices.of_planes(histogram, self.bounds)

    def _sort(self, cells: np.ndarray) -> None:
        """Sort by cell and id, and learn from the neighbours how many ghosts there will be."""
        store, per_plane = self.store, self.grid.plane_cells
        base = int(self.bounds[self.comm.rank]) * per_plane
        owned = np.empty(self.planes * per_plane + 1, np.int64)
        order = np.empty(store.owned, np.uint32)
        # By id within a cell: a sum then meets its neighbours in the same order, and has the same bits,
        # however particles came here, from whichever rank or restart.
        sort_by_cell(cells, store.id, store.low, base, owned, order)
        del cells  # as long as a field
        filled = np.diff(owned)
        # A neighbour sorts its plane by the same rule: its counts by cell are all that places its particles
        # here, where they come as one slice, in the owner's order.
        below, above = self.trade_planes(filled[:per_plane], filled[-per_plane:])
        store.reorder(order, int(below.sum()), int(above.sum()))
        counts = np.concatenate([below, filled, above])
        self.starts = np.concatenate([[0], np.cumsum(counts)])
        if self.halo is not None:
            self.halo.free()  # its requests name columns of the order before
        self.halo = Halo(
            self.comm,
            store,
            self._partner(-1),
            self._partner(1),
            int(filled[:per_plane].sum()),
            int(filled[-per_plane:].sum()),
        )

    def trade_planes(self, lowest: np.ndarray, highest: np.ndarray, none: float = 0):
        """What the ranks that own the ghost planes below and above tell of these, as this one does of its
        ``lowest`` and ``highest``; ``none`` of ghosts that there are not."""
        below, above = np.full_like(lowest, none), np.full_like(highest, none)
        down, up = self._partner(-1), self._partner(1)
        # At an open end nothing comes: no ghosts there.
        self.comm.Sendrecv(highest, up, recvbuf=below, source=down)
        self.comm.Sendrecv(lowest, down, recvbuf=above, source=up)
        return below, above
