"""The loads of a case on its solids: what each particle gets of them, and the work that they do."""

import numpy as np

from psph.engine.jit import elementwise
from psph.engine.settled import settled
from psph.engine.threads import in_threads
from psph.parallel.reductions import whole_sums
from psph.physics.motion import WORK
from psph.physics.solid.deformation import DRAWN
from psph.scene.lattice import TOLERANCE
from psph.scene.shapes import inside
from psph.vectors import at, dot


class SolidLoads:
    """The loads of a ``scene`` on a rank's share of its solids, among the particles of ``store``."""

    def __init__(self, scene, store, comm):
        self.scene, self.store, self.comm = scene, store, comm
        self._tables = tuple(scene.case.solids.values())
        self._rises = np.array([table.load_rise for table in self._tables])
        self._book = settled(book)

    def draw(self, columns: np.ndarray, solid: np.ndarray) -> None:
        """What they give each particle at their full size; the particles at ``columns`` belong to the
        solids of these numbers; collective."""
        store, scene = self.store, self.scene
        grid = [x[columns] for x in store["reference"]]
        for number, table in enumerate(self._tables):
            volume = (scene.spacing / table.finer(scene.spacing)) ** scene.dimensions
            for load in table.loads.values():
                pulled = inside(load.shape, grid, TOLERANCE * scene.spacing) & (solid == number)
                [count] = whole_sums(self.comm, [np.count_nonzero(pulled)])
                mass = max(count, 1) * volume * table.density
                for of, force in zip(store[DRAWN.name], load.force):
                    of[columns[pulled]] += force / mass

    def share(self, time: float) -> np.ndarray:
        """The part of the loads of each solid that acts at ``time``, s."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(self._rises > 0.0, np.minimum(time / self._rises, 1.0), 1.0)

    def book(self, time: float, dt: float, columns: np.ndarray, solid: np.ndarray, mass: np.ndarray) -> None:
        """The work that they have done on the way of ``dt`` s to ``time``, on particles of these true masses,
        kg: by the mean of the forces at both ends, as the kicks there have it."""
        mean = 0.5 * (self.share(time - dt) + self.share(time))
        arrays = (self.store[name] for name in (DRAWN.name, "velocity", WORK.name))
        if len(columns):
            in_threads(self._book, 0, len(columns), columns, dt, mass * mean[solid], *arrays)


@elementwise
def book(first, last, columns, dt, mass, drawn, velocity, work):
    """Add m a·v Δt, J, with the acceleration a ``drawn`` by loads and the velocity v of the drift."""
    for k in range(np.uint64(first), np.uint64(last)):
        c = columns[k]
        work[c] += dt * mass[k] * dot(at(drawn, c), at(velocity, c))
