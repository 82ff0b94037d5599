"""Force and moment that the supports of solids bear."""

from typing import NamedTuple

import numpy as np

from psph.case.solids import anvils_of
from psph.fields import SOLID
from psph.output.gauges.displacement import gone
from psph.output.gauges.force import moments, turns
from psph.parallel.reductions import exact_sums
from psph.physics.motion import ANCHOR, LOAD, RIGID
from psph.physics.rigid.pose import ACCELERATION
from psph.physics.solid.anvil import Anvils, pressed
from psph.physics.solid.deformation import INERTIA


class ReactionGauge(NamedTuple):
    """Force and moment that clamps, whose particles have the ``groups``, and anvils of the numbers ``planes``
    bear together.

    A clamp bears all that pulls on its particles, their weight, loads and a fluid among it, less what moves
    them: F = Σ m (a − A), with the acceleration a that they would have if they were free and A that of the
    clamp.  An anvil bears −Σ m a of what it does to particles (:class:`psph.physics.solid.anvil.Anvils`).
    Moments are about the point ``about``, m (dim,), of particles where their way has led them, also beyond a
    domain that repeats.  N and N m; per metre of depth in 2D.
    """

    name: str
    every: float
    groups: tuple[int, ...]
    planes: tuple[int, ...]
    about: tuple[float, ...]

    @classmethod
    def of(cls, scene, name: str, every: float, asked) -> "ReactionGauge":
        """That of a table of the case, by the keys of clamps and anvils."""
        held = (part.number for part in scene.layout.parts if part.of_another and part.key in asked.of)
        planes = (number for number, key in enumerate(anvils_of(scene.case)) if key in asked.of)
        return cls(name, every, tuple(held), tuple(planes), asked.about)

    def columns(self, scene) -> list[str]:
        """Their names, without the time: ``foot.reaction_x``, ``foot.reaction_moment_z``."""
        d = scene.dimensions
        named = [f"reaction_{axis}" for axis in "xyz"[:d]]
        named += [f"reaction_moment_{axis}" for axis in turns(d)]
        return [f"{self.name}.{one}" for one in named]

    def row(self, simulation) -> np.ndarray:
        """The values, the same on every rank."""
        parts = [self._on_clamps(simulation), *(self._on_anvil(simulation, k) for k in self.planes)]
        rows, force = (np.concatenate(of) for of in zip(*parts))
        arm = gone(simulation, rows) - np.array(self.about)
        return exact_sums(simulation.comm, np.column_stack([force, *moments(arm, force)]))

    def _on_clamps(self, simulation) -> tuple[np.ndarray, np.ndarray]:
        """Rows of the particles of clamps, and what each has to bear, N (n, dim)."""
        store = simulation.store
        rows = np.flatnonzero(store.of_groups(self.groups))
        pulled = store.shown("acceleration")[rows] - self._told(simulation, rows)
        force = _true_mass(store)[rows, None] * pulled
        if INERTIA.name in store:  # the solid stands in a fluid
            force += store.shown("mass")[rows, None] * store.shown(LOAD.name)[rows]
        return rows, force

    def _told(self, simulation, rows: np.ndarray) -> np.ndarray:
        """With what acceleration clamps that move carry the particles of these ``rows``, m/s² (n, dim)."""
        store, plan = simulation.store, simulation.plan
        group, told = store.shown("group")[rows], np.zeros((len(rows), store.dimensions))
        for number in self.groups:
            if plan.materials.motion_of[number] == RIGID:
                own = group == number
                place = simulation.engine.poses.maps[plan.materials.pose_of[number], ACCELERATION]
                anchors = store.shown(ANCHOR.name)[rows[own]]
                told[own] = place[:, 0] + anchors @ place[:, 1:].T
        return told

    def _on_anvil(self, simulation, number: int) -> tuple[np.ndarray, np.ndarray]:
        """Rows of the particles of solids, and with what each presses on an anvil, N (n, dim)."""
        store = simulation.store
        [anvils] = (one for one in simulation.plan.pulls.bonded if isinstance(one, Anvils))
        place, normal = anvils.planes[number]
        rows = np.flatnonzero(store.shown("kind") == SOLID)
        depth = pressed(anvils.half, tuple(store.shown("position")[rows].T), place, normal)
        return rows, -(_true_mass(store)[rows] * anvils.stiffness * depth)[:, None] * np.array(normal)


def _true_mass(store) -> np.ndarray:
    """Of each particle of a rank, kg (n,): that of a solid in a fluid is the fluid's elsewhere."""
    return store.shown(INERTIA.name if INERTIA.name in store else "mass")
