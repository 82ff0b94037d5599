"""Self-gravity by the direct sum: every pair once from each side, in the order of the particles' numbers.

Each rank has all masses, in the same order, and sums those that pull its own particles: so these get the same
bits on any number of ranks, and the two of a pair opposite forces up to the rounding of a product.
"""

from typing import Any, NamedTuple

import numpy as np

from psph.engine.jit import compiled
from psph.engine.settled import settled
from psph.engine.simd import EIGHT, consecutive, spread, total, width_of
from psph.kinds import Rank, Work
from psph.output.diagnostics import true_mass
from psph.parallel.reductions import all_rows
from psph.physics.motion import is_free
from psph.physics.self_gravity import (
    ATTRACTION,
    ATTRACTION_ENERGY,
    REACH,
    WHOLE_ATTRACTION,
    has_own_steps,
    is_whole,
    softened,
)
from psph.vectors import add, at, dot, put, scale, subtract

ID, PLACE, MASS, WHOLE, WIDTH = 0, slice(1, 4), 4, 5, 6
"""Of the rows that ranks exchange: the particle's number, where it is, its mass, and 1 where it moves as
a whole, else 0."""


class Masses(NamedTuple):
    """What pulls, in the order of the particles' numbers: three arrays of ``places``, m, and ``mass``, kg.

    Filled up to whole registers with what has no mass; ``factor`` is G, ``reach`` H in m.
    """

    places: Any
    mass: Any
    factor: float
    reach: float


class DirectSum(Work):
    """The pulls on the particles of a rank, by all of the scene."""

    name = "attraction"

    def __init__(self, rank: Rank):
        self.store, self.comm, self.ledger = rank.store, rank.domain.comm, rank.ledger
        told = rank.scene.case.physics.self_gravity
        self._factor, self._reach = float(told.constant), REACH * float(told.softening)
        groups = rank.plan.materials
        self._whole = groups.where(lambda one: is_whole(one.motion))
        self._ahead = groups.where(lambda one: has_own_steps(one.motion))
        self._attracted = self._whole | self._ahead | groups.where(lambda one: is_free(one.motion))
        self._attract, self._held = settled(attract), 0

    def renew(self, simulation) -> None:
        """Both pulls where all particles stand at the end of a step; collective."""
        store, each = self.store, simulation.engine.each
        with self.ledger("self-gravity"):
            own, mass = self._own(simulation.engine.kinds)
            rows = all_rows(self.comm, own)
            rows = rows[np.argsort(rows[:, ID])]
            self._held = 2 * rows.nbytes
            due = self._attracted.astype(np.uint8), store.group, store["position"]
            ahead = store.low + np.flatnonzero(self._ahead[store.shown("group")])
            before, energy = self._pull(ahead), store[ATTRACTION_ENERGY.name]
            parts = self._masses(rows[rows[:, WHOLE] == 0.0])
            each(self._attract, parts, *due, store[ATTRACTION.name], energy)
            energy[store.inner] += 0.5 * self._factor * REACH / self._reach * mass  # that with itself
            if WHOLE_ATTRACTION.name in store:
                wholes = self._masses(rows[rows[:, WHOLE] == 1.0])
                each(self._attract, wholes, *due, store[WHOLE_ATTRACTION.name], np.zeros(store.total))
            self._catch_up(simulation.dt, ahead, self._pull(ahead) - before)

    def _masses(self, rows: np.ndarray) -> Masses:
        count = -(-len(rows) // EIGHT) * EIGHT
        table = np.zeros((4, count))
        table[:3, : len(rows)], table[3, : len(rows)] = rows[:, PLACE].T, rows[:, MASS]
        return Masses(tuple(table[:3]), table[3], self._factor, self._reach)

    def _own(self, kinds) -> tuple[np.ndarray, np.ndarray]:
        """The rows of this rank's particles that attract (n, WIDTH), and of all of its particles the mass
        with which they do so without moving as a whole; the works of ``kinds`` know some masses."""
        store = self.store
        group, mass = store.shown("group"), true_mass(store)
        for kind in kinds:
            kind.weigh(store, mass)
        which = self._attracted[group]
        rows = np.empty((int(which.sum()), WIDTH))
        rows[:, ID], rows[:, MASS] = store.shown("id")[which], mass[which]
        rows[:, PLACE], rows[:, WHOLE] = store.shown("position")[which], self._whole[group[which]]
        return rows, np.where(which & ~self._whole[group], mass, 0.0)

    def _pull(self, columns: np.ndarray) -> np.ndarray:
        """All pulls on some columns, m/s² (dim, n)."""
        store = self.store
        names = (name for name in (ATTRACTION.name, WHOLE_ATTRACTION.name) if name in store)
        return sum(store.data[np.ix_(store.rows[name], columns)] for name in names)

    def _catch_up(self, dt: float, columns: np.ndarray, more: np.ndarray) -> None:
        """Let solids in a fluid, which have made a step of ``dt`` s under the old pull, have half of what is
        ``more`` in the new one: the mean of both, as all else gets."""
        store = self.store
        for name, share in (("velocity", 0.5 * dt), ("acceleration", 1.0)):
            store.data[np.ix_(store.rows[name], columns)] += share * more

    def bytes_held(self) -> int:
        """Bytes of all masses."""
        return self._held


@compiled
def attract(first, last, masses, attracted, group, position, pull, energy):
    """a = −G Σ_j m_j g x_ij and ½φ = −½G Σ_j m_j f of the columns ``first`` to ``last`` whose ``group`` is
    ``attracted``, with themselves: a vector of no length, and an energy that is always the same."""
    begin, end = np.uint64(0), np.uint64(len(masses.mass))
    for k in range(np.uint64(first), np.uint64(last)):
        if not attracted[group[k]]:
            continue
        x = at(position, k)
        sums = spread((0.0, 0.0, 0.0), masses.mass)
        held = spread(0.0, masses.mass)
        for n in range(begin, end, width_of(masses.mass)):
            a, b, c = masses.places
            there = consecutive(a, n), consecutive(b, n), consecutive(c, n)
            away = subtract(there, x)
            g, f = softened(np.sqrt(dot(away, away)), masses.reach)
            m = consecutive(masses.mass, n)
            sums = add(sums, scale(away, m * g))
            held = held + m * f
        put(pull, k, scale(total(sums), masses.factor))
        energy[k] = -0.5 * masses.factor * total(held)
