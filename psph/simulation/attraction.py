"""Self-gravity on a rank: all masses of the scene on every rank, in the order of the particles' numbers,
and the pulls on its own particles by the direct sum or by a tree (psph.simulation.direct_sum,
psph.simulation.tree_sum)."""

import numpy as np

from psph.kinds import count_of
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
    takes_tree,
)
from psph.simulation.direct_sum import DirectSum
from psph.simulation.masses import ID, MASS, OLD, PLACE, SIZE, WHOLE, WIDTH, Pulled
from psph.simulation.tree_sum import TreeSum
from psph.work import Rank, Work


class MutualPulls(Work):
    """The pulls on the particles of a ``rank``, by all of the scene; ``sizes`` says how far each reaches
    where that differs (psph.simulation.gas_deepening), else it is None."""

    name = "attraction"

    def __init__(self, rank: Rank, sizes):
        self.store, self.comm, self.ledger = rank.store, rank.domain.comm, rank.ledger
        told = rank.scene.case.physics.self_gravity
        self._factor = float(told.constant)
        self._sizes = sizes
        self._reach = None if self._sizes else REACH * float(told.softening)
        groups = rank.plan.materials
        self._whole = groups.where(lambda one: is_whole(one.motion))
        self._ahead = groups.where(lambda one: has_own_steps(one.motion))
        self._attracted = self._whole | self._ahead | groups.where(lambda one: is_free(one.motion))
        tree = takes_tree(told, count_of(rank.scene))
        self.sum = (
            TreeSum(self._factor, self._reach, float(told.accuracy))
            if tree
            else DirectSum(self._factor, self._reach)
        )
        self._held = 0

    def begin_sums(self, simulation) -> None:
        """The pulls at the start; twice where the sum rests on those of the step before.  Collective."""
        for _ in range(self.sum.turns_at_start):
            self.renew(simulation)

    def renew(self, simulation) -> None:
        """Both pulls where all particles stand at the end of a step; collective."""
        store = self.store
        with self.ledger("self-gravity"):
            own, mass = self._own(simulation.engine.kinds)
            rows = all_rows(self.comm, own)
            rows = rows[np.argsort(rows[:, ID])]
            ahead = store.low + np.flatnonzero(self._ahead[store.shown("group")])
            before, energy = self._pull(ahead), store[ATTRACTION_ENERGY.name]
            columns = store.low + np.flatnonzero(self._attracted[store.shown("group")])
            whole = store[WHOLE_ATTRACTION.name] if WHOLE_ATTRACTION.name in store else None
            pulled = Pulled(columns, own[:, ID], store["position"], store[ATTRACTION.name], whole, energy)
            self._held = 2 * rows.nbytes + self.sum.renew(rows, pulled)
            reach = self._sizes.reach(store.inner) if self._sizes else self._reach
            energy[store.inner] += 0.5 * self._factor * REACH / reach * mass  # that with itself
            if self._sizes:
                self._sizes.renew()
            self._catch_up(simulation.dt, ahead, self._pull(ahead) - before)

    def _own(self, kinds) -> tuple[np.ndarray, np.ndarray]:
        """The rows of this rank's particles that attract (n, WIDTH), and of all of its particles the mass
        with which they do so without moving as a whole; the works of ``kinds`` know some masses."""
        store = self.store
        group, mass = store.shown("group"), true_mass(store)
        for kind in kinds:
            kind.weigh(store, mass)
        which = self._attracted[group]
        rows = np.empty((int(which.sum()), WIDTH + bool(self._sizes)))
        rows[:, ID], rows[:, MASS] = store.shown("id")[which], mass[which]
        rows[:, PLACE], rows[:, WHOLE] = store.shown("position")[which], self._whole[group[which]]
        rows[:, OLD] = np.sqrt((self._pull(store.low + np.flatnonzero(which)) ** 2).sum(axis=0))
        if self._sizes:
            rows[:, SIZE] = self._sizes.reach(store.inner)[which]
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
        """Bytes of all masses, and of the tree."""
        return self._held
