"""What the fluid in front of an open end is like, as particles behind its plane see it.

f = f₀ + f₁·t over the fluid in front of the plane, constant along the normal and linear across it, by least
squares with the weights W dx^d.  A mean of zeroth order leaves the profile of a channel behind by half a
spacing in each row.
"""

from typing import Any, NamedTuple

import numpy as np

from psph.engine.jit import elementwise
from psph.formula import helper
from psph.smoothing import weight
from psph.vectors import at, dot, nearest_image, subtract

TOO_FEW = 0.006
"""Σ W dx^d of the fluid in front of the plane below which buffer particles nearer to it count too."""

AHEAD = 0.25
"""By so many spacings a neighbour has to be nearer to the fluid."""

FLAT = 0.05
"""Part of dx² that the variance of places across the face has to exceed for a fit that is linear there."""

SEEN, NEAR, FITTED = 0, 1, 2
"""Columns of what is seen: 1 where there is fluid; 1 where it is in front of the plane itself; from FITTED
on its pressure in Pa and its velocity in m/s."""


class Planes(NamedTuple):
    """The planes of open ends: they stand at ``place`` m along ``axis``, with the ``sign`` of the inward
    direction; ``pressure`` in Pa and inward ``speed`` in m/s were added behind them in the last step
    (ends,).  Nothing behind them moves on beyond ``low`` and ``high`` (ends, dim), m.  ``middle`` (ends, dim)
    m is that of each at the start; the layers of its fluids meet at ``edges`` (ends, layers + 1), m along
    ``up`` (dim,), with ``rest`` densities (ends, layers), kg/m^d, and speeds of ``sound``, m/s; gravity along
    ``up`` is ``pull``, m/s²."""

    axis: np.ndarray
    place: np.ndarray
    sign: np.ndarray
    pressure: np.ndarray
    speed: np.ndarray
    low: np.ndarray
    high: np.ndarray
    middle: np.ndarray
    edges: np.ndarray
    rest: np.ndarray
    sound: np.ndarray
    up: np.ndarray
    pull: float


class Listed(NamedTuple):
    """Who is near whom: ``lists`` of the particles from column ``low`` on; ``matter`` (columns,) numbers the
    fluids from 1 on, those behind a plane with a minus, and 0 is no fluid."""

    low: int
    lists: Any
    matter: np.ndarray


class Vicinity(NamedTuple):
    """What is the same for all particles: the ``kernel``, ``spacing`` in m, ``gravity`` in m/s² and the
    ``periods`` in m."""

    kernel: Any
    spacing: float
    gravity: tuple[float, ...]
    periods: tuple[float | None, ...]


class Flowing(NamedTuple):
    """The arrays of all columns that are read and filled, (columns,): ``rest`` densities in kg/m^d, speeds of
    ``sound`` in m/s."""

    position: Any
    velocity: Any
    predicted: Any
    density: Any
    volume: Any
    pressure: Any
    rest: Any
    sound: Any
    group: Any


def moments_of(dimensions: int) -> int:
    """Numbers of a particle that :func:`see_fronts` sums: Σw, Σwt, Σwttᵀ, and for the pressure and each
    component of the velocity Σwf and Σwtf."""
    return 1 + dimensions + dimensions**2 + (1 + dimensions) ** 2


@elementwise
def see_fronts(columns, ends, planes, vicinity, listed, flowing, sums, seen):
    """The fluid in front of the planes as each of some ``columns`` behind them sees it.

    ``ends`` (n,) says behind which; ``sums`` (:func:`moments_of`,) is room; ``seen`` (n, FITTED + 1 + dim)
    gets the columns SEEN to FITTED.  Where too little fluid in front of the plane is near, buffer particles
    of it count that are nearer to the plane, less what was added to them in the last step.
    """
    for n in range(len(columns)):
        k, end = np.uint64(columns[n]), ends[n]
        for nearer in range(2):
            _sum_front(k, end, nearer, planes, vicinity, listed, flowing, sums)
            if sums[0] > TOO_FEW:
                break
        seen[n, :] = 0.0
        if sums[0] > 0.0:
            seen[n, SEEN], seen[n, NEAR] = 1.0, 1.0 - nearer
            least, dim = FLAT * vicinity.spacing**2, len(flowing.position)
            _fit(planes.axis[end], dim, least, sums, seen[n, FITTED:])


