"""What elastic solids press that moves as a whole, bodies and walls: its faces, and its moment."""

import numpy as np

from psph.composition.loads import cross
from psph.composition.pair import take
from psph.engine.jit import elementwise
from psph.engine.settled import settled
from psph.engine.threads import in_threads
from psph.fields import WALL
from psph.physics.motion import ANCHOR, COUPLE, LOAD, WORK, is_rigid
from psph.physics.rigid.mapped import linear
from psph.physics.rigid.pose import PLACE, VELOCITY
from psph.physics.solid.contact import FACE, FACE_RATE, MET, TURNING
from psph.scene.faces import drawn_faces
from psph.simulation.solid_plan import solid_plan
from psph.vectors import add, at, dot, put, scale, subtract
from psph.work import Work


class Pressed(Work):
    """The particles near the faces of the bodies and the moving walls of a ``scene``, in a rank's ``store``.

    The normal N of a face turns with it, by the ``maps`` of all rigid motions.  The energy U of contacts
    depends on N: beside Σ f it does Σ N × T to a body, T = −∂U/∂N, so that what it turns, and what turns on
    the other side, keep their angular momentum.
    """

    def __init__(self, scene, plan, store):
        self._scene, self._plan, self._store, self._solids = scene, plan, store, solid_plan(plan)
        self._own = plan.materials.where(lambda one: one.kind == WALL and is_rigid(one.motion))
        self._carry, self._twist, self._load = settled(carry), settled(twist), settled(load)

    def meet(self, maps: np.ndarray) -> None:
        """The ``maps`` of all rigid motions turn the faces."""
        self._maps = maps

    def settle(self) -> None:
        """Their columns, and the faces as they were drawn."""
        s = self._store
        columns = s.low + np.flatnonzero(self._own[s.group[s.inner]])
        self._whole = columns.astype(np.uint64)
        place = np.stack([of[columns] for of in s[ANCHOR.name]], axis=1)
        normal, _ = drawn_faces(self._scene.layout, s.group[columns], place)
        known = (normal != 0.0).any(axis=1)
        self._columns = columns[known].astype(np.uint64)
        self._drawn = tuple(np.ascontiguousarray(normal[known].T))

    def begin(self) -> None:
        """In a fluid contacts are summed before the passes of all."""
        if self._solids.immersed:
            self._turn(0.0)

    def advance(self, time: float, dt: float, largest_speed: float) -> None:
        """The same after a drift."""
        if self._solids.immersed and dt > 0.0:
            self._turn(dt)

    def before_sums(self, dt: float) -> None:
        """Where solids are alone the pass of all sums contacts."""
        if self._solids.alone:
            self._turn(dt)

    def _turn(self, dt: float) -> None:
        """Where the faces are now, ``dt`` s after they were carried last."""
        s = self._store
        rate = s[FACE_RATE.name] if FACE_RATE.name in s else None
        self._each(self._carry, s[FACE.name], rate, 1.0 / dt if dt > 0.0 else 0.0)

    def after_sums(self, time: float, dt: float) -> None:
        """The moment of contacts by the normals, and the work that they do so in a step of ``dt`` s."""
        s = self._store
        couple = s[COUPLE.name] if COUPLE.name in s else None
        if self._solids.immersed:
            in_threads(self._load, 0, len(self._whole), self._whole, s[MET.name], s[LOAD.name])
        self._each(
            self._twist,
            s[FACE.name],
            s[TURNING.name],
            s.view(),
            couple,
            self._solids.immersed,
            s[WORK.name],
            dt,
        )

    def _each(self, loop, *args) -> None:
        told = self._columns, self._store.group, self._plan.materials.pose_of, self._maps, self._drawn
        in_threads(loop, 0, len(self._columns), *told, *args)


@elementwise
def carry(first, last, columns, group, pose_of, maps, drawn, now, rate, per):
    """The normals R N₀ of the rows ``first`` to ``last``, ``drawn`` N₀, as they are ``now``; their ``rate``
    in 1/s, if it is asked for, with the time 1/``per`` s since then."""
    for k in range(np.uint64(first), np.uint64(last)):
        c, normal = columns[k], at(drawn, k)
        normal = linear(maps[pose_of[group[c]]], PLACE, normal)
        if rate is not None:
            put(rate, c, scale(subtract(normal, at(now, c)), per))
        put(now, c, normal)


@elementwise
def twist(first, last, columns, group, pose_of, maps, drawn, face, turning, view, couple, wet, work, dt):
    """N × T of the rows ``first`` to ``last`` by the mass that each shows, and less T·Ṅ Δt of their work.

    In a fluid, where they are ``wet``, its couple is there already."""
    for k in range(np.uint64(first), np.uint64(last)):
        c = columns[k]
        normal, turn = at(face, c), at(turning, c)
        if couple is not None:
            own = scale(cross(normal, turn, normal), 1.0 / take(view, c).mass)
            put(couple, c, add(at(couple, c), own) if wet else own)
        rate = linear(maps[pose_of[group[c]]], VELOCITY, at(drawn, k))
        work[c] -= dt * dot(turn, rate)


@elementwise
def load(first, last, columns, met, load):
    """Add what contacts do to particles, m/s², to what the fluid does."""
    for k in range(np.uint64(first), np.uint64(last)):
        c = columns[k]
        put(load, c, add(at(load, c), at(met, c)))
