"""Where rigid bodies meet each other, walls and mirrors, by the shapes that are drawn."""

from typing import NamedTuple

import numpy as np

from psph.physics.rigid.bodies import Bodies
from psph.physics.rigid.contact import OUT, BodyContacts, Yielding, approach, solve
from psph.scene.bodies import contact_of
from psph.simulation.meetings import ContactPoints, Meetings

AHEAD = 0.1
"""Spacings, and twice the way of two bodies in a step, from which points are looked at."""


class Overlap(NamedTuple):
    """A body of the row ``body`` is ``depth`` m inside what has the key ``other``; 0 where none is in any."""

    depth: float
    body: int
    other: str


class Contacts:
    """The contacts of the rigid bodies of a ``scene`` with the rows ``rows`` of the ``maps`` that place them.

    A body meets others with points on its faces: those below which its outer particles lie, and its drawn
    corners.  ``restitution`` is the speed after over that before an impact, ``friction`` Coulomb's
    coefficient.  Every rank computes all, with the same bits.
    """

    def __init__(self, scene, plan, rows, maps: np.ndarray):
        contact, self._spacing = contact_of(scene), scene.spacing
        self._friction, self._restitution = contact.friction, contact.restitution
        places = np.array([plan.materials.rigid[row].reference[: scene.dimensions] for row in rows])
        self._meetings = Meetings(scene, plan, rows, maps)
        self._size = np.array([one.reach(at[None]) for one, at in zip(self._meetings.tips, places)])
        self._touching: BodyContacts | None = None
        self._extra: tuple[np.ndarray, np.ndarray] | None = None

    def meet(self, bodies: Bodies, before: tuple[np.ndarray, np.ndarray], then: float, dt: float) -> None:
        """Impulses on the ``bodies`` so that in the step of ``dt`` s until ``then`` none gets into another.

        Where two would meet within the step they part with the ``restitution`` of the velocities and spins
        ``before`` it; where they rest they come no nearer than they are.  What overlaps is pushed out by a
        velocity that ends with the step.
        """
        speed, spin = bodies.velocity.copy(), bodies.spin_by(bodies.angular_momentum)
        self._touching, self._extra = self.near(bodies, speed, spin, dt), None
        touching, yielding = self._touching, bodies.yielding(then)
        if not len(touching.first):
            return
        gap = np.maximum(touching.gap, 0.0)
        closing = gap + dt * approach(touching, speed, spin) <= 0.0
        bounced = -self._restitution * approach(touching, *before)
        wanted = np.where(closing, np.maximum(bounced, -gap / dt), -gap / dt)
        impulse = solve(touching, yielding, wanted, self._friction, speed, spin)
        # One of several points that would do may bear all: those left without a push rest on the face too.
        resting = closing | (impulse != 0.0).any(axis=1)
        self._push(bodies, touching, impulse, dt)
        if (touching.gap < 0.0).any():
            wanted = np.maximum(approach(touching, speed, spin), -OUT * touching.gap / dt)
            wanted = np.where(touching.gap < 0.0, wanted, -gap / dt)
            self._extra = _sums(touching, solve(touching, yielding, wanted, 0.0, speed, spin), bodies)
            bodies.shoved(*self._extra)
        self._touching = BodyContacts(*(of[resting] for of in touching))
        self._yielding: Yielding = yielding

    def rest(self, bodies: Bodies, dt: float) -> None:
        """What came to rest in the step does not set off again by the second half of its kick."""
        touching = self._touching
        if self._extra:
            bodies.shoved(*self._extra, sign=-1.0)
        if touching is None or not len(touching.first):
            return
        speed, spin = bodies.velocity.copy(), bodies.spin_by(bodies.angular_momentum)
        wanted = np.zeros(len(touching.first))
        impulse = solve(touching, self._yielding, wanted, self._friction, speed, spin)
        self._push(bodies, touching, impulse, dt)

    def deepest(self, bodies: Bodies) -> "Overlap":
        """Where a body is deepest inside another, a wall or a mirror."""
        deepest = Overlap(0.0, -1, "")
        for row, other, depth in self._meetings.depths():
            if depth > deepest.depth:
                deepest = Overlap(depth, row, other.key)
        return deepest

    def near(self, bodies: Bodies, speed: np.ndarray, spin: np.ndarray, dt: float) -> BodyContacts:
        """The points in which bodies may meet in a step of ``dt`` s, at the velocities and spins given."""
        ways = np.sqrt((speed**2).sum(axis=1)) + self._size * np.sqrt((spin**2).sum(axis=1))
        most = AHEAD * self._spacing + 4.0 * dt * float(ways.max())
        contacts = [self._touching_at(bodies, one) for one in self._meetings.near(most)] or [NOTHING]
        return BodyContacts(*(np.concatenate(of) for of in zip(*contacts)))

    def _touching_at(self, bodies: Bodies, met: ContactPoints) -> BodyContacts:
        other, count, d = met.seen.obstacle, len(met.points), met.points.shape[1]
        arms, other_arms, out, told = np.zeros((4, count, 3))
        arms[:, :d], out[:, :d] = met.points - bodies.place[met.row, :d], met.normal
        if other.body >= 0:
            other_arms[:, :d] = met.points + met.seen.shift - bodies.place[other.body, :d]
        else:
            told[:, :d] = self._meetings.velocity(met.seen, met.points)
        rows = np.full(count, met.row), np.full(count, other.body)
        return BodyContacts(*rows, arms, other_arms, out, met.gap, told)

    def _push(self, bodies: Bodies, touching: BodyContacts, impulse: np.ndarray, dt: float) -> None:
        push, twist = _sums(touching, impulse, bodies)
        bodies.shoved(push, twist)
        bodies.pressing, bodies.twisting = bodies.pressing + push / dt, bodies.twisting + twist / dt


NONE, NOWHERE = np.empty(0, np.int64), np.empty((0, 3))
NOTHING = BodyContacts(NONE, NONE, NOWHERE, NOWHERE, NOWHERE, np.empty(0), NOWHERE)
"""No contact."""


def _sums(touching: BodyContacts, impulse: np.ndarray, bodies: Bodies) -> tuple[np.ndarray, np.ndarray]:
    """All impulses, N s, and their moments about the reference points, N m s, of each body (n, 3)."""
    push, twist = np.zeros_like(bodies.force), np.zeros_like(bodies.force)
    for rows, arms, sign in (
        (touching.first, touching.arms, 1.0),
        (touching.second, touching.other_arms, -1.0),
    ):
        own = rows >= 0
        np.add.at(push, rows[own], sign * impulse[own])
        np.add.at(twist, rows[own], np.cross(arms[own], sign * impulse[own]))
    return push, twist
