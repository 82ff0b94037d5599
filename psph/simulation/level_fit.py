"""What the particles that lead are like where those of another level of sizes follow them.

f = f₀ + f₁·t + t·f₂·t over all that lead around, of whatever level, by least squares with the weights V W,
each by its own smoothing length.  Where they are too few for a term it is left out.  What is linear blurs a
vortex of five spacings: it loses a tenth of its energy at a border, with terms of second order a hundredth.
Beside surfaces, floors and walls, where it carries on what is seen on one side, terms fade.

f₀ = Σ_j c_j f_j, where c_j rests on places alone: it is found where lists are made, and serves until new ones
are.  All move with the flow in between, and a flow that is linear around leaves Σ_j c_j x_jk = 0.  Pressures
are followed as the depths that they are in their own rows (:mod:`psph.simulation.surface_rows`).
"""

from typing import Any, NamedTuple

import numpy as np

from psph.engine.jit import elementwise
from psph.formula import helper
from psph.simulation.least_squares import factor, solve
from psph.simulation.level_images import is_near
from psph.simulation.surface_rows import RowsAtRest, borne, weighed
from psph.smoothing import weight
from psph.vectors import add, at, dot, multiply, nearest_image, put, subtract

FLAT = 0.01
"""Variance of a term of the fit, in spacings, less what terms before it tell, below which it is left out."""

TOO_FEW = 0.05
"""Σ V W of those who lead below which nobody is followed."""

SECOND = 0.84, 0.86
"""Σ V W between which terms of second order fade: below, a surface or a wall is near, and they would reach
beyond it.  At a border in a flow Σ V W falls below 0.95 too: were terms to fade from 1 to 0.95, a vortex
would keep 0.93 of its energy there, not 0.95."""

FIRST = 0.6, 0.85
"""Σ V W between which linear terms of the velocity fade into its mean.  A row at a floor or a surface that
goes faster than the next is otherwise followed by one that goes faster still: in still water 0.4 m deep that
grows from 1 mm/s to 30 mm/s in two seconds.  Pressures keep theirs: a mean is that of another depth."""

ORDER = 2
"""Of the fit."""


class Leaders(NamedTuple):
    """Who is seen: rows of the ``own`` level and of ``others``, of the particles from column ``low`` on; the
    smoothing ``length`` of each, m, and its ``position``, m, where it was listed (columns,)."""

    low: int
    own: Any
    others: Any
    length: np.ndarray
    position: Any


class Weighed(NamedTuple):
    """How they are weighed: by a ``kernel`` with h = 1 m, times ``cell``, dx^d/h^d of every level;
    ``periods`` in m or None; the ``order`` of the fit; what ``rows`` bear below a surface."""

    kernel: Any
    cell: float
    periods: tuple
    order: int
    rows: RowsAtRest


class Followed(NamedTuple):
    """Whom each of some particles follows: from ``begin`` (n,) on ``many`` (n,) entries, the ``column`` of
    each, the number of its ``image`` in mirrors and what the pressure of that is ``beyond`` its own, Pa, its
    ``share`` c in pressure and density and its share in the ``flow``.  ``longest`` is the longest row."""

    begin: np.ndarray
    many: np.ndarray
    column: np.ndarray
    image: np.ndarray
    beyond: np.ndarray
    share: np.ndarray
    flow: np.ndarray
    longest: int


class OfLeaders(NamedTuple):
    """The arrays of all columns that are read of those who lead, what forces read, and written of those who
    follow (columns,)."""

    velocity: Any
    predicted: Any
    volume: Any
    pressure: Any
    density: Any


class LevelFit(NamedTuple):
    """Room for a fit: its ``terms`` (n,) 1, t and tt, Σw times their products ``square`` (n, n), and
    ``share`` (n,), what of Σw times each makes f₀, with terms of second order ``second`` (n,); ``place``
    (longest, dim), in spacings, of entries."""

    terms: np.ndarray
    square: np.ndarray
    share: np.ndarray
    second: np.ndarray
    place: np.ndarray


@helper
def room_for(dimensions, order, longest):
    """LevelFit for a fit of an ``order``."""
    n = 1 if order == 0 else 1 + dimensions if order == 1 else (dimensions + 1) * (dimensions + 2) // 2
    square, place = np.zeros((n, n)), np.empty((longest, dimensions))
    return LevelFit(np.zeros(n), square, np.zeros(n), np.zeros(n), place)


@elementwise
def follow(first, last, columns, scale, leaders, images, weighing, anew, followed, state, fall):
    """Give some ``columns`` (n,) the state of those they follow, from the ``first`` to the one before the
    ``last``; ``scale`` (n,) m is the spacing of those, which have ``images`` (psph.simulation.level_images).

    With ``anew`` whom they follow is found first.  Whoever has too few falls, by ``fall`` (dim,) m/s.
    """
    room = room_for(len(leaders.position), weighing.order, followed.longest)
    for n in range(first, last):
        k = np.uint64(columns[n])
        if anew:
            followed.many[n] = find(k, scale[n], leaders, images, weighing, room, followed, n)
        if followed.many[n]:
            take_after(k, followed, n, leaders.length, images, weighing.rows, state)
        else:
            for d in range(len(fall)):
                state.velocity[d][k] += fall[d]
        put(state.predicted, k, at(state.velocity, k))


