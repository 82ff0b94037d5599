"""Force and moment of the fluid on walls."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from psph.parallel.reductions import exact_sums
from psph.physics.motion import RIGID


class ForceGauge(NamedTuple):
    """Force and moment of the fluid on the walls of some ``groups``.

    F = Σ_w m_w a_w and T = Σ_w (x_w − X) × m_w a_w over their particles, with the accelerations a_w by
    their neighbours in the fluid alone, without gravity: what the fluid feels of these particles,
    turned round.  Those of bodies have their contacts too.  X is ``about``, m (dim,).  N and N m; per metre
    of depth in 2D.  Where a domain repeats, what moves as a whole is where its way has led it, also beyond
    the domain: moments have no jump there.
    """

    name: str
    every: float
    groups: tuple[int, ...]
    about: tuple[float, ...]

    def columns(self, scene) -> list[str]:
        """Their names, without the time: ``drag.force_x``, ``drag.moment_z``."""
        forces = [f"{self.name}.force_{axis}" for axis in "xyz"[: scene.dimensions]]
        return [*forces, *(f"{self.name}.moment_{axis}" for axis in turns(scene.dimensions))]

    def row(self, simulation) -> np.ndarray:
        """The values, the same on every rank."""
        store = simulation.store
        held = np.isin(store.shown("group"), self.groups)
        force = store.shown("mass")[held, None] * store.shown("load")[held]
        arm = self._places(simulation, held) - np.array(self.about)
        found = exact_sums(simulation.comm, np.column_stack([force, *moments(arm, force)]))
        floating = simulation.engine.poses.floating
        return found + self._contacts(floating) if floating else found

    def _contacts(self, floating) -> np.ndarray:
        """Force and moment of the contacts of bodies among the groups."""
        bodies, d = floating.bodies, len(self.about)
        own = np.isin(np.arange(len(bodies.bodies)), floating.body_of[list(self.groups)])
        about = np.zeros(3)
        about[:d] = self.about
        twist = bodies.twisting + np.cross(bodies.place - about, bodies.pressing)
        turned = ["xyz".index(axis) for axis in turns(d)]
        return np.concatenate([bodies.pressing[own, :d].sum(axis=0), twist[own][:, turned].sum(axis=0)])

    def _places(self, simulation, held: np.ndarray) -> np.ndarray:
        """Where the particles ``held`` are, m (n, dim): those that move as one beside each other."""
        store, domain = simulation.store, simulation.domain
        places = domain.inside(store.shown("position")[held])
        groups, plan = store.shown("group")[held], simulation.plan
        rigid = plan.motion_of[groups] == RIGID
        for row in np.unique(plan.pose_of[groups[rigid]]):
            own = rigid & (plan.pose_of[groups] == row)
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
