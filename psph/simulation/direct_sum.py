"""Self-gravity by the direct sum: every pair once from each side, in the order of the particles' numbers.

A particle gets the same bits on any number of ranks, and the two of a pair opposite forces up to the
rounding of a product."""

from typing import Any, NamedTuple

import numpy as np

from psph.engine.jit import compiled
from psph.engine.settled import settled
from psph.engine.simd import EIGHT, consecutive, spread, total, width_of
from psph.engine.threads import in_threads
from psph.simulation.masses import ID, MASS, PLACE, SIZE, WHOLE, Pulled
from psph.simulation.reaching import Alike, BySize, field_of
from psph.vectors import add, at, dot, put, scale, subtract


class Masses(NamedTuple):
    """What pulls, in the order of the particles' numbers: three arrays of ``places``, m, and ``mass``, kg.

    Filled up to whole registers with what has no mass; ``factor`` is G, ``reach`` how far they reach
    (psph.simulation.reaching), ``row`` the reach of each, where they have one.
    """

    places: Any
    mass: Any
    factor: float
    reach: Any
    row: np.ndarray


class DirectSum:
    """The sum over all pairs, with G as ``factor`` and H as ``reach``, m; None where rows have it."""

    turns_at_start = 1
    """It rests on places alone."""

    def __init__(self, factor: float, reach: float | None):
        self._factor, self._reach, self._attract = factor, reach, settled(attract)

    def renew(self, rows: np.ndarray, pulled: Pulled) -> int:
        """Fill the pulls of all ``rows``; returns the bytes that it holds beside them."""
        if self._reach is None:
            own = rows[np.searchsorted(rows[:, ID], pulled.id), SIZE]
        else:
            own = np.full(len(pulled.columns), self._reach)
        for whole, pull, energy in pulled.parts:
            masses = self._masses(rows[rows[:, WHOLE] == whole])
            columns = pulled.columns, own, pulled.position
            in_threads(self._attract, 0, len(pulled.columns), masses, *columns, pull, energy)
        return 0

    def _masses(self, rows: np.ndarray) -> Masses:
        count = -(-len(rows) // EIGHT) * EIGHT
        table = np.zeros((5, count))
        table[:3, : len(rows)], table[3, : len(rows)] = rows[:, PLACE].T, rows[:, MASS]
        table[4], reach = 1.0, Alike(self._reach)
        if self._reach is None:
            table[4, : len(rows)], reach = rows[:, SIZE], BySize(table[4], table[4])
        return Masses(tuple(table[:3]), table[3], self._factor, reach, table[4])


@compiled
def attract(first, last, masses, columns, own, position, pull, energy):
    """a = −G Σ_j m_j g x_ij and ½φ = −½G Σ_j m_j f of the ``columns`` from the ``first`` to before the
    ``last``, with themselves: a vector of no length, and an energy that is always the same."""
    begin, end = np.uint64(0), np.uint64(len(masses.mass))
    for number in range(first, last):
        k = columns[number]
        x = at(position, k)
        sums = spread((0.0, 0.0, 0.0), masses.mass)
        held = spread(0.0, masses.mass)
        for n in range(begin, end, width_of(masses.mass)):
            a, b, c = masses.places
            there = consecutive(a, n), consecutive(b, n), consecutive(c, n)
            away = subtract(there, x)
            g, f = field_of(masses.reach, np.sqrt(dot(away, away)), own[number], masses.row, n)
            m = consecutive(masses.mass, n)
            sums = add(sums, scale(away, m * g))
            held = held + m * f
        put(pull, k, scale(total(sums), masses.factor))
        energy[k] = -0.5 * masses.factor * total(held)
