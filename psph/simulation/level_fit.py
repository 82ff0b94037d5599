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
from psph.vectors import add, at, dot, multiply, nearest_image, put, scale, subtract

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
grows from 1 mm/s to 30 mm/s in two seconds.  Pressures keep theirs: a mean is that of another depth.
Beside a wall the velocity across it is that of a fit to fluid and wall: were it a mean of the fluid too,
water would not make way for a body that comes."""

NO_SIDE = 1e-6
"""Square of the mean way to walls, in spacings, below which they are on no side."""

ORDER = 2
"""Of the fit."""


class Leaders(NamedTuple):
    """Who is seen: rows of the ``own`` level, of ``others`` and of ``walls`` beside them, of the particles
    from column ``low`` on; the smoothing ``length`` of each, m, and its ``position``, m, where it was listed
    (columns,)."""

    low: int
    own: Any
    others: Any
    walls: Any
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
    """Whom each of some particles follows: from ``begin`` (n,) on the entries that the first image in mirrors
    shows, ``many`` (n, images), then those of the next; behind them on those of walls, ``beside``
    (n, images); the ``column`` of each entry, its ``share`` c in pressure and density, its share in the
    ``flow`` and in that ``across`` walls, along the unit vector ``normal`` (n, dim).  ``longest`` is the
    longest row."""

    begin: np.ndarray
    many: np.ndarray
    beside: np.ndarray
    normal: np.ndarray
    column: np.ndarray
    share: np.ndarray
    flow: np.ndarray
    across: np.ndarray
    longest: int


class OfLeaders(NamedTuple):
    """The arrays of all columns that are read of those who lead, what forces read, and written of those who
    follow (columns,)."""

    velocity: Any
    predicted: Any
    volume: Any
    pressure: Any
    density: Any


class AsLed(NamedTuple):
    """What is read of those who lead and no field: their ``density`` by their volume, kg/m³, and ρ g times
    the ``depth`` at which their rows bear their pressures, Pa (columns,)."""

    density: np.ndarray
    depth: np.ndarray


class LevelFit(NamedTuple):
    """Room for a fit: the ``terms`` (n, longest) 1, t and tt of entries, those times their ``weight``
    (n, longest), the sums of the products of both, ``square`` (n, n), and ``share`` (n,), what of Σw times
    each makes f₀, with terms of second order ``second`` (n,)."""

    terms: np.ndarray
    weight: np.ndarray
    square: np.ndarray
    share: np.ndarray
    second: np.ndarray


@helper
def room_for(dimensions, order, longest):
    """LevelFit for a fit of an ``order``."""
    n = 1 if order == 0 else 1 + dimensions if order == 1 else (dimensions + 1) * (dimensions + 2) // 2
    terms, square = np.empty((n, longest)), np.zeros((n, n))
    return LevelFit(terms, np.empty((n, longest)), square, np.zeros(n), np.zeros(n))


@elementwise
def weigh_rows(first, last, length, rows, state, led):
    """What ``led`` says of the columns from the ``first`` to the one before the ``last``, whose smoothing
    ``length`` is in m."""
    for k in range(first, last):
        led.density[k] = 1.0 / state.volume[k]
        led.depth[k] = weighed(rows, length[k], state.pressure[k])


@elementwise
def follow(first, last, columns, spacing, leaders, images, weighing, anew, followed, state, led, fall):
    """Give some ``columns`` (n,) the state of those they follow, from the ``first`` to the one before the
    ``last``; ``spacing`` (n,) m is that of those, which have ``images`` (psph.simulation.level_images).

    With ``anew`` whom they follow is found first.  Whoever has too few falls, by ``fall`` (dim,) m/s.
    """
    room = room_for(len(leaders.position), weighing.order, followed.longest)
    for n in range(first, last):
        k = np.uint64(columns[n])
        if anew:
            find(k, spacing[n], leaders, images, weighing, room, followed, n)
        if followed.many[n].sum():
            take_after(k, followed, n, leaders, images, weighing.rows, state, led)
        else:
            for d in range(len(fall)):
                state.velocity[d][k] += fall[d]
        put(state.predicted, k, at(state.velocity, k))


@helper
def find(k, spacing, leaders, images, weighing, room, followed, n):
    """Whom ``k`` follows and their shares, by a fit, in row ``n``; nobody where they are too few."""
    dim, begin, many = len(leaders.position), followed.begin[n], 0
    column, share, flow = followed.column[begin:], followed.share[begin:], followed.flow[begin:]
    for m in range(len(images.turn[0])):
        before = many
        if is_near(images, m, at(leaders.position, k)):
            many = take_row(k, spacing, leaders, leaders.own, images, m, weighing, room, column, many)
            many = take_row(k, spacing, leaders, leaders.others, images, m, weighing, room, column, many)
        followed.many[n, m] = many - before
    sum_products(dim, room, many)
    total = room.square[0, 0]
    if total <= TOO_FEW:
        followed.many[n] = 0
        return
    factor(room.square, FLAT)
    set_shares(dim, total, room)
    linear = part_of(FIRST, total)
    share[:many] = 0.0
    for one in range(len(room.share)):
        of = room.share[one]
        for entry in range(many):
            share[entry] += of * room.weight[one, entry]
    for entry in range(many):
        mean = room.weight[0, entry] / total
        flow[entry] = linear * share[entry] + (1.0 - linear) * mean
    followed.beside[n] = 0
    if linear < 1.0 and weighing.order > 0:
        look_at_walls(k, spacing, leaders, images, weighing, room, followed, n, many)


@helper
def look_at_walls(k, spacing, leaders, images, weighing, room, followed, n, many):
    """Put those of walls behind the ``many`` entries of ``k``, and find the shares of both in the flow across
    the walls; none where these are all around."""
    dim, begin, found = len(leaders.position), followed.begin[n], many
    column, across = followed.column[begin:], followed.across[begin:]
    for m in range(len(images.turn[0])):
        before = found
        if is_near(images, m, at(leaders.position, k)):
            found = take_row(k, spacing, leaders, leaders.walls, images, m, weighing, room, column, found)
        followed.beside[n, m] = found - before
    size = 0.0
    for d in range(dim):
        way = 0.0
        for entry in range(many, found):
            way += room.weight[0, entry] * room.terms[1 + d, entry]
        followed.normal[n, d] = way
        size += way * way
    if size <= NO_SIDE * room.weight[0, many:found].sum() ** 2:
        followed.beside[n] = 0
        return
    for d in range(dim):
        followed.normal[n, d] /= np.sqrt(size)
    sum_products(dim, room, found)
    total = room.square[0, 0]
    factor(room.square, FLAT)
    set_shares(dim, total, room)
    across[:found] = 0.0
    for one in range(len(room.share)):
        of = room.share[one]
        for entry in range(found):
            across[entry] += of * room.weight[one, entry]


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
def take_row(k, spacing, leaders, lists, images, m, weighing, room, column, many):
    """Take those who lead in a row of column ``k``, as image ``m`` shows them, behind ``many`` entries: the
    ``column`` of each, where it is and its weight; returns how many there are then."""
    row, x_k = k - np.uint64(leaders.low), at(leaders.position, k)
    entry, last = lists.begin[row], lists.begin[row] + np.uint64(lists.lengths[row])
    while entry < last:
        j = np.uint64(lists.lists[entry])
        entry += np.uint64(1)
        x_j = at(leaders.position, j)
        seen = add(multiply(at(images.turn, m), x_j), at(images.shift, m))
        x_jk = nearest_image(subtract(seen, x_k), weighing.periods)
        w = weighing.cell * weight(weighing.kernel, np.sqrt(dot(x_jk, x_jk)) / leaders.length[j])
        if w > 0.0:
            column[many], room.weight[0, many] = j, w
            for d in range(len(x_jk)):
                room.terms[min(1 + d, len(room.terms) - 1), many] = x_jk[d] / spacing
            many += 1
    return many


@helper
def sum_products(dim, room, many):
    """Set the terms of ``many`` entries by where they are, those times their weights, and the sums of the
    products of both, of which the lower half is set."""
    terms, weights, count = room.terms, room.weight, 1 + dim
    for one in range(dim if len(terms) > count else 0):
        for other in range(one, dim):
            for entry in range(many):
                terms[count, entry] = terms[1 + one, entry] * terms[1 + other, entry]
            count += 1
    terms[0, :many] = 1.0
    for one in range(1, len(terms)):
        for entry in range(many):
            weights[one, entry] = weights[0, entry] * terms[one, entry]
    for one in range(len(terms)):
        for other in range(one + 1):
            total = 0.0
            for entry in range(many):
                total += weights[one, entry] * terms[other, entry]
            room.square[one, other] = total


@helper
def take_after(k, followed, n, leaders, images, rows, state, led):
    """Column ``k`` gets the sums of the shares of row ``n`` times what each column that it follows has."""
    density, seen, depth, first = 0.0, 0.0, 0.0, followed.begin[n]
    velocity = scale(at(state.velocity, k), 0.0)
    for m in range(len(images.turn[0])):
        last, flow, moving = first + followed.many[n, m], 0.0, scale(velocity, 0.0)
        for entry in range(first, last):
            j, share, part = followed.column[entry], followed.share[entry], followed.flow[entry]
            density += share * led.density[j]
            seen += share * state.pressure[j]
            depth += share * led.depth[j]
            flow += part
            moving = add(moving, scale(at(state.predicted, j), part))
        velocity = add(velocity, multiply(at(images.turn_velocity, m), moving))
        velocity = add(velocity, scale(at(images.shift_velocity, m), flow))
        for entry in range(first, last if images.deeper[m] else first):
            j, share = followed.column[entry], followed.share[entry]
            x_j = at(leaders.position, j)
            shown = add(multiply(at(images.turn, m), x_j), at(images.shift, m))
            beyond = dot(images.weight, subtract(shown, x_j))
            density += share * beyond * rows.softness
            seen += share * beyond
            depth += share * (weighed(rows, leaders.length[j], state.pressure[j] + beyond) - led.depth[j])
        first = last
    pressure = borne(rows, leaders.length[k], depth)
    density += (pressure - seen) * rows.softness
    state.density[k], state.volume[k], state.pressure[k] = density, 1.0 / density, pressure
    put(state.velocity, k, velocity)
    if followed.beside[n].sum():
        across_walls(k, followed, n, images, state)


@helper
def across_walls(k, followed, n, images, state):
    """The velocity of column ``k`` across the walls beside row ``n`` becomes that between fluid and these."""
    first, speed = followed.begin[n], 0.0
    for lot in (followed.many, followed.beside):
        for m in range(len(images.turn[0])):
            last = first + lot[n, m]
            for entry in range(first, last):
                j, share = followed.column[entry], followed.across[entry]
                for d in range(len(state.velocity)):
                    seen = images.turn_velocity[d][m] * state.predicted[d][j] + images.shift_velocity[d][m]
                    speed += share * followed.normal[n, d] * seen
            first = last
    for d in range(len(state.velocity)):
        speed -= followed.normal[n, d] * state.velocity[d][k]
    for d in range(len(state.velocity)):
        state.velocity[d][k] += followed.normal[n, d] * speed
