"""The rigid bodies of a simulation: what pushes them, and the maps that place their particles."""

from collections.abc import Iterator, Sequence

import numpy as np

from psph.engine.settled import settled
from psph.fields import WALL
from psph.parallel.reductions import whole_sums
from psph.physics.motion import ANCHOR, carried_by
from psph.physics.rigid.bodies import Bodies, crossing
from psph.physics.rigid.body import RigidBody
from psph.physics.rigid.joints import Joints
from psph.physics.rigid.lines import Lines, Strung
from psph.physics.rigid.pushes import add_pushes
from psph.scene.bodies import shares_of
from psph.scene.joints import joints_of
from psph.scene.lines import lines_of
from psph.simulation.riders import Riders
from psph.simulation.solid_plan import solid_plan
from psph.simulation.touching import Contacts
from psph.work import Work

BITS = 58
"""Of whole numbers of 64 bits, for a push of ρ₀c², of the modulus of a solid, or of the strongest pull, on
all particles of bodies: room for sixteen times that."""


class FloatingBodies(Work):
    """The bodies of a scene among the rigid motions of its ``plan``.

    ``rows`` are their places there and ``bodies`` their state (psph.physics.rigid.bodies), the same on
    every rank: the fluid's pushes are added as whole numbers, so that they do not depend on how
    particles are spread, in ``units`` of N and N m.  ``body_of`` has the row of each group's body, −1 without
    one; ``lines`` pull them (psph.physics.rigid.lines), ``joints`` hold them together, None without any;
    ``masses`` share the mass of each body among its particles (psph.scene.bodies.shares_of), where body
    forces ask for that.
    """

    name = "bodies"
    encloses = False

    def __init__(self, scene, plan):
        self.rows = [row for row, motion in enumerate(plan.materials.rigid) if isinstance(motion, RigidBody)]
        own = [plan.materials.rigid[row] for row in self.rows]
        self.bodies, self._dimensions = Bodies(own, plan.pulls.uniform), scene.dimensions
        self.masses = shares_of(scene) if plan.pulls.whole else None
        self.lines = Lines(lines_of(scene, [one.name for one in own]), self.bodies)
        joined = joints_of(scene, [one.name for one in own])
        self.joints = Joints(joined, self.bodies) if joined else None
        self.body_of = np.full(len(plan.materials.species), -1)
        for group, one in enumerate(scene.species):
            if one.kind == WALL and isinstance(carried := carried_by(one.motion), RigidBody):
                self.body_of[group] = own.index(carried)
        pressure = max(one.density for one in scene.species) * scene.sound_speed**2
        pressure = max(pressure, *(one.wave_modulus for one in scene.species))
        count = int(scene.census.sizes[list(scene.layout.parts.bodies)].sum())
        units = 2.0 ** (BITS - count.bit_length())
        force = pressure * scene.spacing ** (scene.dimensions - 1)
        force = max(force, _strongest_pull(scene, plan.pulls.whole, own)) / units
        self.units = (force, force * max(up - low for low, up in zip(scene.layout.lower, scene.layout.upper)))
        self._scene, self._plan, self._push = scene, plan, settled(add_pushes)
        self._riders = Riders(plan, own) if solid_plan(plan).riding.any() else None
        self.contacts: Contacts | None = None

    def meet(self, maps: np.ndarray) -> None:
        """Look for contacts where the ``maps`` of all rigid motions have bodies and walls."""
        self.contacts = Contacts(self._scene, self._plan, self.rows, maps)

    def drift(self, time: float, dt: float) -> None:
        """The first half of a kick, and the way to ``time``, s, with contacts."""
        self.bodies.drift(time, dt, self.contacts, self.joints)

    def push(self, engine, time: float, dt: float) -> None:
        """The second half of the kick at ``time``, s, by body forces and the pushes that the last pass of the
        ``engine`` has summed; without a step ``dt`` these alone.  Collective."""
        of_each = self.body_of, self.bodies.place, self.units, engine.domain.periods
        of_each += self._plan.pulls.whole, self.masses
        parts = engine.each(self._push, *of_each, engine.view(0.0), engine.columns())
        pushes = sum(parts)
        if self._riders:
            told = self.bodies.place, self.units, engine.domain.periods
            pushes = pushes + self._riders.pushes(engine.of("solids"), *told)
        self.load(pushes, engine.domain.comm, time, dt)
        if dt > 0.0:
            self.bodies.kick(time, dt, self.contacts, self.joints)
        engine.poses.turn_to(time)

    def overlapping(self, store, depth: float) -> np.ndarray | None:
        """The particles of the body that is deepest inside another or a wall, or whose joint gapes most,
        where that is more than ``depth`` spacings; the same on every rank."""
        size, row, _ = self._worst()
        if not size > depth * self._scene.spacing:
            return None
        return (self.body_of[store.shown("group")] == row).astype(float)

    def overlap_words(self, number: int, key: str) -> str:
        """Which body is how deep inside what, or which joint gapes."""
        return self._worst()[2]

    def _worst(self) -> tuple[float, int, str]:
        """How far the worst of all overlaps and joints has gone, m; the row of its body; and in words."""
        deepest = self.contacts.deepest(self.bodies)
        inner = self.bodies.bodies[deepest.body].name
        found = deepest.depth, deepest.body, f"bodies.{inner} is {deepest.depth:.3g} m inside {deepest.other}"
        wide, number = self.joints.widest() if self.joints else (0.0, 0)
        if not wide > deepest.depth:
            return found
        joint = self.joints.joints[number]
        return wide, joint.body, f"joints.{joint.name} gapes by {wide:.3g} m: something else moves its parts"

    def weigh(self, store, mass: np.ndarray) -> None:
        """By the shares of each particle, where body forces ask for them."""
        row = self.body_of[store.shown("group")]
        if self.masses is not None and (own := row >= 0).any():
            shares, start = self.masses[row[own]], store.shown(ANCHOR.name)[own]
            mass[own] = shares[:, 0] + (shares[:, 1:] * start).sum(axis=1)

    def pushing(self, groups: Sequence[int], about: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Force and moment of the contacts of bodies among the groups."""
        bodies, point = self.bodies, np.zeros(3)
        own = np.isin(np.arange(len(bodies.bodies)), self.body_of[list(groups)])
        point[: len(about)] = about
        twist = bodies.twisting + np.cross(bodies.place - point, bodies.pressing)
        return bodies.pressing[own].sum(axis=0), twist[own].sum(axis=0)

    def summary(self, poses, lower: np.ndarray, upper: np.ndarray) -> Iterator[str]:
        """A line for each body that is beyond the scene's walls in whole, but not above."""
        gravity, dx = np.array(self._scene.gravity), self._scene.spacing
        down, up = gravity <= 0.0, gravity >= 0.0
        lowest, highest = poses.around
        for row, one in zip(self.rows, self.bodies.bodies):
            if (down & (highest[row] < lower - dx) | up & (lowest[row] > upper + dx)).any():
                yield (
                    f"bodies.{one.name} has left the walls, over a rim or through a gap: it is "
                    "a spacing or more below or beside them"
                )

    def news(self, time: float) -> Iterator[str]:
        """Lines that have parted in the last step."""
        for k in np.flatnonzero(self.lines.parted == time).tolist():
            yield self.lines.parting(k)

    def passed(self) -> Iterator[str]:
        """Lines that have parted."""
        for k in np.flatnonzero(np.isfinite(self.lines.parted)).tolist():
            yield self.lines.parting(k)

    def strung(self, time: float) -> Iterator[Strung]:
        """Their lines."""
        yield from self.lines.shapes(self.bodies, time)

    def state(self) -> dict:
        """Where they are, and how they move."""
        lines = {"lines": self.lines.state()} if self.lines.lines else {}
        return self.bodies.state() | lines | ({"joints": self.joints.state()} if self.joints else {})

    def restore(self, state: dict) -> None:
        """Go on from there."""
        self.bodies.restore(state)
        if "lines" in state:  # older ones have none
            self.lines.restore(state["lines"])
        if self.joints:
            self.joints.restore(state["joints"], self.bodies)

    def maps(self, time: float = 0.0) -> np.ndarray:
        """The affine maps of each body, as psph.physics.rigid.pose.maps: (n, 3, dim, 1 + dim)."""
        b, d = self.bodies, self._dimensions
        whirl, bend = crossing(b.spin_ahead), crossing(b.angular_acceleration)
        linear = np.stack([b.turn, whirl @ b.turn, (bend + whirl @ whirl) @ b.turn], axis=1)
        starts = np.stack([b.place, b.ahead, b.acceleration], axis=1)
        maps = np.empty((len(b.place), 3, d, 1 + d))
        maps[..., 0] = (starts - np.einsum("nwde,ne->nwd", linear, b.reference))[:, :, :d]
        maps[..., 1:] = linear[:, :, :d, :d]
        return maps

    def load(self, pushes: np.ndarray, comm, time: float, dt: float) -> None:
        """The forces at ``time``, s, the end of a step of ``dt`` s: those on the particles of this rank,
        ``pushes`` in whole numbers of :attr:`units` (psph.physics.rigid.pushes), those of lines, and uniform
        pulls; collective."""
        total = whole_sums(comm, pushes).astype(np.float64)
        pull, twist = self.lines.pulls(self.bodies, time, dt)
        if self.joints:
            pull, twist = (a + b for a, b in zip((pull, twist), self.joints.pulls(self.bodies)))
        self.bodies.load(total[:, :3] * self.units[0] + pull, total[:, 3:] * self.units[1] + twist)


def _strongest_pull(scene, pulls: Sequence, bodies: Sequence[RigidBody]) -> float:
    """The most that body forces which know a bound give a particle of some ``bodies``, N."""
    census, numbers = scene.census, scene.layout.parts.bodies
    known = [one.strongest for one in pulls if hasattr(one, "strongest")]
    if not known:
        return 0.0
    whole = sum(float(n) * one.inertia for n, one in zip(census.sizes, scene.species))
    whole += sum(body.mass for body in bodies)
    each = max(body.mass / float(census.sizes[number]) for body, number in zip(bodies, numbers))
    return each * sum(strongest(whole) for strongest in known)
