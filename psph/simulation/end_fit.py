"""What the fluid in front of an open end is like, as particles behind its plane see it.

f = f₀ + f₁·t + t·f₂·t over the fluid in front of the plane, constant along the normal and of second order
across it, by least squares with the weights W dx^d.  A mean leaves the profile of a channel behind by half a
spacing in each row; what is linear is too slow by half the curvature times the variance of t, 1 % of a
channel 20 spacings wide, and the fluid in front is dammed up by it.
"""

from typing import Any, NamedTuple

import numpy as np

from psph.engine.jit import elementwise
from psph.formula import helper
from psph.simulation.least_squares import factor, solve
from psph.smoothing import weight
from psph.vectors import at, dot, nearest_image, subtract

TOO_FEW = 0.006
"""Σ W dx^d of the fluid in front of the plane below which buffer particles nearer to it count too."""

AHEAD = 0.25
"""By so many spacings a neighbour has to be nearer to the fluid."""

FLAT = 0.05
"""Variance of a term of the fit, in spacings, less what terms before it tell, below which it is left out."""

SEEN, NEAR, DEPTH, FITTED = 0, 1, 2, 3
"""Columns of what is seen: 1 where there is fluid; 1 where it is in front of the plane itself; its mean depth
behind the plane in m; from FITTED on its pressure in Pa and its velocity in m/s."""


class Planes(NamedTuple):
    """The planes of open ends: they stand at ``place`` m along ``axis`` and go inward with the ``pace``, m/s;
    the inward direction has the ``sign``; ``pressure`` in Pa and inward ``speed`` in m/s were added behind
    them in the last step (ends,). Nothing behind them moves on beyond ``low`` and ``high`` (ends, dim), m.
    ``middle`` (ends, dim) m is that of each at the start; the layers of its fluids meet at ``edges`` (ends,
    layers + 1), m along ``up`` (dim,), with ``rest`` densities (ends, layers), kg/m^d, and speeds of
    ``sound``, m/s; gravity along ``up`` is ``pull``, m/s²; whether a surface is ``open`` above each
    (ends,)."""

    axis: np.ndarray
    place: np.ndarray
    pace: np.ndarray
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
    open: np.ndarray


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


class Fit(NamedTuple):
    """Room for the fit of one particle: its ``terms`` (n,) 1, t and tt, Σw times their products ``square``
    (n, n), Σw times them times the values ``right`` (n, 1 + dim), and ``share`` (n,), what of each of these
    makes f₀."""

    terms: np.ndarray
    square: np.ndarray
    right: np.ndarray
    share: np.ndarray


def room_for(dimensions: int) -> Fit:
    """Room for a fit."""
    n = dimensions * (dimensions + 1) // 2
    return Fit(np.zeros(n), np.zeros((n, n)), np.zeros((n, 1 + dimensions)), np.zeros(n))


@elementwise
def see_fronts(columns, ends, planes, vicinity, listed, flowing, fit, seen):
    """The fluid in front of the planes as each of some ``columns`` behind them sees it.

    ``ends`` (n,) says behind which; ``fit`` is room (:func:`room_for`); ``seen`` (n, FITTED + 1 + dim)
    gets the columns SEEN to FITTED.  Where too little fluid in front of the plane is near, buffer particles
    of it count that are nearer to the plane, less what was added to them in the last step.
    """
    for n in range(len(columns)):
        k, end = np.uint64(columns[n]), ends[n]
        for nearer in range(2):
            mean_depth = _sum_front(k, end, nearer, planes, vicinity, listed, flowing, fit)
            if fit.square[0, 0] > TOO_FEW:
                break
        seen[n, :] = 0.0
        if fit.square[0, 0] > 0.0:
            seen[n, SEEN], seen[n, NEAR], seen[n, DEPTH] = 1.0, 1.0 - nearer, mean_depth
            factor(fit.square, FLAT)
            for value in range(fit.right.shape[1]):
                if value < 2:
                    count = len(fit.share) if value and not planes.open[end] else fit.right.shape[1] - 1
                    solve(fit.square, fit.share, count)
                for one in range(count):
                    seen[n, FITTED + value] += fit.share[one] * fit.right[one, value]


@helper
def depth(planes, end, flowing, k):
    """How far behind the plane of an end column ``k`` is, m."""
    return (planes.place[end] - flowing.position[planes.axis[end]][k]) * planes.sign[end]


@helper
def _sum_front(k, end, nearer, planes, vicinity, listed, flowing, fit):
    """Fill the ``fit`` for column ``k``; the mean depth of what it sees, m."""
    axis, sign, dx = planes.axis[end], planes.sign[end], vicinity.spacing
    position, lists, matter = flowing.position, listed.lists, listed.matter
    dim = len(position)
    row, cell, xi = k - np.uint64(listed.low), dx**dim, depth(planes, end, flowing, k)
    fit.square[:], fit.right[:], deep = 0.0, 0.0, 0.0
    entry, last = lists.begin[row], lists.begin[row] + np.uint64(lists.lengths[row])
    while entry < last:
        j = np.uint64(lists.lists[entry])
        entry += np.uint64(1)
        xi_j = depth(planes, end, flowing, j)
        behind = nearer == 1 and matter[j] == -abs(matter[k])
        if j != k and xi_j <= xi - AHEAD * dx and (matter[j] == abs(matter[k]) or behind):
            x_jk = nearest_image(subtract(at(position, j), at(position, k)), vicinity.periods)
            w = weight(vicinity.kernel, np.sqrt(dot(x_jk, x_jk))) * cell
            deep += w * xi_j
            p = flowing.pressure[j] - dot(vicinity.gravity, x_jk) / flowing.volume[j]
            p -= planes.pressure[end] if behind else 0.0
            _set_terms(axis, dim, x_jk, dx, fit.terms)
            for one in range(len(fit.terms)):
                part = w * fit.terms[one]
                for other in range(one + 1):
                    fit.square[one, other] += part * fit.terms[other]
                fit.right[one, 0] += part * p
                for d in range(dim):
                    added = planes.speed[end] * sign if behind and d == axis else 0.0
                    fit.right[one, 1 + d] += part * (flowing.predicted[d][j] - added)
    return deep / fit.square[0, 0] if deep else 0.0


@helper
def _set_terms(axis, dim, x, dx, terms):
    """1, t and tt of a place ``x`` beside a particle, m, in spacings across the face."""
    terms[0], n = 1.0, 1
    for d in range(dim):
        if d != axis:
            terms[n] = x[d] / dx
            n += 1
    for one in range(1, dim):
        for other in range(one, dim):
            terms[n] = terms[one] * terms[other]
            n += 1
