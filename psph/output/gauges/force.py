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
        store, shares = simulation.store, self.corners.shares(simulation)
        group, ids = store.shown("group"), store.shown("id")
        rows = np.flatnonzero(store.of_groups(shares.groups))
        place = np.searchsorted(shares.ids, ids[rows]) % max(len(shares.ids), 1)
        known = shares.ids[place] == ids[rows]
        rows, place = rows[known], place[known]
        force = store.shown("mass")[rows, None] * store.shown("load")[rows]
        axes = axes_of(simulation)[group[rows]]
        own, share = store.of_groups(self.groups)[rows], np.zeros_like(force)
        for axis in range(store.dimensions):
            along = (force * axes[:, :, axis]).sum(axis=1)
            bearer = shares.bearers[place, axis, (along < 0.0).astype(int)]
            won = np.isin(bearer, self.groups).astype(float) - own
            share += (won * along)[:, None] * axes[:, :, axis]
        beside, passed = self._passed(store, shares.seams)
        return np.concatenate([rows, beside]), np.concatenate([share, passed])

    def _passed(self, store, seams) -> tuple[np.ndarray, np.ndarray]:
        """Rows of the particles beside seams of parts in one plane, and what these parts win by each, N."""
        ids = store.shown("id")
        here = np.flatnonzero(np.isin(ids, seams.ids))
        here = here[np.argsort(ids[here])]
        force = store.shown("mass")[here, None] * store.shown("load")[here]
        told, share = seams.won(ids[here], force, self.groups)
        return here[told], share

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
