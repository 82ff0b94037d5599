"""The rigid bodies of a simulation: what pushes them, and the maps that place their particles."""

import numpy as np

from psph.case.bodies import SLIDES
from psph.parallel.reductions import whole_sums
from psph.physics.rigid.bodies import Bodies, Body
from psph.physics.rigid.lines import pulls
from psph.scene.bodies import lines_of

BITS = 58
"""Of whole numbers of 64 bits, for a push of ρ₀c² on all particles of bodies: room for sixteen times that."""


class Floating:
    """The bodies of a scene among the rigid motions of its ``plan``.

    ``rows`` are their places there and ``bodies`` their state (psph.physics.rigid.bodies), the same on
    every rank: the fluid's pushes are added as whole numbers, so that they do not depend on how
    particles are spread. ``tensions`` of their lines, N.
    """

    def __init__(self, scene, plan):
        self.rows = [row for row, motion in enumerate(plan.rigid) if isinstance(motion, Body)]
        own = [plan.rigid[row] for row in self.rows]
        self.bodies, self._dimensions = Bodies(own, scene.gravity), scene.dimensions
        self.lines = lines_of(scene, [one.name for one in own])
        self.tensions = np.zeros(len(self.lines))
        self._body_of = np.full(len(scene.species), -1)
        for group, one in enumerate(scene.species):
            if isinstance(one.motion, Body):
                self._body_of[group] = own.index(one.motion)
        pressure = max(one.density for one in scene.species) * scene.sound_speed**2
        count = int(scene.census.sizes[scene.layout.first_body :].sum())
        units = 2.0 ** (BITS - count.bit_length())
        self._force_unit = pressure * scene.spacing ** (scene.dimensions - 1) / units
        length = max(up - low for low, up in zip(scene.lower, scene.upper))
        self._torque_unit = self._force_unit * length

    def maps(self) -> np.ndarray:
        """The affine maps of each body, as psph.physics.rigid.pose.maps: (n, 3, dim, 1 + dim)."""
        b, d = self.bodies, self._dimensions
        whirl, bend = _crossing(b.spin_ahead), _crossing(b.angular_acceleration)
        linear = np.stack([b.turn, whirl @ b.turn, (bend + whirl @ whirl) @ b.turn], axis=1)
        starts = np.stack([b.place, b.ahead, b.acceleration], axis=1)
        found = np.empty((len(b.place), 3, d, 1 + d))
        found[..., 0] = (starts - np.einsum("nwde,ne->nwd", linear, b.reference))[:, :, :d]
        found[..., 1:] = linear[:, :, :d, :d]
        return found

    def load(self, store, domain) -> None:
        """The forces at the end of the step: those of the fluid, of lines, and the weight; collective."""
        force, torque = self._by_fluid(store, domain)
        pull, twist, self.tensions = pulls(self.lines, self.bodies)
        self.bodies.load(force + pull, torque + twist)

    def _by_fluid(self, store, domain) -> tuple[np.ndarray, np.ndarray]:
        """F = Σ m_w a_w and T = Σ (x_w − X) × m_w a_w over the particles of each body, with
        accelerations by the fluid alone: N and N m (n, 3)."""
        n, d = len(self.rows), self._dimensions
        body = self._body_of[store.shown("group")]
        pushed = (body >= 0) & np.logical_or.reduce(store.shown("load") != 0.0, axis=1)
        body, force = body[pushed], np.zeros((np.count_nonzero(pushed), len(SLIDES)))
        force[:, :d] = store.shown("mass")[pushed, None] * store.shown("load")[pushed]
        arm = np.zeros_like(force)
        arm[:, :d] = store.shown("position")[pushed] - self.bodies.place[body, :d]
        for axis, period in enumerate(domain.periods):
            if period is not None:
                arm[:, axis] -= period * np.rint(arm[:, axis] / period)
        terms = np.concatenate([force / self._force_unit, np.cross(arm, force) / self._torque_unit], axis=1)
        found = np.zeros((n, 6), np.int64)
        np.add.at(found, body, np.rint(terms).astype(np.int64))
        total = whole_sums(domain.comm, found).astype(np.float64)
        return total[:, :3] * self._force_unit, total[:, 3:] * self._torque_unit


def _crossing(a: np.ndarray) -> np.ndarray:
    """The matrices [a] with [a] r = a × r, of vectors (n, 3)."""
    found = np.zeros((len(a), 3, 3))
    for d, (e, f) in enumerate(((1, 2), (2, 0), (0, 1))):
        found[:, e, f], found[:, f, e] = -a[:, d], a[:, d]
    return found
