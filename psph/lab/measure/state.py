"""The particles of a stored frame, as gauges see those of a run."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from psph.composition.reflections import moved
from psph.fields import CROSSED, OF_MATERIAL, REFERENCE, WALL
from psph.lab.errors import MeasureError
from psph.output.gauges.fit import nearest
from psph.output.ledger import Ledger
from psph.output.probes import WET_MARK
from psph.output.reader import Run
from psph.parallel.reductions import alone
from psph.particles.store import Store
from psph.simulation.cpu import Engine
from psph.simulation.filling import block_of
from psph.simulation.plan import Plan

ALWAYS = ("specific_volume", *(field.name for field in OF_MATERIAL))
"""What follows from a frame and the case."""


STORE = """--set 'output.fields=["{}"]'"""
"""How frames come to hold a field."""


NEEDED = ("id", "group", "kind", "position", "density")
"""What every frame has to hold."""


class StoredState:
    """A frame of a ``run`` in the place of a simulation: what gauges ask of one (psph.output.gauges).

    ``scene`` and ``plan`` are those of the run, with the gauges that are asked for.  All particles are on
    this rank.  What frames do not hold is refused when it is asked for, in one line.  Places at the start,
    which solids are measured from, are those of the first frame.
    """

    def __init__(self, run: Run, scene, plan: Plan):
        self.run, self.scene, self.plan, self.comm = run, scene, plan, alone()
        self._all = Store(scene.dimensions, plan.stored, plan.constants, plan.view, plan.materials.kinds)
        self.engine = Engine(scene, plan, self._all, self.comm, Ledger())
        self.domain, self.neighbourhood = self.engine.domain, _Everywhere(self)
        self.doubtful = np.zeros((0, scene.dimensions))
        """Where walls are of which the frame does not tell whether they are wet, m (n, dim)."""
        self.store: Any = self._all
        self.time = self.dt = 0.0
        self._poses = run.poses()
        self._bonded = np.zeros(len(plan.materials.kinds), bool)
        parts = scene.layout.parts
        self._bonded[[part.number for part in parts if parts[part.whole].keeps_neighbours]] = True
        self._from_the_start = len(run.times) and run.times[0] == 0.0
        self._start: tuple[np.ndarray, np.ndarray] | None = None

    def show(self, number: int, time: float) -> None:
        """Turn to the frame of this ``number`` and ``time``, s."""
        frame, self.time = self.run.frame(number), time
        if lacking := [name for name in NEEDED if name not in frame]:
            raise MeasureError(
                f"{self.run.path}: frame {number} holds no {lacking[0]}, without which nothing can be read"
            )
        s = self._all
        s.low = s.owned = s.high = 0
        density, group = frame["density"], frame["group"]
        seen = (frame["position"], frame.get("velocity", np.zeros_like(frame["position"])), density)
        s.append(frame["id"], group, block_of(self.scene, self.plan.materials, s, group, *seen))
        held = {name: rows for name, rows in frame.items() if name in s.rows}
        if REFERENCE.name in s.rows and REFERENCE.name not in held and self._from_the_start:
            held[REFERENCE.name] = self._starts(frame["id"])
        if self.plan.sizes is not None and self.plan.sizes.length not in held:
            held[self.plan.sizes.length] = self._lengths(self.plan.sizes.length, group, frame["position"])
        if not any(self.domain.periods):
            held[CROSSED.name] = np.zeros_like(frame["position"])
        if WET_MARK in s.rows and WET_MARK not in held:
            held[WET_MARK] = self._wet(frame)
        bonded = np.flatnonzero(self._bonded[group])
        if (
            len(bonded) and "pressure" in held
        ):  # what a fluid sees of it is not the pressure of its stress, which frames show
            self.engine.bear(s.low, s.low + s.owned, 0.0)
            held["pressure"][bonded] = s.shown("pressure")[bonded]
        for name, rows in held.items():
            if name in s.rows:
                s.data[list(s.rows[name]), s.inner] = rows.reshape(len(group), len(s.rows[name])).T
        s.data[list(s.rows["specific_volume"]), s.inner] = 1.0 / density
        self._place()
        self.store = HeldFields(s, {*held, *frame, *ALWAYS}, self.run)

    def _lengths(self, name: str, group: np.ndarray, position: np.ndarray) -> np.ndarray:
        """Smoothing lengths, m (n, 1), that frames do not hold, since they follow from what a particle is."""
        told = (kind.starts((name,), group, position) for kind in self.plan.matter)
        return next(value for found in told for key, value in found if key == name)

    def _starts(self, ids: np.ndarray) -> np.ndarray:
        """Where particles were in the first frame, m (n, dim); zeros where they came later."""
        if self._start is None:
            first = self.run.frame(0, "id", "position")
            order = np.argsort(first["id"])
            self._start = first["id"][order], first["position"][order]
        known, places = self._start
        row = np.minimum(np.searchsorted(known, ids), len(known) - 1)
        return np.where((known[row] == ids)[:, None], places[row], 0.0)

    def _wet(self, frame: Mapping[str, np.ndarray]) -> np.ndarray:
        """1 where a particle counts as wet (psph.physics.walls.dry), else 0 (n,).

        A wall that is dry has its rest density, to the bit; one that has it may also be wet, and just so.
        """
        group = frame["group"]
        rest = self.plan.materials.values("rest_density")[group]
        still = (frame["kind"] == WALL) & (frame["density"] == rest)
        self.doubtful = frame["position"][still]
        return (~still).astype(float)

    def _place(self) -> None:
        """What moves as a whole stands where it was at the time of the frame."""
        movers = [work for work in self.engine.kinds if work.rows]
        if movers:
            told = self._poses.get(self.time)
            if told is None:
                raise MeasureError(
                    f"{self.run.folder}: poses.csv has no line for the frame at {self.time:g} s: bodies and "
                    "paddles have no place there; run the case again with this psph"
                )
            self.dt, state = told
            for work in movers:
                work.restore(state)
        self.engine.poses.turn_to(self.time)


class HeldFields:
    """A store of which only the fields ``held`` are known: who asks for others is refused."""

    def __init__(self, store: Store, held: set[str], run: Run):
        self._store, self._held, self._run = store, held, run

    def __getattr__(self, name: str):
        return getattr(self._store, name)

    @property
    def rows(self) -> Mapping[str, range]:
        """The rows of each field, as those of the store."""
        return _HeldRows(self)

    def rows_of(self, name: str) -> range:
        """Those of one."""
        self._known(name)
        return self._store.rows[name]

    def __contains__(self, name: str) -> bool:
        return name in self._store and self._known(name)

    def __getitem__(self, name: str):
        self._known(name)
        return self._store[name]

    def shown(self, name: str) -> np.ndarray:
        """The values of a field, as of :meth:`psph.particles.store.Store.shown`."""
        self._known(name)
        return self._store.shown(name)

    def _known(self, name: str) -> bool:
        if name in self._store.rows and name not in self._held:
            raise MeasureError(
                f"{self._run.path}: frames hold no {name}; a run stores it with {STORE.format(name)}"
            )
        return True


class _HeldRows(dict):
    """The rows of fields, each refused where it is not known."""

    def __init__(self, held: HeldFields):
        self._held = held

    def __getitem__(self, name: str) -> range:
        return self._held.rows_of(name)


class _Everywhere:
    """In the place of the neighbourhood: nothing is sorted, so a point may see every column."""

    def __init__(self, state: StoredState):
        self._state = state

    @property
    def reach(self) -> float:
        """How far a point sees particles, m, at the most."""
        plan, store = self._state.plan, self._state.store
        if plan.sizes is None:
            return plan.kernel.support / plan.kernel.inverse_h
        return plan.sizes.support * float(store[plan.sizes.length][store.inner].max(initial=0.0))

    @property
    def mirrors(self):
        """Where they stand."""
        plan = self._state.plan
        return plan.mirrors and moved(plan.mirrors, [one.then(self._state.time) for one in plan.planes])

    def columns_near(self, point, radius: float) -> tuple[int, int]:
        """The first column, and that after the last; refused where doubtful walls are within ``radius`` m."""
        state = self._state
        away = nearest(state.doubtful - np.array(point), state.domain.periods)
        if ((away**2).sum(axis=1) < radius**2).any():
            where = ", ".join(f"{x:g}" for x in point)
            raise MeasureError(
                f"{state.run.path}: frames hold no {WET_MARK}, and walls near ({where}) may be wet or dry; "
                f"a run stores it with {STORE.format(WET_MARK)}"
            )
        return self.columns_across(0.0, radius)

    def columns_across(self, place: float, reach: float) -> tuple[int, int]:
        """The first column, and that after the last: of all, wherever they are along the slab axis."""
        store = self._state.store
        return store.low, store.low + store.owned
