"""Smoothing lengths by iteration: each particle's follows the number of its neighbours, and the reverse.

h = η n^(−1/d) with n = Σ_j W(r_ij, h), itself included: of positions alone.  n h^d never falls as h grows, so
Newton's method, kept between the largest h that is too small and the smallest that is too large, finds the
one solution.  Springel & Hernquist (2002), MNRAS 333, 649; Price & Monaghan (2007), MNRAS 374, 1347.
"""

from typing import NamedTuple

import numpy as np
from numba.core import types

from psph.engine.jit import elementwise, inside, overload, uncounted
from psph.engine.simd import consecutive, spread, total, width_of
from psph.simulation.near_rows import ALL, AXES, NEARER, meet, meets_all, own_mass
from psph.smoothing import slope, weight

CLOSE = 1e-8
"""Relative change of h by which it is found: by as much 1/Ω is off, and 1e-6 would be heard beside a sound of
1e-4."""

MOST_CHANGE = 0.2
"""Relative change of h in one turn."""

MOST_TURNS = 100
"""Turns after which there is no solution: of Newton's method one to three are usual."""

BEYOND = 64.0
"""Distance over h that lanes behind the last neighbour get: beyond the support of every kernel."""

FOUND, SWOLLEN, OUTGROWN, NONE = 0, 1, 2, 3
"""What came of it: h is found; found, and nearer rows of others may lack the particle; it is larger than
lists reach; there is none."""


class Numbers(NamedTuple):
    """What is asked in so many ``dimensions``: ``target`` η^d, a ``kernel`` with h = 1 m and its ``support``,
    the ``periods`` (3,), m or None, and the ``images`` in mirrors, or None."""

    dimensions: int
    target: float
    kernel: object
    support: float
    periods: tuple
    images: object = None


class Lengths(NamedTuple):
    """Arrays that are filled: h, 1/h, ρ, 1/ρ, q and 1/Ω (psph.physics.gas.state), and what came of it, by
    column."""

    length: object
    inverse: object
    density: object
    specific_volume: object
    unequal: object
    evenness: object
    came: object


@inside
def numbers_with(h, kernel, distance, many):
    """Σ W over the neighbours alone with the smoothing length ``h``, and how it rises with ln h: both times
    h^d."""
    inverse = 1.0 / h
    number = growing = spread(0.0, distance)
    for n in range(np.uint64(0), many, width_of(distance)):
        s = consecutive(distance, n) * inverse
        number, growing = number + weight(kernel, s), growing - s * slope(kernel, s)
    return total(number), total(growing)


def masses_with(h, kernel, mass, numbers, met, many):
    """The same of masses, kg; ``numbers`` are those of numbers."""
    if np.ndim(mass) == 0:
        return mass * numbers[0], mass * numbers[1]
    return _masses_with(h, kernel, met, many)


@overload(masses_with)
def _typed_masses_with(h, kernel, mass, numbers, met, many):
    if isinstance(mass, types.Array):
        return lambda h, kernel, mass, numbers, met, many: _masses_with(h, kernel, met, many)
    return lambda h, kernel, mass, numbers, met, many: (mass * numbers[0], mass * numbers[1])


@inside
def _masses_with(h, kernel, met, many):
    inverse = 1.0 / h
    rho = rising = spread(0.0, met.distance)
    for n in range(np.uint64(0), many, width_of(met.distance)):
        s, m = consecutive(met.distance, n) * inverse, consecutive(met.mass, n)
        rho, rising = rho + m * weight(kernel, s), rising - m * (s * slope(kernel, s))
    return total(rho), total(rising)


@inside
def sleeps(due, k):
    """Whether particle ``k`` is not ``due``, > 0 of those who are, None where all are."""
    return False if due is None else due[k] == 0.0


@uncounted
def find_lengths(first, last, asked, of, growth, listed, found, due, met):
    """Find h, ρ and q of the particles in columns ``first`` to ``last`` from their last h, and their nearer
    rows ``of`` what they see; ``met`` is room to work in.

    ``listed`` (columns,) are the h of the lists, m, by ``growth`` (owned,) they may be exceeded; who is not
    ``due`` (columns,), 0, keeps what it has and has no row.  Where all
    neighbours stand in one place with a particle, any h would do, and it stays.  Sums are over a row alone,
    in its order: the same wherever a slab begins.
    """
    d, kernel, alone = asked.dimensions, asked.kernel, weight(asked.kernel, 0.0)
    end = of.room[first - of.low] if first < last else np.uint64(0)
    for k in range(np.uint64(first), np.uint64(last)):
        row, begin = k - np.uint64(of.low), end
        if sleeps(due, k):
            of.nearer.begin[row], of.nearer.lengths[row], found.came[k] = begin, 0, FOUND
            continue
        most, before = growth[row] * listed[k], of.table[k, AXES]
        swollen = found.length[k] > NEARER * before
        closer = ALL if swollen or meets_all(asked.images, of.table, k) else NEARER
        close, all_met = meet(k, row, closer, BEYOND * most, begin, asked, of, met)
        h, smallest, largest, came = min(found.length[k], most), 0.0, np.inf, NONE
        number, growing = numbers_with(h, kernel, met.distance, all_met)
        for _ in range(MOST_TURNS):
            lacks = asked.target - alone - number
            if growing > 0.0:
                change = min(max(lacks / growing, -MOST_CHANGE), MOST_CHANGE)
            else:
                change = MOST_CHANGE if lacks > 0.0 else 0.0
            if abs(change) < CLOSE:
                came, number = FOUND, number + growing * change
                h = min(h * (1.0 + change), most)
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
            if h > closer * before:
                closer, swollen = ALL, True
                close, all_met = meet(k, row, closer, BEYOND * most, begin, asked, of, met)
            number, growing = numbers_with(h, kernel, met.distance, all_met)
        found.length[k], found.came[k] = h, SWOLLEN if came == FOUND and swollen else came
        of.nearer.begin[row], of.nearer.lengths[row] = begin, close
        end = begin + close
        while (end - begin) % np.uint64(of.multiple) != np.uint64(0):
            of.nearer.lists[end] = k
            end += np.uint64(1)
        if came == FOUND:
            mass, numbers = own_mass(of.mass, k), (number, growing)
            rho, rising = masses_with(h, kernel, of.mass, numbers, met, all_met)
            rho += mass * alone
            # ∂ρ/∂h = (rising − d ρ)/h in these units, and d n Ω = growing
            found.unequal[k] = (d * rho - rising) / -growing if growing > 0.0 else 0.0
            found.evenness[k] = d * (alone + number) / growing if growing > 0.0 else 1.0
            found.inverse[k] = 1.0 / h
            rho /= h**d
            found.density[k], found.specific_volume[k] = rho, 1.0 / rho


@elementwise
def find_state(first, last, group, gamma, heat, density, pressure, sound):
    """p = (γ − 1) ρ u and c = √(γp/ρ) of the columns ``first`` to ``last``; γ (groups,)."""
    for k in range(np.uint64(first), np.uint64(last)):
        p = (gamma[group[k]] - 1.0) * density[k] * heat[k]
        pressure[k] = p
        sound[k] = np.sqrt(gamma[group[k]] * p / density[k])
