"""Force and moment of the fluid on walls."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from psph.output.gauges.carried import Carrier
from psph.output.gauges.corners import Corners, axes_of
from psph.output.gauges.displacement import gone
from psph.parallel.reductions import exact_sums
from psph.physics.motion import COUPLE, RIGID


class ForceGauge(NamedTuple):
    """Force and moment of the fluid on the walls of some ``groups``.

    F = Σ_w m_w a_w and T = Σ_w m_w [(x_w − X) × a_w + c_w] over their particles, with the accelerations a_w
    by their neighbours in the fluid alone, without gravity, and the couples c_w of a viscous fluid
    (psph.composition.loads): what the fluid feels of these particles, turned round.  Those of bodies have
    their contacts too.  Where parts meet, ``corners`` say whose face bears it.  X is ``about``, m (dim,),
    with a ``carrier`` the place at the start of a point that goes with it.  N and N m; per metre of depth in
    2D.  Where a domain repeats, what moves is where its way has led it, also beyond the domain: moments have
    no jump there.
    """

    name: str
    every: float
    groups: tuple[int, ...]
    about: tuple[float, ...]
    corners: Corners
    carrier: Carrier | None = None

    def columns(self, scene) -> list[str]:
        """Their names, without the time: ``drag.force_x``, ``drag.moment_z``."""
        forces = [f"{self.name}.force_{axis}" for axis in "xyz"[: scene.dimensions]]
        return [*forces, *(f"{self.name}.moment_{axis}" for axis in turns(scene.dimensions))]

    def row(self, simulation) -> np.ndarray:
        """The values, the same on every rank."""
        store = simulation.store
        held = np.flatnonzero(store.of_groups(self.groups))
        force = store.shown("mass")[held, None] * store.shown("load")[held]
        shared, share = self._shared(simulation)
        bearing, held, force = held, np.concatenate([held, shared]), np.concatenate([force, share])
        about = np.array([self.about])
        if self.carrier is not None:
            about = self.carrier.places(simulation, about)
        twist = [*moments(self._places(simulation, held) - about, force)]
        if COUPLE.name in store:
            couples = store.shown("mass")[bearing, None] * store.shown(COUPLE.name)[bearing]
            for of_all, own in zip(twist, couples.T):
                of_all[: len(bearing)] += own
        total = exact_sums(simulation.comm, np.column_stack([force, *twist]))
        d = store.dimensions
        turned = ["xyz".index(axis) for axis in turns(d)]
        for work in simulation.engine.kinds:
            if pushing := work.pushing(self.groups, about[0]):
                total = total + np.concatenate([pushing[0][:d], pushing[1][turned]])
        return total

    def _shared(self, simulation) -> tuple[np.ndarray, np.ndarray]:
        """Rows of the particles in whose load another part has a share, and what these parts win of it, or
        lose where it is their own, N (n, dim)."""
        store, held = simulation.store, self.corners.sharers(simulation)
        rows, mass, load = held.rows, store.shown("mass"), store.shown("load")
        force = mass[rows, None] * load[rows]
        group = store.shown("group")[rows]
        axes, own = axes_of(simulation)[group], np.zeros(len(store.kinds))
        own[list(self.groups)] = 1.0
        share = np.zeros_like(force)
        for axis in range(store.dimensions):
            along = (force * axes[:, :, axis]).sum(axis=1)
            bearer = held.shares.bearers[held.place, axis, (along < 0.0).astype(int)]
            share += ((own[bearer] - own[group]) * along)[:, None] * axes[:, :, axis]
        beside = held.beside
        pushed = mass[beside, None] * load[beside]
        told, passed = held.shares.seams.won(store.shown("id")[beside], pushed, self.groups)
        return np.concatenate([rows, beside[told]]), np.concatenate([share, passed])

    def _places(self, simulation, held: np.ndarray) -> np.ndarray:
        """Where the particles ``held`` are, m (n, dim): those that move as one beside each other."""
        store, domain = simulation.store, simulation.domain
        places = gone(simulation, held)
        groups, plan = store.shown("group")[held], simulation.plan
        rigid = plan.materials.motion_of[groups] == RIGID
        for row in np.unique(plan.materials.pose_of[groups[rigid]]):
            own = rigid & (plan.materials.pose_of[groups] == row)
            places[own] = simulation.engine.poses.beside(row, places[own], domain.periods)
        return places


def turns(dimensions: int) -> str:
    """The axes about which something can turn."""
    return ("", "z", "xyz")[dimensions - 1]


def moments(arm: np.ndarray, force: np.ndarray) -> Iterator[np.ndarray]:
    """Components of arm × force, each (n,), of arms and forces (n, dim)."""
    for axis in turns(arm.shape[1]):
        a, b = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
        yield arm[:, a] * force[:, b] - arm[:, b] * force[:, a]
