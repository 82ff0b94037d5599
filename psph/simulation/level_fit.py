"""What the particles that lead are like where those of another level of sizes follow them.

f = f₀ + f₁·t + t·f₂·t over all that lead around, of whatever level, by least squares with the weights V W,
each by its own smoothing length.  Where they are too few for a term it is left out.  What is linear blurs a
vortex of five spacings: it loses a tenth of its energy at a border, with terms of second order a hundredth.
"""

from typing import Any, NamedTuple

import numpy as np

from psph.engine.jit import elementwise
from psph.formula import helper
from psph.simulation.least_squares import factor, solve
from psph.smoothing import weight
from psph.vectors import at, dot, nearest_image, subtract

FLAT = 0.01
"""Variance of a term of the fit, in spacings, less what terms before it tell, below which it is left out."""

TOO_FEW = 0.05
"""Σ V W of those who lead below which nobody is followed."""

FULL = 0.85
"""Σ V W below which a surface is near, and terms of second order would reach beyond it."""

ORDER = 2
"""Of the fit."""

FITTED = 1
"""Column of what is seen from which on fitted values are; before it is Σ V W."""


class Leaders(NamedTuple):
    """Who is seen: rows of the ``own`` level and of ``others``, of the particles from column ``low`` on; who
    ``leads`` (columns,), and the smoothing ``length`` of each, m (columns,)."""

    low: int
    own: Any
    others: Any
    leads: np.ndarray
    length: np.ndarray


class OfLeaders(NamedTuple):
    """The arrays of all columns that are read (columns,): what the forces read."""

    position: Any
    velocity: Any
    volume: Any
    pressure: Any
    mass: Any


class LevelFit(NamedTuple):
    """Room for a fit: its ``terms`` (n,) 1, t and tt, Σw times their products ``square`` (n, n), Σw times
    them times the values ``right`` (n, 2 + dim), and ``share`` (n,), what of each of these makes f₀."""

    terms: np.ndarray
    square: np.ndarray
    right: np.ndarray
    share: np.ndarray


@helper
def room_for(dimensions, order):
    """LevelFit for a fit of an ``order``."""
    n = 1 if order == 0 else 1 + dimensions if order == 1 else (dimensions + 1) * (dimensions + 2) // 2
    return LevelFit(np.zeros(n), np.zeros((n, n)), np.zeros((n, 2 + dimensions)), np.zeros(n))


@elementwise
def see_leaders(first, last, columns, scale, unit, periods, leaders, shown, order, seen):
    """What each of some ``columns`` (n,) sees of those who lead, from the ``first`` to the one before the
    ``last``, by a fit of an ``order``.

    ``scale`` (n,) m is the spacing of those; ``unit`` the kernel with h = 1 m; ``seen`` (n, FITTED + 2 + dim)
    gets Σ V W, then density, kg/m^d, pressure, Pa, and velocity, m/s.
    """
    room = room_for(len(shown.position), order)
    for n in range(first, last):
        k = np.uint64(columns[n])
        room.square[:], room.right[:] = 0.0, 0.0
        _take_row(k, scale[n], unit, periods, leaders, leaders.own, shown, room)
        _take_row(k, scale[n], unit, periods, leaders, leaders.others, shown, room)
        seen[n, :] = 0.0
        seen[n, 0] = room.square[0, 0]
        if seen[n, 0] > TOO_FEW:
            factor(room.square, FLAT)
            few = 1 + len(shown.position) if seen[n, 0] < FULL else len(room.share)
            count = min(few, len(room.share))
            solve(room.square, room.share, count)
            for value in range(room.right.shape[1]):
                for one in range(count):
                    seen[n, FITTED + value] += room.share[one] * room.right[one, value]


@helper
def _take_row(k, scale, unit, periods, leaders, lists, shown, room):
    """Take those who lead in a row into the sums of column ``k``."""
    row, dim = k - np.uint64(leaders.low), len(shown.position)
    entry, last = lists.begin[row], lists.begin[row] + np.uint64(lists.lengths[row])
    while entry < last:
        j = np.uint64(lists.lists[entry])
        entry += np.uint64(1)
        if leaders.leads[j]:
            x_jk = nearest_image(subtract(at(shown.position, j), at(shown.position, k)), periods)
            inverse = 1.0 / leaders.length[j]
            w = (
                weight(unit, np.sqrt(dot(x_jk, x_jk)) * inverse)
                * inverse**dim
                * shown.mass[j]
                * shown.volume[j]
            )
            if w > 0.0:
                _set_terms(dim, x_jk, scale, room.terms)
                density = 1.0 / shown.volume[j]
                for one in range(len(room.terms)):
                    part = w * room.terms[one]
                    for other in range(one + 1):
                        room.square[one, other] += part * room.terms[other]
                    room.right[one, 0] += part * density
                    room.right[one, 1] += part * shown.pressure[j]
                    for d in range(dim):
                        room.right[one, 2 + d] += part * shown.velocity[d][j]


@helper
def _set_terms(dim, x, scale, terms):
    """1, t and tt, as many as there are, of a place ``x`` beside a particle, m, in units of ``scale``."""
    terms[0] = 1.0
    if len(terms) > 1:
        for d in range(dim):
            terms[1 + d] = x[d] / scale
    n = 1 + dim
    if len(terms) > n:
        for one in range(dim):
            for other in range(one, dim):
                terms[n] = terms[1 + one] * terms[1 + other]
                n += 1
