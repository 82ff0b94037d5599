"""Cells and the global order of particles: by cell, the slab axis slowest, then by id."""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import compiled, elementwise, overload

COLUMNS_PER_CUTOFF = 4
"""Along the fastest axis cells are that much finer, so that few candidates lie out of reach."""


class Grid(NamedTuple):
    """Cells over the whole domain, the same on every rank; axes from slowest to fastest.

    A particle outside is counted to the nearest cell: clipping moves no two particles apart, so
    every neighbour stays within reach.
    """

    axes: tuple[int, ...]
    lower: tuple[float, ...]
    inverse: tuple[float, ...]
    counts: tuple[int, int, int]
    periodic: tuple[bool, bool, bool]
    reach: int
    """Columns on either side that can hold a neighbour."""

    @property
    def along_axes(self) -> tuple[int, ...]:
        """Number of cells along each of ``axes``."""
        planes, rows, columns = self.counts
        return {1: (planes,), 2: (planes, columns), 3: self.counts}[len(self.axes)]

    @property
    def of_counts(self) -> tuple[int, int, int]:
        """The axes of planes, rows and columns; where there is one row or column, any."""
        return self.axes[0], self.axes[len(self.axes) // 2], self.axes[-1]

    @property
    def plane_cells(self) -> int:
        """Cells of one plane."""
        return self.counts[1] * self.counts[2]


def make_grid(axis: int, cutoff: float, lower, upper, periods) -> Grid:
    """Cells no smaller than ``cutoff`` m that cover ``lower`` to ``upper`` (tuples, m).

    ``axis`` is the slab axis; ``periods`` holds a length or None for each axis.
    """
    dimensions = len(lower)
    # The slab axis first, so slowest: planes across it are runs of cells, and of sorted columns.
    axes = (axis, *(d for d in range(dimensions) if d != axis))
    counts, inverse = [], []
    for rank, d in enumerate(axes):
        finest = rank == dimensions - 1 and dimensions > 1
        # A whole number of cells, each at least so wide: the next cell holds all that is in reach.
        size = cutoff / COLUMNS_PER_CUTOFF if finest else cutoff
        extent = upper[d] - lower[d]
        n = max(1, int(extent / size))
        counts.append(n)
        inverse.append(n / extent if periods[d] or n > 1 else 1.0 / max(extent, size))
    periodic = [periods[d] is not None for d in axes]
    if dimensions == 2:  # planes of one row of columns
        counts.insert(1, 1)
        periodic.insert(1, False)
    counts += [1] * (3 - len(counts))
    periodic += [False] * (3 - len(periodic))
    reach = COLUMNS_PER_CUTOFF if dimensions > 1 else 0
    lower = tuple(float(lower[d]) for d in axes)
    return Grid(axes, lower, tuple(inverse), tuple(counts), tuple(periodic), reach)


def _clipped(x, lower, inverse, count):
    """Cell coordinate of ``x`` along one axis, clipped into the grid."""
    # A NaN must not become an index: it is caught as a lost particle elsewhere.
    cell = (x - lower) * inverse
    if not cell > 0.0:
        return 0
    return min(int(min(cell, 2.0e9)), count - 1)


def _cell(position, k, lower, inverse, counts):
    """Number of particle ``k``'s cell, slowest axis first."""
    number = 0
    for d in range(len(position)):
        number = number * counts[d] + _clipped(position[d][k], lower[d], inverse[d], counts[d])
    return number


@overload(_clipped)
def _typed_clipped(x, lower, inverse, count):
    return _clipped


@overload(_cell)
def _typed_cell(position, k, lower, inverse, counts):
    last = len(position) - 1
    if last < 0:
        return lambda position, k, lower, inverse, counts: 0

    def number(position, k, lower, inverse, counts):
        slower = _cell(position[:last], k, lower[:last], inverse[:last], counts[:last])
        here = _clipped(position[last][k], lower[last], inverse[last], counts[last])
        return slower * counts[last] + here

    return number


@elementwise
def number_cells(position, first, last, lower, inverse, counts, cells):
    """Write the global cell number of the particles ``first`` to ``last`` into ``cells``."""
    for k in range(first, last):
        cells[k - first] = _cell(position, k, lower, inverse, counts)


@compiled
def sort_by_cell(cells, ids, first_column, base, starts, order):
    """Counting sort of particles into their cells, ids rising within each.

    ``cells`` (n,) global cell numbers, ``ids`` by column, ``base`` the first cell of ``starts``.
    On return cell c holds ``order[starts[c - base] : starts[c - base + 1]]``, columns of the store.
    """
    for c in range(len(starts)):
        starts[c] = 0
    for k in range(len(cells)):
        starts[cells[k] - base + 1] += 1
    for c in range(1, len(starts)):
        starts[c] += starts[c - 1]
    for k in range(len(cells)):
        c = cells[k] - base
        order[starts[c]] = first_column + k
        starts[c] += 1
    for c in range(len(starts) - 1, 0, -1):
        starts[c] = starts[c - 1]
    starts[0] = 0
    # Migration and the previous order leave few of them out of place: insertion is enough.
    for c in range(len(starts) - 1):
        for k in range(starts[c] + 1, starts[c + 1]):
            column = order[k]
            m = k
            while m > starts[c] and ids[order[m - 1]] > ids[column]:
                order[m] = order[m - 1]
                m -= 1
            order[m] = column


def planes_of(cells: np.ndarray, grid: Grid) -> np.ndarray:
    """The plane of the whole grid that each of the cells lies in, int32 to spare memory."""
    planes = np.empty(len(cells), np.int32)
    return np.floor_divide(cells, grid.plane_cells, out=planes, casting="unsafe")
