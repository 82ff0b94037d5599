"""Smoothing lengths by iteration: each particle's follows the number of its neighbours, and the reverse.

h = η n^(−1/d) with n = Σ_j W(r_ij, h), itself included: of positions alone.  n h^d never falls as h grows, so
Newton's method, kept between the largest h that is too small and the smallest that is too large, finds the
one solution.  Springel & Hernquist (2002), MNRAS 333, 649; Price & Monaghan (2007), MNRAS 374, 1347.
"""

from typing import NamedTuple

import numpy as np
from numba.core import types

from psph.engine.jit import compiled, elementwise, inside, overload
from psph.engine.simd import EIGHT, consecutive, put_consecutive, spread, total, turning, width_of
from psph.smoothing import slope, weight
from psph.vectors import dot, nearest_image, subtract

CLOSE = 1e-6
"""Relative change of h by which it is found."""

MOST_CHANGE = 0.2
"""Relative change of h in one turn."""

MOST_TURNS = 100
"""Turns after which there is no solution: of Newton's method three to five are usual."""

BEYOND = 64.0
"""Distance over h that lanes behind the last neighbour get: beyond the support of every kernel."""

AXES, NUMBERS = 3, 4
"""Of a particle in a table: its place, with zeros along axes that there are not, and its mass."""

FOUND, OUTGROWN, NONE = 0, 1, 2
"""What came of it: h is found; it is larger than lists reach; there is none."""


class Images(NamedTuple):
    """Where images in mirrors stand: at ``turns`` x + ``shifts``, m, three numbers for each; a particle
    farther than ``reach`` m from a plane sees none."""

    turns: tuple[tuple[float, ...], ...]
    shifts: tuple[tuple[float, ...], ...]
    reach: float


def images_in(mirrors, reach: float) -> Images | None:
    """Those in ``mirrors`` (psph.composition.mirrors), seen up to ``reach`` m; None without mirrors."""
    if mirrors is None:
        return None
    seen = mirrors.reflections[1:]
    turns = tuple((*one.turn, *(1.0,) * (AXES - len(one.turn))) for one in seen)
    shifts = tuple((*one.shift, *(0.0,) * (AXES - len(one.shift))) for one in seen)
    return Images(turns, shifts, reach)


class Numbers(NamedTuple):
    """What is asked in so many ``dimensions``: ``target`` η^d, a ``kernel`` with h = 1 m and its ``support``,
    how far h may exceed that of the lists, ``growth``, the ``periods`` (3,), m or None, and the ``images``
    in mirrors, or None."""

    dimensions: int
    target: float
    kernel: object
    support: float
    growth: float
    periods: tuple
    images: object = None


class Lengths(NamedTuple):
    """Arrays that are filled: h, ρ, 1/ρ, q and 1/Ω (psph.physics.gas.state), and what came of it, by
    column."""

    length: object
    density: object
    specific_volume: object
    unequal: object
    evenness: object
    came: object


class Distances(NamedTuple):
    """To the neighbours of a particle: ``distance``, m, and ``mass``, kg; both go on for a register."""

    distance: object
    mass: object


@inside
def gather(k, row, beyond, asked, lists, table, near):
    """Write distances and masses of all that the ``row`` of the column ``k`` names to ``near``, of their
    images and its own, and behind them lanes ``beyond`` m away; how many there are."""
    many, begin = np.uint64(lists.lengths[row]), lists.begin[row]
    place = table[k, 0], table[k, 1], table[k, 2]
    for n in range(np.uint64(0), many, width_of(table)):
        x, y, z, m = fetched(table, lists.lists, begin + n)
        x_ij = nearest_image(subtract(place, (x, y, z)), asked.periods)
        put_consecutive(near.distance, n, np.sqrt(dot(x_ij, x_ij)))
        put_consecutive(near.mass, n, m)
    many = with_images(asked.images, k, row, many, asked.periods, lists, table, near)
    for n in range(many, many + np.uint64(EIGHT)):
        near.distance[n] = beyond
    return many


def with_images(images, k, row, many, periods, lists, table, near):
    """Write those of images in mirrors behind the ``many`` that are there; how many there are then."""
    return many if images is None else _with_images(images, k, row, many, periods, lists, table, near)


@overload(with_images)
def _typed_with_images(images, k, row, many, periods, lists, table, near):
    if isinstance(images, types.NoneType):
        return lambda images, k, row, many, periods, lists, table, near: many
    return lambda images, k, row, many, periods, lists, table, near: _with_images(
        images, k, row, many, periods, lists, table, near
    )


@inside
def _with_images(images, k, row, many, periods, lists, table, near):
    listed, begin = np.uint64(lists.lengths[row]), lists.begin[row]
    place = table[k, 0], table[k, 1], table[k, 2]
    for one in range(len(images.turns)):
        turn, shift = images.turns[one], images.shifts[one]
        seen = True
        for d in range(AXES):
            seen = seen and (turn[d] > 0.0 or abs(2.0 * place[d] - shift[d]) < 2.0 * images.reach)
        if not seen:
            continue
        # Its distance from the image of j is that of its own image from j.
        image = turn[0] * place[0] + shift[0], turn[1] * place[1] + shift[1], turn[2] * place[2] + shift[2]
        for n in range(np.uint64(0), listed, width_of(table)):
            x, y, z, m = fetched(table, lists.lists, begin + n)
            x_ij = nearest_image(subtract(image, (x, y, z)), periods)
            put_consecutive(near.distance, many + n, np.sqrt(dot(x_ij, x_ij)))
            put_consecutive(near.mass, many + n, m)
        many += listed
        x_ij = nearest_image(subtract(image, place), periods)
        near.distance[many], near.mass[many] = np.sqrt(dot(x_ij, x_ij)), table[k, AXES]
        many += np.uint64(1)
    return many


