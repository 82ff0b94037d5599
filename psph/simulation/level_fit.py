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

from psph.engine.jit import overload, uncounted
from psph.engine.simd import bits, consecutive, spread, total, width_of
from psph.formula import long_helper
from psph.particles.lanes import LANES, consecutive_each, keep_entries, keep_lanes, keep_lines
from psph.simulation.least_squares import factor, solve
from psph.simulation.level_images import is_near
from psph.simulation.surface_rows import RowsAtRest
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
water would not make way for a body that comes.  Where the wall lets nothing slip all of it is: were what goes
along it a mean, a border across a sheared flow would brake it, and the wall bear a tenth more."""

TIPS = 0.3, 0.4
"""Σ V W between which linear terms of pressure and density fade into their mean, and what weighs between that
and who follows.  At the tips of a surface shares of both signs have sums of 2 to 5, above of 1.5 to 1.9: who
followed there had more pressure than who leads below, pressed on these, and so got more yet, by a factor e in
4 ms."""

NO_SIDE = 1e-6
"""Square of the mean way to walls, in spacings, below which they are on no side."""

ORDER = 2
"""Of the fit."""


class Leaders(NamedTuple):
    """Who is seen: rows of the ``own`` level, of ``others`` and of ``walls`` beside them, of the particles
    from column ``low`` on; the smoothing ``length`` of each, m, its ``position``, m, where it was listed,
    and 1 where it ``holds`` what is beside it (columns,)."""

    low: int
    own: Any
    others: Any
    walls: Any
    length: np.ndarray
    position: Any
    holds: np.ndarray


class Weighed(NamedTuple):
    """How they are weighed: by a ``kernel`` with h = 1 m, times ``cell``, dx^d/h^d of every level;
    ``periods`` in m or None; the ``order`` of the fit; what ``rows`` bear below a surface; at which Σ V W
    linear terms of the pressure fade at ``tips``."""

    kernel: Any
    cell: float
    periods: tuple
    order: int
    rows: RowsAtRest
    tips: tuple[float, float]


class Followed(NamedTuple):
    """Whom each of some particles follows: from ``begin`` (n,) on the entries that the first image in mirrors
    shows, ``many`` (n, images), then those of the next; behind them on those of walls, ``beside``
    (n, images); the ``column`` of each entry, its ``share`` c in pressure and density, its share in the
    ``flow`` and in that ``across`` walls, along the unit vector ``normal``, components (dim,) (n,),
    and the part ``held`` (n,) of these walls along which nothing slips; how much ``deeper`` (n,), Pa, each is
    than who is followed says.  ``longest`` is the longest row."""

    begin: np.ndarray
    many: np.ndarray
    beside: np.ndarray
    normal: tuple[np.ndarray, ...]
    held: np.ndarray
    deeper: np.ndarray
    column: np.ndarray
    share: np.ndarray
    flow: np.ndarray
    across: np.ndarray
    longest: int


class LevelFit(NamedTuple):
    """Room for a fit: the ``terms`` (n, longest) 1, t and tt of entries, those times their ``weight``
    (n, longest), both term behind term too, ``all_terms`` and ``all_weights``, the sums of the products of
    both, ``square`` (n, n), and ``share`` (n,), what of Σw times each makes f₀, with terms of second order
    ``second`` (n,).  Of entries the ``column``, the components of where they are, ``place`` (dim,), m, and
    the smoothing ``length``, m, ``own`` and that by which they are weighed, all (longest,)."""

    terms: np.ndarray
    weight: np.ndarray
    all_terms: np.ndarray
    all_weights: np.ndarray
    square: np.ndarray
    share: np.ndarray
    second: np.ndarray
    column: np.ndarray
    place: tuple[np.ndarray, ...]
    own: np.ndarray
    length: np.ndarray


def room_for(dimensions: int, order: int, longest: int) -> LevelFit:
    """Room for a fit of an ``order`` to as many as the ``longest`` row has."""
    n = 1 if order == 0 else 1 + dimensions if order == 1 else (dimensions + 1) * (dimensions + 2) // 2
    many = longest + 2 * LANES  # whole registers, and one behind the last entry
    terms, weights, square = np.zeros((n, many)), np.zeros((n, many)), np.zeros((n, n))
    flat = terms.reshape(-1), weights.reshape(-1)
    lines = tuple(np.zeros((dimensions + 2, many)))
    column = np.zeros(many, np.uint32)
    return LevelFit(terms, weights, *flat, square, *np.zeros((2, n)), column, lines[:-2], *lines[-2:])


@uncounted
def find_leaders(first, last, columns, spacing, leaders, images, weighing, wide, followed, room):
    """Find whom some ``columns`` (n,) follow, from the ``first`` to the one before the ``last``; ``spacing``
    (n,) m is that of those, which have ``images`` (psph.simulation.level_images); ``room`` is to work in.
    Who looks ``wide`` sees as far as its own smoothing length reaches, or farther."""
    for n in range(first, last):
        find(np.uint64(columns[n]), spacing[n], leaders, images, weighing, room, wide, followed, n)


@long_helper
def find(k, spacing, leaders, images, weighing, room, wide, followed, n):
    """Whom ``k`` follows and their shares, by a fit, in row ``n``; nobody where they are too few."""
    dim, begin = len(leaders.position), followed.begin[n]
    share, flow = followed.share[begin:], followed.flow[begin:]
    rows, counts = (leaders.own, leaders.others), followed.many[n]
    least = leaders.length[k] if wide else 0.0
    many = take_images(k, spacing, least, leaders, rows, images, weighing, room, np.uint64(0), counts)
    name(room, followed.column[begin:], np.uint64(0), many)
    sum_products(dim, room, many)
    total = room.square[0, 0]
    if total <= TOO_FEW:
        counts[:] = 0
        return
    add_shares(dim, room, share, many)
    followed.deeper[n] = 0.0
    if total < weighing.tips[1] and weighing.order > 0:
        part = part_of(weighing.tips, total)
        followed.deeper[n] = level_out(dim, spacing, images, room, share, many, part, total)
    linear = part_of(FIRST, total)
    for entry in range(many):
        mean = room.weight[0, entry] / total
        flow[entry] = linear * share[entry] + (1.0 - linear) * mean
    followed.beside[n] = 0
    if linear < 1.0 and weighing.order > 0:
        look_at_walls(k, spacing, leaders, images, weighing, room, followed, n, many)


@long_helper
def level_out(dim, spacing, images, room, share, many, part, total):
    """Leave a ``part`` of the ``share`` of ``many`` entries in f₀, and make the rest that in the mean of f,
    where Σ V W is ``total``; returns how much deeper than this mean f₀ is by the rest, Pa."""
    deeper = 0.0
    for entry in range(many):
        mean = (1.0 - part) * room.weight[0, entry] / total
        share[entry] = part * share[entry] + mean
        for d in range(dim):
            deeper -= mean * images.weight[d] * room.terms[1 + d, entry] * spacing
    return deeper


@long_helper
def look_at_walls(k, spacing, leaders, images, weighing, room, followed, n, many):
    """Put those of walls behind the ``many`` entries of ``k``, and find the shares of both in the flow across
    the walls; none where these are all around."""
    dim, begin = len(leaders.position), followed.begin[n]
    across, rows, counts = followed.across[begin:], (leaders.walls,), followed.beside[n]
    found = take_images(k, spacing, 0.0, leaders, rows, images, weighing, room, many, counts)
    name(room, followed.column[begin:], many, found)
    size, total, held = 0.0, 0.0, 0.0
    for entry in range(many, found):
        total += room.weight[0, entry]
    for d in range(dim):
        way = 0.0
        for entry in range(many, found):
            way += room.weight[0, entry] * room.terms[1 + d, entry]
        followed.normal[d][n] = way
        size += way * way
    if size <= NO_SIDE * total**2:
        counts[:] = 0
        return
    for entry in range(many, found):
        held += room.weight[0, entry] * leaders.holds[np.uint64(room.column[entry])]
    followed.held[n] = held / total
    for d in range(dim):
        followed.normal[d][n] /= np.sqrt(size)
    sum_products(dim, room, found)
    add_shares(dim, room, across, found)


@long_helper
def take_images(k, spacing, least, leaders, rows, images, weighing, room, many, counts):
    """Take those in some ``rows`` of column ``k`` as all ``images`` show them, behind ``many`` entries, and
    put how many each shows into ``counts`` (images,); returns how many there are then."""
    for m in range(len(images.turn[0])):
        before = many
        if is_near(images, m, at(leaders.position, k)):
            for lists in rows:
                stop = see_row(k, least, leaders, lists, images, m, weighing, room, many)
                many = keep_weighed(spacing, weighing, room, many, stop)
        counts[m] = many - before
    return many


@long_helper
def name(room, column, first, last):
    """Write the columns of the entries ``first`` to ``last``."""
    for entry in range(first, last):
        column[entry] = room.column[entry]


@long_helper
def add_shares(dim, room, share, many):
    """Set the ``share`` of ``many`` entries in f₀, from the sums of the products of their terms."""
    total = room.square[0, 0]
    factor(room.square, FLAT)
    set_shares(dim, total, room)
    share[:many] = 0.0
    for one in range(len(room.share)):
        of = room.share[one]
        for entry in range(many):
            share[entry] += of * room.weight[one, entry]


@long_helper
def part_of(between, total):
    """0 where ``total`` is below the first of two numbers, 1 where it is above the second."""
    return min(max((total - between[0]) / (between[1] - between[0]), 0.0), 1.0)


@long_helper
def set_shares(dim, total, room):
    """What of Σw times each term makes f₀ where Σ V W is ``total``, of the ``square`` in factors."""
    second = part_of(SECOND, total)
    room.share[:] = 0.0
    solve(room.square, room.share, min(1 + dim, len(room.share)))
    if second > 0.0:
        solve(room.square, room.second, len(room.share))
        for one in range(len(room.share)):
            room.share[one] += second * (room.second[one] - room.share[one])


@long_helper
def see_row(k, least, leaders, lists, images, m, weighing, room, many):
    """Put those of a row of column ``k`` behind ``many`` entries, as image ``m`` shows them, and by which
    length they are weighed: theirs, but no less than the ``least``, m; returns how many there are then."""
    row, x_k, place = k - np.uint64(leaders.low), at(leaders.position, k), many
    entry, last = lists.begin[row], lists.begin[row] + np.uint64(lists.lengths[row])
    while entry < last:
        j = np.uint64(lists.lists[entry])
        seen = add(multiply(at(images.turn, m), at(leaders.position, j)), at(images.shift, m))
        put(room.place, place, nearest_image(subtract(seen, x_k), weighing.periods))
        room.column[place], room.own[place] = j, leaders.length[j]
        room.length[place] = max(leaders.length[j], least)
        entry += np.uint64(1)
        place += np.uint64(1)
    return place


@long_helper
def keep_weighed(spacing, weighing, room, many, stop):
    """Keep those of the entries ``many`` to ``stop`` that have a weight, and set it and their terms; returns
    how many there are then."""
    last, one, long = many, np.uint64(1), np.uint64(room.terms.shape[1])
    for entry in range(many, stop, width_of(room.length)):
        h, own = consecutive(room.length, entry), consecutive(room.own, entry)
        x_jk = consecutive_each(room.place, entry)
        w = weight(weighing.kernel, np.sqrt(dot(x_jk, x_jk)) / h) * weighing.cell
        for _ in range(len(x_jk)):
            w = w * (own / h)
        chosen = above_zero(w) & ((one << min(np.uint64(LANES), stop - entry)) - one)
        keep_entries(room.column, last, room.column, entry, chosen, room.length)
        keep_lines(room.all_terms, last, long, scale(x_jk, 1.0 / spacing), chosen)
        last = keep_lanes(room.all_weights, last, w, chosen)
    return last


def above_zero(w):
    """Bit t says whether lane t is."""
    return int(w > 0.0)


@overload(above_zero)
def _typed_above_zero(w):
    return lambda w: bits(w > 0.0)


@long_helper
def sum_products(dim, room, many):
    """Set the terms of ``many`` entries by where they are, those times their weights, and the sums of the
    products of both, of which the lower half is set."""
    terms, weights, count = room.terms, room.weight, 1 + dim
    filled = (np.int64(many) + LANES - 1) // LANES * LANES
    weights[0, many:filled] = 0.0
    for one in range(1, min(count, len(terms))):
        terms[one, many:filled] = 0.0
    for one in range(dim if len(terms) > count else 0):
        for other in range(one, dim):
            for entry in range(filled):
                terms[count, entry] = terms[1 + one, entry] * terms[1 + other, entry]
            count += 1
    terms[0, :filled] = 1.0
    for one in range(1, len(terms)):
        for entry in range(filled):
            weights[one, entry] = weights[0, entry] * terms[one, entry]
    # Side by side: one after another each product would wait for the sum before it.
    width, long = width_of(room.all_terms), np.uint64(terms.shape[1])
    for one in range(np.uint64(len(terms))):
        for other in range(one + np.uint64(1)):
            products = spread(0.0, room.all_terms)
            for entry in range(np.uint64(0), np.uint64(filled), width):
                weighed = consecutive(room.all_weights, one * long + entry)
                products = products + weighed * consecutive(room.all_terms, other * long + entry)
            room.square[one, other] = total(products)