@helper
def depth(planes, end, flowing, k):
    """How far behind the plane of an end column ``k`` is, m."""
    return (planes.place[end] - flowing.position[planes.axis[end]][k]) * planes.sign[end]


@helper
def _sum_front(k, end, nearer, planes, vicinity, listed, flowing, sums):
    """Fill ``sums`` for column ``k``."""
    axis, sign, dx = planes.axis[end], planes.sign[end], vicinity.spacing
    position, lists, matter = flowing.position, listed.lists, listed.matter
    dim = len(position)
    row, cell, xi = k - np.uint64(listed.low), dx**dim, depth(planes, end, flowing, k)
    sums[:] = 0.0
    entry, last = lists.begin[row], lists.begin[row] + np.uint64(lists.lengths[row])
    while entry < last:
        j = np.uint64(lists.lists[entry])
        entry += np.uint64(1)
        xi_j = depth(planes, end, flowing, j)
        behind = nearer == 1 and matter[j] == -abs(matter[k])
        if j != k and xi_j <= xi - AHEAD * dx and (matter[j] == abs(matter[k]) or behind):
            x_jk = nearest_image(subtract(at(position, j), at(position, k)), vicinity.periods)
            w = weight(vicinity.kernel, np.sqrt(dot(x_jk, x_jk))) * cell
            sums[0] += w
            for d in range(dim):
                across = 0.0 if d == axis else x_jk[d]
                sums[1 + d] += w * across
                for o in range(dim):
                    sums[1 + dim + d * dim + o] += w * across * (0.0 if o == axis else x_jk[o])
            p = flowing.pressure[j] - dot(vicinity.gravity, x_jk) / flowing.volume[j]
            p -= planes.pressure[end] if behind else 0.0
            for value in range(dim + 1):
                f = p
                if value > 0:
                    f = flowing.predicted[value - 1][j]
                    if behind and value - 1 == axis:
                        f -= planes.speed[end] * sign
                place = 1 + dim + dim * dim + value * (dim + 1)
                sums[place] += w * f
                for d in range(dim):
                    sums[place + 1 + d] += w * f * (0.0 if d == axis else x_jk[d])


@helper
def _fit(axis, dim, least, sums, fitted):
    """f₀ of each value from ``sums``, linear across where places differ by more than ``least``, m²."""
    one = 1 if axis == 0 else 0
    two = 3 - axis - one if dim == 3 else one
    total, values = sums[0], 1 + dim + dim * dim
    mean_1, mean_2 = sums[1 + one % dim] / total, sums[1 + two % dim] / total
    spread_11 = sums[1 + dim + (one % dim) * (dim + 1)] / total - mean_1 * mean_1
    spread_22 = sums[1 + dim + (two % dim) * (dim + 1)] / total - mean_2 * mean_2
    spread_12 = sums[1 + dim + (one % dim) * dim + two % dim] / total - mean_1 * mean_2
    size = spread_11 * spread_22 - spread_12 * spread_12
    both = dim == 3 and spread_11 > least and spread_22 > least and size > FLAT * spread_11 * spread_22
    for value in range(dim + 1):
        place = values + value * (dim + 1)
        mean = sums[place] / total
        with_1 = sums[place + 1 + one % dim] / total - mean * mean_1
        with_2 = sums[place + 1 + two % dim] / total - mean * mean_2
        if both:
            mean -= mean_1 * (with_1 * spread_22 - with_2 * spread_12) / size
            mean -= mean_2 * (with_2 * spread_11 - with_1 * spread_12) / size
        else:
            if dim > 1 and spread_11 > least:
                mean -= mean_1 * with_1 / spread_11
            if dim == 3 and spread_22 > least:
                mean -= mean_2 * with_2 / spread_22
        fitted[value] = mean
