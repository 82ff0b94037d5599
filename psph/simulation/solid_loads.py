"""The loads of a case on its solids: what each particle gets of them, and the work that they do."""

import numpy as np

from psph.engine.jit import elementwise
from psph.engine.settled import settled
from psph.engine.threads import in_threads
from psph.parallel.reductions import whole_sums
from psph.physics.motion import WORK
from psph.physics.solid.deformation import DRAWN, PULLED, PUSHED
from psph.scene.lattice import TOLERANCE
from psph.scene.shapes import inside
from psph.scene.solid_areas import faced
from psph.simulation.solid_pairs import Following
from psph.vectors import at, dot


class SolidLoads:
    """The loads of a ``scene`` on a rank's share of its solids, among the particles of ``store``."""

    def __init__(self, scene, store, comm):
        self.scene, self.store, self.comm = scene, store, comm
        self._tables = tuple(scene.case.solids.values())
        self._rises = np.array([table.load_rise for table in self._tables])
        self._book = settled(book)
        self.share(0.0)

    def draw(self, columns: np.ndarray, solid: np.ndarray) -> None:
        """What they give each particle at their full size; the particles at ``columns`` belong to the
        solids of these numbers; collective."""
        store, scene = self.store, self.scene
        places = np.stack([x[columns] for x in store["reference"]], axis=1)
        for number, table in enumerate(self._tables):
            volume = (scene.spacing / table.finer(scene.spacing)) ** scene.dimensions
            for load in table.loads.values():
                if load.pressure is None:
                    pulled = inside(load.shape, [*places.T], TOLERANCE * scene.spacing) & (solid == number)
                    [count] = whole_sums(self.comm, [np.count_nonzero(pulled)])
                    pull = np.array(load.force) / (max(count, 1) * volume * table.density)
                    self._add(DRAWN if PULLED.name not in store else PULLED, columns[pulled], pull)
                else:
                    own, part = solid == number, scene.layout.parts.solids[number]
                    area = faced(scene.layout, part, load, places[own])
                    self._add(PUSHED, columns[own], -load.pressure / (volume * table.density) * area)

    def _add(self, field, columns: np.ndarray, more: np.ndarray) -> None:
        for of, value in zip(self.store[field.name], np.broadcast_to(more, (len(columns), len(more.T))).T):
            of[columns] += value

    def following(self, columns: np.ndarray) -> Following | None:
        """What lets pressures follow the faces of rows at ``columns``; None where no load is one."""
        if PUSHED.name not in self.store:
            return None
        return Following(columns, *(self.store[field.name] for field in (PULLED, PUSHED, DRAWN)))

    def share(self, time: float) -> np.ndarray:
        """The part of the loads of each solid that acts from now on, at ``time``, s."""
        with np.errstate(divide="ignore", invalid="ignore"):
            self.acting = np.where(self._rises > 0.0, np.minimum(time / self._rises, 1.0), 1.0)
        return self.acting

    def book(self, dt: float, columns: np.ndarray, solid: np.ndarray, mass: np.ndarray) -> None:
        """Half of the work of a step of ``dt`` s, on particles of these true masses, kg: by the forces that
        act, once before they change and once after, as the kicks there have it."""
        arrays = (self.store[name] for name in (DRAWN.name, "velocity", WORK.name))
        if len(columns) and dt > 0.0:
            in_threads(self._book, 0, len(columns), columns, 0.5 * dt, mass * self.acting[solid], *arrays)


@elementwise
def book(first, last, columns, dt, mass, drawn, velocity, work):
    """Add m a·v Δt, J, with the acceleration a ``drawn`` by loads and the velocity v of the drift."""
    for k in range(np.uint64(first), np.uint64(last)):
        c = columns[k]
        work[c] += dt * mass[k] * dot(at(drawn, c), at(velocity, c))
