"""Smoothing lengths by iteration: each particle's follows the number of its neighbours, and the reverse.

h = η n^(−1/d) with n = Σ_j W(r_ij, h), itself included: of positions alone.  n h^d never falls as h grows, so
Newton's method, kept between the largest h that is too small and the smallest that is too large, finds the
one solution.  Springel & Hernquist (2002), MNRAS 333, 649; Price & Monaghan (2007), MNRAS 374, 1347.
"""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import elementwise, inside
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
    """What is asked: ``target`` η^d, a ``kernel`` with h = 1 m, how far h may exceed that of the lists,
    ``growth``, and the ``periods``, m."""

    target: float
    kernel: object
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
def distance(k, j, position, periods):
    """|x_k − x_j| to the nearest image, m."""
    x = nearest_image(subtract(at(position, k), at(position, j)), periods)
    return np.sqrt(dot(x, x))


@inside
def count(k, row, h, asked, lists, position):
    """n h^d of particle ``k`` with the smoothing length ``h``, and by how much it grows with ln h."""
    inverse, number, growing = 1.0 / h, weight(asked.kernel, 0.0), 0.0
    for entry in range(lists.begin[row], lists.begin[row] + np.uint64(lists.lengths[row])):
        s = distance(k, np.uint64(lists.lists[entry]), position, asked.periods) * inverse
        number += weight(asked.kernel, s)
        growing -= s * slope(asked.kernel, s)
    return number, growing


@elementwise
def find_lengths(first, last, low, asked, lists, position, mass, listed, sums):
    """Find h, ρ and q of the particles in columns ``first`` to ``last`` from their last h.

    ``mass`` (columns,), kg, ``listed`` (columns,) the h of the lists, m.  Where all neighbours stand in one
    place with a particle, any h would do, and it stays.
    """
    d = len(position)
    for k in range(np.uint64(first), np.uint64(last)):
        row = k - np.uint64(low)
        most = asked.growth * listed[k]
        h, smallest, largest, came = min(sums.length[k], most), 0.0, np.inf, NONE
        number = growing = 0.0
        for _ in range(MOST_TURNS):
            number, growing = count(k, row, h, asked, lists, position)
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
        sums.length[k], sums.came[k] = h, came
        if came == FOUND:
            inverse = 1.0 / h
            rho, rising = mass[k] * weight(asked.kernel, 0.0), 0.0
            for entry in range(lists.begin[row], lists.begin[row] + np.uint64(lists.lengths[row])):
                j = np.uint64(lists.lists[entry])
                s = distance(k, j, position, asked.periods) * inverse
                rho += mass[j] * weight(asked.kernel, s)
                rising -= mass[j] * s * slope(asked.kernel, s)
            # ∂ρ/∂h = (rising − d ρ)/h in these units, and d n Ω = growing
            sums.unequal[k] = (d * rho - rising) / -growing if growing > 0.0 else 0.0
            rho *= inverse**d
            sums.density[k], sums.specific_volume[k] = rho, 1.0 / rho


@elementwise
def find_state(first, last, group, gamma, heat, density, pressure, sound):
    """p = (γ − 1) ρ u and c = √(γp/ρ) of the columns ``first`` to ``last``; γ (groups,)."""
    for k in range(np.uint64(first), np.uint64(last)):
        p = (gamma[group[k]] - 1.0) * density[k] * heat[k]
        pressure[k] = p
        sound[k] = np.sqrt(gamma[group[k]] * p / density[k])