def seen(images, listed):
    """How many a particle sees at the most that has so many neighbours ``listed``, images with them."""
    return listed if images is None else (1 + len(images.turns)) * (listed + 1)


@overload(seen)
def _typed_seen(images, listed):
    if isinstance(images, types.NoneType):
        return lambda images, listed: listed
    return lambda images, listed: (1 + len(images.turns)) * (listed + 1)


def fetched(table, lists, entry):
    """The numbers of the particles ``lists[entry]`` and following, as lanes."""
    return tuple(table[lists[entry]])


@overload(fetched)
def _typed_fetched(table, lists, entry):
    turn = turning(NUMBERS)
    return lambda table, lists, entry: turn(table, lists, entry)


class KernelSums(NamedTuple):
    """Sums over the neighbours of a particle, in units of h^d: the ``number`` n, and how it rises with
    ln h, ``growing``; the same of masses, ``rho`` and ``rising``, kg."""

    number: object
    growing: object
    rho: object
    rising: object


@inside
def shares_with(h, kernel, near, many):
    """Sums over the neighbours alone, with the smoothing length ``h``."""
    inverse = 1.0 / h
    number = growing = rho = rising = spread(0.0, near.distance)
    for n in range(np.uint64(0), many, width_of(near.distance)):
        s, m = consecutive(near.distance, n) * inverse, consecutive(near.mass, n)
        w, falls = weight(kernel, s), s * slope(kernel, s)
        number, growing = number + w, growing - falls
        rho, rising = rho + m * w, rising - m * falls
    return KernelSums(total(number), total(growing), total(rho), total(rising))


def table_of(position, mass, columns: int) -> np.ndarray:
    """Places, m, and masses, kg, of so many columns side by side (columns, 4)."""
    table = np.zeros((columns, NUMBERS))
    for d, x in enumerate(position):
        table[:, d] = x[:columns]
    table[:, AXES] = mass if np.ndim(mass) == 0 else mass[:columns]
    return table


@inside
def room_for(near, most):
    """``near``, or longer ones, for ``most`` neighbours."""
    if most + EIGHT <= len(near.distance):
        return near
    return Distances(np.zeros(2 * most + EIGHT), np.zeros(2 * most + EIGHT))


@compiled
def find_lengths(first, last, low, asked, lists, table, listed, found):
    """Find h, ρ and q of the particles in columns ``first`` to ``last`` from their last h.

    ``table`` (columns, 4) has places, m, and masses, kg; ``listed`` (columns,) are the h of the lists, m.
    Where all neighbours stand in one place with a particle, any h would do, and it stays.  Sums are over a
    row alone, in its order: the same wherever a slab begins.
    """
    d, kernel, near = asked.dimensions, asked.kernel, Distances(np.zeros(EIGHT), np.zeros(EIGHT))
    alone = weight(kernel, 0.0)
    for k in range(np.uint64(first), np.uint64(last)):
        row = k - np.uint64(low)
        near = room_for(near, seen(asked.images, np.int64(lists.lengths[row])))
        most = asked.growth * listed[k]
        many = gather(k, row, BEYOND * most, asked, lists, table, near)
        h, smallest, largest, came = min(found.length[k], most), 0.0, np.inf, NONE
        sums = shares_with(h, kernel, near, many)
        for _ in range(MOST_TURNS):
            lacks = asked.target - alone - sums.number
            if sums.growing > 0.0:
                change = min(max(lacks / sums.growing, -MOST_CHANGE), MOST_CHANGE)
            else:
                change = MOST_CHANGE if lacks > 0.0 else 0.0
            if abs(change) < CLOSE:
                came = FOUND
                break
            if lacks > 0.0:
                smallest = h
                if h >= most:
                    came = OUTGROWN
                    break
            else:
                largest = h
            wanted = h * (1.0 + change)
            if not smallest < wanted < largest:
                wanted = 0.5 * (smallest + largest)
            h = min(wanted, most)
            sums = shares_with(h, kernel, near, many)
        found.length[k], found.came[k] = h, came
        if came == FOUND:
            rho = table[k, 3] * alone + sums.rho
            # ∂ρ/∂h = (rising − d ρ)/h in these units, and d n Ω = growing
            found.unequal[k] = (d * rho - sums.rising) / -sums.growing if sums.growing > 0.0 else 0.0
            found.evenness[k] = d * (alone + sums.number) / sums.growing if sums.growing > 0.0 else 1.0
            rho /= h**d
            found.density[k], found.specific_volume[k] = rho, 1.0 / rho


@elementwise
def find_state(first, last, group, gamma, heat, density, pressure, sound):
    """p = (γ − 1) ρ u and c = √(γp/ρ) of the columns ``first`` to ``last``; γ (groups,)."""
    for k in range(np.uint64(first), np.uint64(last)):
        p = (gamma[group[k]] - 1.0) * density[k] * heat[k]
        pressure[k] = p
        sound[k] = np.sqrt(gamma[group[k]] * p / density[k])