@helper
def find(k, scale, leaders, images, weighing, room, followed, n):
    """The columns whom ``k`` follows and their shares, by a fit, in row ``n``; returns how many there are."""
    dim, begin = len(leaders.position), followed.begin[n]
    share = followed.share[begin:]
    told = followed.column[begin:], followed.image[begin:], followed.beyond[begin:], share
    room.square[:] = 0.0
    many = take_row(k, scale, leaders, leaders.own, images, weighing, room, told, 0)
    many = take_row(k, scale, leaders, leaders.others, images, weighing, room, told, many)
    total = room.square[0, 0]
    if total <= TOO_FEW:
        return 0
    factor(room.square, FLAT)
    set_shares(dim, total, room)
    linear = part_of(FIRST, total)
    for n in range(many):
        set_terms(dim, room.place[n], room.terms)
        part = 0.0
        for one in range(len(room.share)):
            part += room.share[one] * room.terms[one]
        followed.flow[begin + np.uint64(n)] = share[n] * (linear * part + (1.0 - linear) / total)
        share[n] *= part
    return many


@helper
def part_of(between, total):
    """0 where ``total`` is below the first of two numbers, 1 where it is above the second."""
    return min(max((total - between[0]) / (between[1] - between[0]), 0.0), 1.0)


@helper
def set_shares(dim, total, room):
    """What of Σw times each term makes f₀ where Σ V W is ``total``, of the ``square`` in factors."""
    second = part_of(SECOND, total)
    room.share[:] = 0.0
    solve(room.square, room.share, min(1 + dim, len(room.share)))
    if second > 0.0:
        solve(room.square, room.second, len(room.share))
        for one in range(len(room.share)):
            room.share[one] += second * (room.second[one] - room.share[one])


@helper
def take_row(k, scale, leaders, lists, images, weighing, room, told, many):
    """Take those who lead in a row into the sums of column ``k``, and into the arrays ``told``, column,
    image, beyond and share, behind ``many`` entries; returns how many there are then."""
    row, dim, x_k = k - np.uint64(leaders.low), len(leaders.position), at(leaders.position, k)
    entry, last = lists.begin[row], lists.begin[row] + np.uint64(lists.lengths[row])
    column, image, beyond, share = told
    while entry < last:
        j = np.uint64(lists.lists[entry])
        entry += np.uint64(1)
        for m in range(len(images.turn[0])):
            if not is_near(images, m, x_k):
                continue
            x_j = at(leaders.position, j)
            seen = add(multiply(at(images.turn, m), x_j), at(images.shift, m))
            x_jk = nearest_image(subtract(seen, x_k), weighing.periods)
            w = weighing.cell * weight(weighing.kernel, np.sqrt(dot(x_jk, x_jk)) / leaders.length[j])
            if w > 0.0:
                for d in range(dim):
                    room.place[many, d] = x_jk[d] / scale
                column[many], image[many], beyond[many], share[many] = (
                    j,
                    m,
                    dot(images.weight, subtract(seen, x_j)),
                    w,
                )
                set_terms(dim, room.place[many], room.terms)
                for one in range(len(room.terms)):
                    part = w * room.terms[one]
                    for other in range(one + 1):
                        room.square[one, other] += part * room.terms[other]
                many += 1
    return many


@helper
def set_terms(dim, x, terms):
    """1, t and tt, as many as there are, of a place ``x`` (dim,) beside a particle, in spacings."""
    terms[0] = 1.0
    if len(terms) > 1:
        for d in range(dim):
            terms[1 + d] = x[d]
    n = 1 + dim
    if len(terms) > n:
        for one in range(dim):
            for other in range(one, dim):
                terms[n] = x[one] * x[other]
                n += 1


@helper
def take_after(k, followed, n, length, images, rows, state):
    """Column ``k`` gets the sums of the shares of row ``n`` times what each column that it follows has;
    ``length`` m is the smoothing length of columns."""
    density, seen, depth = 0.0, 0.0, 0.0
    first = followed.begin[n]
    for entry in range(first, first + followed.many[n]):
        j, c = followed.column[entry], followed.share[entry]
        beyond = followed.beyond[entry]
        pressure = state.pressure[j] + beyond
        density += c / state.volume[j] + c * beyond * rows.softness
        seen += c * pressure
        depth += c * weighed(rows, length[j], pressure)
    pressure = borne(rows, length[k], depth)
    density += (pressure - seen) * rows.softness
    state.density[k], state.volume[k], state.pressure[k] = density, 1.0 / density, pressure
    for d in range(len(state.velocity)):
        v = 0.0
        for entry in range(first, first + followed.many[n]):
            j, m = followed.column[entry], followed.image[entry]
            seen = images.turn_velocity[d][m] * state.predicted[d][j] + images.shift_velocity[d][m]
            v += followed.flow[entry] * seen
        state.velocity[d][k] = v
