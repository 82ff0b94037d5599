"""Smoothing lengths by iteration: each particle's follows the number of its neighbours, and the reverse.

h = η n^(−1/d) with n = Σ_j W(r_ij, h), itself included: of positions alone.  n h^d never falls as h grows, so
Newton's method, kept between the largest h that is too small and the smallest that is too large, finds the
one solution.  Springel & Hernquist (2002), MNRAS 333, 649; Price & Monaghan (2007), MNRAS 374, 1347.
"""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import compiled, elementwise, inside
from psph.smoothing import slope, weight
from psph.vectors import at, dot, nearest_image, subtract

CLOSE = 1e-6
"""Relative change of h by which it is found."""

MOST_CHANGE = 0.2
"""Relative change of h in one turn."""

MOST_TURNS = 100
"""Turns after which there is no solution: of Newton's method three to five are usual."""

FOUND, OUTGROWN, NONE = 0, 1, 2
"""What came of it: h is found; it is larger than lists reach; there is none."""


class Numbers(NamedTuple):
    """What is asked: ``target`` η^d, a ``kernel`` with h = 1 m and its ``support``, how far h may exceed that
    of the lists, ``growth``, and the ``periods``, m."""

    target: float
    kernel: object
    support: float
    growth: float
    periods: tuple


class Lengths(NamedTuple):
    """Arrays that are filled: h, ρ, 1/ρ, q (psph.physics.gas.state), and what came of it, by column."""

    length: object
    density: object
    specific_volume: object
    unequal: object
    came: object


@inside
def gather(k, row, farthest, periods, lists, position, mass, near):
    """Distance, m, and mass, kg, of the neighbours of ``k`` within ``farthest`` m, into the rows of ``near``
    (2, most); how many there are."""
    many = 0
    for entry in range(lists.begin[row], lists.begin[row] + np.uint64(lists.lengths[row])):
        j = np.uint64(lists.lists[entry])
        x = nearest_image(subtract(at(position, k), at(position, j)), periods)
        r2 = dot(x, x)
        if r2 < farthest * farthest:
            near[0, many], near[1, many] = np.sqrt(r2), mass[j]
            many += 1
    return many


@inside
def count(h, kernel, near, many):
    """n h^d of a particle with the smoothing length ``h``, and by how much it grows with ln h."""
    inverse, number, growing = 1.0 / h, weight(kernel, 0.0), 0.0
    for n in range(many):
        s = near[0, n] * inverse
        number += weight(kernel, s)
        growing -= s * slope(kernel, s)
    return number, growing


@compiled
def find_lengths(first, last, low, asked, lists, position, mass, listed, found):
    """Find h, ρ and q of the particles in columns ``first`` to ``last`` from their last h.

    ``mass`` (columns,), kg, ``listed`` (columns,) the h of the lists, m.  Where all neighbours stand in one
    place with a particle, any h would do, and it stays.  Sums are over a row alone, in its order: the same
    wherever a slab begins.
    """
    d, kernel, near = len(position), asked.kernel, np.empty((2, 0))
    for k in range(np.uint64(first), np.uint64(last)):
        row = k - np.uint64(low)
        if lists.lengths[row] > near.shape[1]:
            near = np.empty((2, 2 * np.int64(lists.lengths[row])))
        most = asked.growth * listed[k]
        many = gather(k, row, asked.support * most, asked.periods, lists, position, mass, near)
        h, smallest, largest, came = min(found.length[k], most), 0.0, np.inf, NONE
        growing = 0.0
        for _ in range(MOST_TURNS):
            number, growing = count(h, kernel, near, many)
            lacks = asked.target - number
            if growing > 0.0:
                change = min(max(lacks / growing, -MOST_CHANGE), MOST_CHANGE)
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
        found.length[k], found.came[k] = h, came
        if came == FOUND:
            inverse = 1.0 / h
            rho, rising = mass[k] * weight(kernel, 0.0), 0.0
            for n in range(many):
                s = near[0, n] * inverse
                rho += near[1, n] * weight(kernel, s)
                rising -= near[1, n] * s * slope(kernel, s)
            # ∂ρ/∂h = (rising − d ρ)/h in these units, and d n Ω = growing
            found.unequal[k] = (d * rho - rising) / -growing if growing > 0.0 else 0.0
            rho *= inverse**d
            found.density[k], found.specific_volume[k] = rho, 1.0 / rho


@elementwise
def find_state(first, last, group, gamma, heat, density, pressure, sound):
    """p = (γ − 1) ρ u and c = √(γp/ρ) of the columns ``first`` to ``last``; γ (groups,)."""
    for k in range(np.uint64(first), np.uint64(last)):
        p = (gamma[group[k]] - 1.0) * density[k] * heat[k]
        pressure[k] = p
        sound[k] = np.sqrt(gamma[group[k]] * p / density[k])
