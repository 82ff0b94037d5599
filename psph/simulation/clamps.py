"""Clamps that move: where their particles stand, and the work that they do on their solids."""

import numpy as np

from psph.composition import terms
from psph.composition.pair import take
from psph.engine.jit import elementwise
from psph.engine.settled import settled
from psph.engine.threads import in_threads
from psph.physics.motion import ANCHOR, WORK
from psph.physics.rigid.mapped import affine
from psph.physics.rigid.pose import PLACE, VELOCITY, maps
from psph.simulation.solid_plan import solid_plan
from psph.vectors import at, dot, nearest_to, put, subtract


class Clamps:
    """The particles of a rank in the clamps of a ``scene`` that move, as they are told or with a body."""

    def __init__(self, scene, plan, store):
        self._plan, self._store, self._periods = plan, store, scene.layout.periods
        self._moves = solid_plan(plan).grips
        self._maps = np.zeros((len(plan.materials.rigid), 3, store.dimensions, 1 + store.dimensions))
        self._carry, self._book = settled(carry), settled(book)

    def settle(self, columns: np.ndarray, masses: np.ndarray) -> None:
        """Those among the ``columns`` of solids and their true ``masses``, kg, after these have changed."""
        own = self._moves[self._store.group[columns]]
        self._columns, self._masses = columns[own], masses[own]

    def carry(self, time: float) -> None:
        """Put them where they are at ``time``, s, within a step of the fluid."""
        store, plan = self._store, self._plan
        for row, motion in enumerate(plan.materials.rigid):
            self._maps[row] = maps(motion.pose(time), store.dimensions)
        names = ANCHOR.name, "position", "velocity", "predicted_velocity"
        arrays = (store[name] for name in names)
        self._each(self._carry, store.group, plan.materials.pose_of, self._maps, self._periods, *arrays)

    def book(self, dt: float) -> None:
        """The work that they have done in a step of ``dt`` s, by the forces at its end."""
        store = self._store
        arrays = (store[name] for name in ("velocity", "acceleration", WORK.name))
        self._each(self._book, dt, self._masses, self._plan.pulls.bonded, store.view(), *arrays)

    def _each(self, loop, *args) -> None:
        in_threads(loop, 0, len(self._columns), self._columns, *args)


@elementwise
def carry(first, last, columns, group, pose_of, poses, periods, anchor, position, velocity, predicted):
    """Put the particles of some ``columns`` where the ``poses`` of their groups have them."""
    for k in range(np.uint64(first), np.uint64(last)):
        c = columns[k]
        row, x_0 = pose_of[group[c]], at(anchor, c)
        v = affine(poses[row], VELOCITY, x_0)
        put(position, c, nearest_to(affine(poses[row], PLACE, x_0), at(position, c), periods))
        put(velocity, c, v)
        put(predicted, c, v)


@elementwise
def book(first, last, columns, dt, mass, effects, view, velocity, acceleration, work):
    """Add −m (a − g)·v Δt, J, where m a is what all forces would do and m g what comes from outside: the
    clamp holds against what the solid, and what touches it, pulls."""
    for k in range(np.uint64(first), np.uint64(last)):
        c = columns[k]
        pulled = subtract(at(acceleration, c), terms.body(effects, take(view, c)))
        work[c] -= dt * mass[k] * dot(pulled, at(velocity, c))
