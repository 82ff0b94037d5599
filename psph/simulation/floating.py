"""The rigid bodies of a simulation: what pushes them, and the maps that place their particles."""

import numpy as np

from psph.parallel.reductions import whole_sums
from psph.physics.rigid.bodies import Bodies, RigidBody, crossing
from psph.physics.rigid.lines import pulls
from psph.scene.bodies import lines_of, shares_of
from psph.simulation.touching import Contacts

BITS = 58
"""Of whole numbers of 64 bits, for a push of ρ₀c², or of the modulus of a solid, on all particles of bodies:
room for sixteen times that."""


class Floating:
    """The bodies of a scene among the rigid motions of its ``plan``.

    ``rows`` are their places there and ``bodies`` their state (psph.physics.rigid.bodies), the same on
    every rank: the fluid's pushes are added as whole numbers, so that they do not depend on how
    particles are spread, in ``units`` of N and N m.  ``body_of`` has the row of each group's body, −1 without
    one; ``tensions`` are those of their lines, N; ``masses`` share the mass of each body among its particles
    (psph.scene.bodies.shares_of), where body forces ask for that.
    """

    def __init__(self, scene, plan):
        self.rows = [row for row, motion in enumerate(plan.rigid) if isinstance(motion, RigidBody)]
        own = [plan.rigid[row] for row in self.rows]
        self.bodies, self._dimensions = Bodies(own, plan.pulls.uniform), scene.dimensions
        self.masses = shares_of(scene) if plan.pulls.bodies else None
        self.lines = lines_of(scene, [one.name for one in own])
        self.tensions = np.zeros(len(self.lines))
        self.body_of = np.full(len(scene.species), -1)
        for group, one in enumerate(scene.species):
            if isinstance(one.motion, RigidBody):
                self.body_of[group] = own.index(one.motion)
        pressure = max(one.density for one in scene.species) * scene.sound_speed**2
        pressure = max(pressure, *(one.wave_modulus for one in scene.species))
        count = int(scene.census.sizes[list(scene.layout.parts.bodies)].sum())
        units = 2.0 ** (BITS - count.bit_length())
        force = pressure * scene.spacing ** (scene.dimensions - 1) / units
        self.units = (force, force * max(up - low for low, up in zip(scene.layout.lower, scene.layout.upper)))
        self._scene, self._plan = scene, plan
        self.contacts: Contacts | None = None

    def meet_in(self, maps: np.ndarray) -> None:
        """Look for contacts where the ``maps`` of all rigid motions have bodies and walls."""
        self.contacts = Contacts(self._scene, self._plan, self.rows, maps)

    def drift(self, time: float, dt: float) -> None:
        """The first half of a kick, and the way to ``time``, s, with contacts."""
        self.bodies.drift(time, dt, self.contacts)

    def kick(self, time: float, dt: float) -> None:
        """The second half of the kick."""
        self.bodies.kick(time, dt, self.contacts)

    def maps(self) -> np.ndarray:
        """The affine maps of each body, as psph.physics.rigid.pose.maps: (n, 3, dim, 1 + dim)."""
        b, d = self.bodies, self._dimensions
        whirl, bend = crossing(b.spin_ahead), crossing(b.angular_acceleration)
        linear = np.stack([b.turn, whirl @ b.turn, (bend + whirl @ whirl) @ b.turn], axis=1)
        starts = np.stack([b.place, b.ahead, b.acceleration], axis=1)
        found = np.empty((len(b.place), 3, d, 1 + d))
        found[..., 0] = (starts - np.einsum("nwde,ne->nwd", linear, b.reference))[:, :, :d]
        found[..., 1:] = linear[:, :, :d, :d]
        return found

    def load(self, pushes: np.ndarray, comm) -> None:
        """The forces at the end of the step: those on the particles of this rank, ``pushes`` in whole
        numbers of :attr:`units` (psph.physics.rigid.pushes), those of lines, and uniform pulls;
        collective."""
        total = whole_sums(comm, pushes).astype(np.float64)
        pull, twist, self.tensions = pulls(self.lines, self.bodies)
        self.bodies.load(total[:, :3] * self.units[0] + pull, total[:, 3:] * self.units[1] + twist)
