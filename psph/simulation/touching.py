"""Where rigid bodies meet each other, walls and mirrors, by the shapes that are drawn."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from psph.physics.rigid.bodies import Bodies
from psph.physics.rigid.contact import OUT, BodyContacts, Yielding, approach, solve
from psph.physics.rigid.joints_answer import Jointed, loose
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
        self._yielding: Yielding
        self._then: float
        self._extra: tuple[np.ndarray, np.ndarray] | None = None

    def meet(
        self, bodies: Bodies, before: tuple, then: float, dt: float, hold: Callable[[], Jointed] | None = None
    ) -> None:
        """Impulses on the ``bodies`` so that in the step of ``dt`` s until ``then`` none gets into another.

        Where two would meet within the step they part with the ``restitution`` of the velocities and spins
        ``before`` it; where they rest they come no nearer than they are.  What overlaps is pushed out by a
        velocity that ends with the step.  ``hold`` lets joints hold, and says how they answer.
        """
        self._extra = None
        self._touching = touching = self.near(bodies, *_moving(bodies), dt)
        if not len(touching.first):
            return
        held, gap = hold() if hold else None, np.maximum(touching.gap, 0.0)
        self._then, self._yielding = then, bodies.yielding(then)
        speed, spin = _moving(bodies)
        closing = gap + dt * approach(touching, speed, spin) <= 0.0
        bounced = -self._restitution * approach(touching, *before)
        wanted = np.where(closing, np.maximum(bounced, -gap / dt), -gap / dt)
        found = self._solved(wanted, self._friction, speed, spin, held)
        self._bear(bodies, found, dt, held)
        # One of several points that would do may bear all: those left without a push rest on the face too.
        resting = closing | (found.impulse != 0.0).any(axis=1)
        if (touching.gap < 0.0).any():
            wanted = np.maximum(approach(touching, speed, spin), -OUT * touching.gap / dt)
            wanted = np.where(touching.gap < 0.0, wanted, -gap / dt)
            found = self._solved(wanted, 0.0, speed, spin, held)
            self._extra = found.push + found.back, found.twist + found.twist_back
            bodies.shoved(*self._extra)
        self._touching = BodyContacts(*(of[resting] for of in touching))

    def rest(self, bodies: Bodies, dt: float, hold: Callable[[], Jointed] | None = None) -> None:
        """What came to rest in the step does not set off again by the second half of its kick."""
        if self._extra:
            bodies.shoved(*self._extra, sign=-1.0)
        if self._touching is not None and len(self._touching.first):
            held = hold() if hold else None
            self._yielding = bodies.yielding(self._then)  # they have turned, and joints answer as they stand
            wanted = np.zeros(len(self._touching.first))
            self._bear(bodies, self._solved(wanted, self._friction, *_moving(bodies), held), dt, held)

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

    def _solved(self, wanted, friction: float, speed, spin, held: Jointed | None) -> "Shove":
        """The impulses after which points part as ``wanted`` (m,) m/s (psph.physics.rigid.contact.solve);
        ``speed`` and ``spin`` (n, 3) take what they change."""
        touching = self._touching
        assert touching
        answers = held.at(touching) if held else loose(touching)
        impulse = solve(touching, self._yielding, wanted, friction, speed, spin, answers)
        push, twist = _sums(touching, impulse, len(speed))
        if not held:
            return Shove(impulse, push, twist, 0.0, 0.0, answers.borne)
        slower, turned = held.moved(answers.borne)
        speed += slower
        spin += turned
        return Shove(impulse, push, twist, *held.pushed(answers.borne), answers.borne)

    def _bear(self, bodies: Bodies, found: "Shove", dt: float, held: Jointed | None) -> None:
        """Let impulses act, and those of joints with them."""
        bodies.shoved(found.push, found.twist)
        bodies.pressing, bodies.twisting = (
            bodies.pressing + found.push / dt,
            bodies.twisting + found.twist / dt,
        )
        if held:
            bodies.shoved(found.back, found.twist_back)
            held.bear(found.borne)


class Shove(NamedTuple):
    """``impulse`` (m, 3) N s in points of contact; sums of each body (n, 3), ``push``, N s, and ``twist``,
    N m s, about its reference point; of joints ``back``, ``twist_back``, and ``borne`` by their rows."""

    impulse: np.ndarray
    push: np.ndarray
    twist: np.ndarray
    back: np.ndarray | float
    twist_back: np.ndarray | float
    borne: np.ndarray


def _moving(bodies: Bodies) -> tuple[np.ndarray, np.ndarray]:
    """Velocities and spins (n, 3), of their own."""
    return bodies.velocity.copy(), bodies.spin_by(bodies.angular_momentum)


NONE, NOWHERE = np.empty(0, np.int64), np.empty((0, 3))
NOTHING = BodyContacts(NONE, NONE, NOWHERE, NOWHERE, NOWHERE, np.empty(0), NOWHERE)
"""No contact."""


def _sums(touching: BodyContacts, impulse: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """All impulses, N s, and their moments about the reference points, N m s, of each of ``count`` bodies."""
    push, twist = np.zeros((2, count, 3))
    for rows, arms, sign in (
        (touching.first, touching.arms, 1.0),
        (touching.second, touching.other_arms, -1.0),
    ):
        own = rows >= 0
        np.add.at(push, rows[own], sign * impulse[own])
        np.add.at(twist, rows[own], np.cross(arms[own], sign * impulse[own]))
    return push, twist
