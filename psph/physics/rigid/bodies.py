"""Rigid bodies that forces move: their state, and how it goes on by a step.

All vectors have three numbers, in 2D too, where bodies lie in the plane of x and y and turn about z.  The
arrays hold all bodies of a scene, a row each, so that a hundred cost little more than one; every rank has
them all, with the same bits.
"""

from collections.abc import Sequence

import numpy as np

from psph.physics.rigid.body import RigidBody
from psph.physics.rigid.contact import Yielding
from psph.physics.rigid.pose import in_space

FIRST_TO_LAST = ((2, 0.5), (1, 0.5), (0, 1.0), (1, 0.5), (2, 0.5))
"""Principal axes, and the part of the step for which a body turns about each."""


LARGEST_PART = 0.004
"""What a free body turns in one part of a step, rad: its energy then stays to 1e-6."""

MOST_PARTS = 64
"""Of a step, however fast bodies turn."""

HALF_TURN = 1e-7
"""Below this the sine of a turn tells nothing of its axis."""

KEPT = (
    "place",
    "velocity",
    "angular_momentum",
    "turn",
    "frame",
    "angle",
    "force",
    "torque",
    "ahead",
    "spin_ahead",
    "loose",
    "prescribed",
    "prescribed_turn",
    "pressing",
    "twisting",
    "bearing",
    "bearing_turn",
)
"""The arrays of a state."""


class Bodies:
    """The state of all ``bodies`` of a scene under ``gravity`` (dim,) m/s².

    Kick, drift, kick (Newton and Euler): V½ = V + Δt F/2M, X ← X + Δt V½, V = V½ + Δt F/2M with the
    force at the end; likewise L½ = L + Δt T/2 for the angular momentum in space.  A body that turns
    freely turns with L½ about its principal axes 3, 2, 1, 2, 3 one after the other, each exactly (Miller
    and others 2002, J. Chem. Phys. 116, 8649), in equal parts of the step that turn it little: L is
    conserved to rounding, the energy to second order without drift.  One that turns about one axis has
    its angle, and no error in the turn at all.

    ``place`` X, m, ``velocity`` m/s, ``angular_momentum`` kg m²/s and ``force`` N, ``torque`` N m, all
    (n, 3), are of the reference points (:class:`RigidBody`), ``turn`` (n, 3, 3) leads from the start to now,
    ``frame`` has the principal axes of those that turn freely.  ``ahead`` and ``spin_ahead`` are
    velocity and angular velocity as they will be at the end of the step if the force stays; ``loose`` (n, 1)
    is 0 for a body that is held, which shows no velocity and no acceleration, else 1; ``prescribed``, m/s²,
    and ``prescribed_turn``, rad/s² (n, 3), are the accelerations of what is prescribed.  ``pressing`` N and
    ``twisting`` N m (n, 3) are what contacts were in the last step, in the mean over it, ``bearing`` and
    ``bearing_turn`` what joints bear at the end of it.
    """

    def __init__(self, bodies: Sequence[RigidBody], gravity: Sequence[float]):
        self.bodies = tuple(bodies)
        n = len(self.bodies)
        self.mass = np.array([one.mass for one in bodies])[:, None]
        self.reference = np.array([one.reference for one in bodies]).reshape(n, 3)
        self.lever = np.array([one.centre for one in bodies]).reshape(n, 3) - self.reference
        self.weight = self.mass * np.array(in_space(tuple(gravity)))
        self.slides = np.array([one.slides for one in bodies]).reshape(n, 3)
        self.held = np.array([one.held for one in bodies])[:, None]
        turns = np.array([one.turns for one in bodies]).reshape(n, 3)
        self.tumbling = np.flatnonzero(turns.all(axis=1))
        self.hinged = np.flatnonzero(turns.sum(axis=1) == 1)
        self.axis = turns.astype(float)
        inertia = np.array([one.inertia for one in bodies]).reshape(n, 3, 3)
        far = (self.lever**2).sum(axis=1)[:, None, None] * np.eye(3) - _outer(self.lever)
        self.inertia = inertia + self.mass[:, :, None] * far
        self.moments, axes = np.linalg.eigh(self.inertia[self.tumbling])
        self.principal = (
            axes * np.sign(np.linalg.det(axes))[:, None, None]
        )  # right-handed, as turns about them are
        self.about = np.einsum("nd,nde,ne->n", self.axis, self.inertia, self.axis)[self.hinged]
        self.place, self.velocity = self.reference.copy(), np.zeros((n, 3))
        self.turn, self.angle = np.tile(np.eye(3), (n, 1, 1)), np.zeros(len(self.hinged))
        self.frame = self.principal.copy()
        self.angular_momentum = np.zeros((n, 3))
        self.force, self.torque = np.zeros((n, 3)), np.zeros((n, 3))
        self.ahead, self.spin_ahead = np.zeros((n, 3)), np.zeros((n, 3))
        self.prescribed, self.prescribed_turn = np.zeros((n, 3)), np.zeros((n, 3))
        self.pressing, self.twisting = np.zeros((n, 3)), np.zeros((n, 3))
        self.bearing, self.bearing_turn = np.zeros((n, 3)), np.zeros((n, 3))
        self._led = [row for row, one in enumerate(bodies) if one.motion]
        self._swung = any(one.motion and one.pivot for one in bodies)
        self._lead(range(n), 0.0)
        self._begin()

    def drift(self, then: float, dt: float, contacts=None, joints=None) -> None:
        """The first half of the kick, and the way to the end of the step of ``dt`` s at ``then``.

        ``contacts`` between the two keep bodies from getting into each other (psph.simulation.touching), and
        ``joints`` together (psph.physics.rigid.joints).
        """
        before = self.velocity, self.spin_by(self.angular_momentum)
        self._kick(then, dt)
        self.pressing, self.twisting = np.zeros_like(self.force), np.zeros_like(self.torque)
        loose, step = then > self.held, self._lasting(then, dt)

        def meet(hold=None):
            if contacts and dt > 0.0:
                contacts.meet(self, before, then, dt, hold)

        if joints:
            joints.move(self, then, dt, lambda: self._go(then, step), meet)
        else:
            meet()
            self._go(then, step)
        velocity = np.where(self.slides, self.velocity + 0.5 * step * self.force / self.mass, self.velocity)
        momentum = self.angular_momentum + 0.5 * step * self._driving
        self._show(loose, *(joints.steadied(self, velocity, momentum) if joints else (velocity, momentum)))

    def kick(self, then: float, dt: float, contacts=None, joints=None) -> None:
        """The second half of the kick, by the forces at the end of the step, ``contacts`` and ``joints``."""
        self._kick(then, dt)
        if joints:
            joints.rest(self, dt, contacts)
        elif contacts:
            contacts.rest(self, dt)
        self._show(then > self.held, self.velocity, self.angular_momentum)

    def pose(self) -> tuple[np.ndarray, ...]:
        """Where they stand, for :meth:`put`."""
        return self.place, self.turn.copy(), self.frame, self.angle

    def put(self, pose: tuple[np.ndarray, ...]) -> None:
        """Let them stand there again."""
        self.place, turn, self.frame, self.angle = pose
        self.turn = turn.copy()

    def motion(self) -> tuple[np.ndarray, np.ndarray]:
        """How they move, for :meth:`set_off`."""
        return self.velocity, self.angular_momentum

    def set_off(self, motion: tuple[np.ndarray, np.ndarray]) -> None:
        """Let them move so again, before any contact."""
        self.velocity, self.angular_momentum = motion
        self.pressing, self.twisting = np.zeros_like(self.force), np.zeros_like(self.torque)

    def load(self, force: np.ndarray, torque: np.ndarray) -> None:
        """Forces and torques about the reference points (n, 3) at the end of the step; weight is added."""
        self.force = force + self.weight
        self.torque = torque + np.cross(self.arm, self.weight)

    @property
    def arm(self) -> np.ndarray:
        """From the reference points to the centres of mass, m (n, 3)."""
        return np.einsum("nde,ne->nd", self.turn, self.lever)

    @property
    def centre(self) -> np.ndarray:
        """The centres of mass, m (n, 3)."""
        return self.place + self.arm

    @property
    def spin(self) -> np.ndarray:
        """Angular velocities, rad/s (n, 3)."""
        return self.spin_ahead

    @property
    def pushed(self) -> np.ndarray:
        """All forces, N (n, 3), those of contacts and joints among them."""
        return self.force + self.pressing + self.bearing

    @property
    def turned_by(self) -> np.ndarray:
        """All torques about the reference points, N m (n, 3)."""
        return self.torque + self.twisting + self.bearing_turn

    @property
    def acceleration(self) -> np.ndarray:
        """Of the reference points, m/s² (n, 3): by the last forces, or as their motions have it."""
        return np.where(self.slides, self.loose * self.pushed / self.mass, self.prescribed)

    @property
    def angular_acceleration(self) -> np.ndarray:
        """By the last torques, rad/s² (n, 3): I⁻¹ (T − r × M A − ω × L); or as their motions have it."""
        found = self.prescribed_turn.copy()
        driving = self._driving + self.twisting + self.bearing_turn
        found[self.hinged] = self.axis[self.hinged] * self._spin_of_hinged(driving)[:, None]
        if len(self.tumbling):
            spin, momentum = self.spin_ahead[self.tumbling], self.angular_momentum[self.tumbling]
            twist = driving[self.tumbling] - np.cross(spin, momentum)
            own = np.einsum("nde,nd->ne", self.frame, twist) / self.moments
            found[self.tumbling] = np.einsum("nde,ne->nd", self.frame, own)
        return np.where(self.loose, found, self.prescribed_turn)

    @property
    def reaction(self) -> tuple[np.ndarray, np.ndarray]:
        """Force, N, and moment about the reference points, N m, (n, 3) of what holds bodies.

        What lacks in Newton's and Euler's equations: R = M a_c − F with the acceleration a_c of the centre of
        mass, and M_R = I α + ω × I ω + r × M A − T with the acceleration A of the reference point, the arm r
        from it to the centre of mass, and I about it.  Zero in what is free.
        """
        spin, change, arm = self.spin_ahead, self.angular_acceleration, self.arm
        whirl = np.cross(change, arm) + np.cross(spin, np.cross(spin, arm))
        force = self.mass * (self.acceleration + whirl) - self.pushed
        there = self.turn @ self.inertia @ self.turn.transpose(0, 2, 1)
        momentum = np.einsum("nde,ne->nd", there, spin)
        driven = np.einsum("nde,ne->nd", there, change) + np.cross(spin, momentum)
        torque = driven + self.mass * np.cross(arm, self.acceleration) - self.turned_by
        loose = self.loose > 0.0
        torque = np.where(loose & (self.axis > 0.0), 0.0, torque)
        return np.where(loose & self.slides, 0.0, force), torque

    def yielding(self, then: float) -> Yielding:
        """How they give way to impulses at their reference points at the time ``then``, s."""
        loose = then > self.held
        turning = np.zeros((len(self.bodies), 3, 3))
        turning[self.hinged] = _outer(self.axis[self.hinged]) / self.about[:, None, None]
        turning[self.tumbling] = np.einsum("nde,ne,nfe->ndf", self.frame, 1.0 / self.moments, self.frame)
        return Yielding(
            np.where(self.slides & loose, 1.0 / self.mass, 0.0), np.where(loose[:, :, None], turning, 0.0)
        )

    def shoved(self, push: np.ndarray, twist: np.ndarray, sign: float = 1.0) -> None:
        """Let impulses ``push`` N s and ``twist`` N m s, (n, 3), act, or take them back with ``sign`` −1."""
        self.velocity = np.where(self.slides, self.velocity + sign * push / self.mass, self.velocity)
        self.angular_momentum = self.angular_momentum + sign * twist

    def spin_by(self, momentum: np.ndarray) -> np.ndarray:
        """Angular velocities, rad/s (n, 3), with an angular ``momentum``; of what is told, as it is told."""
        spin = self.spin_ahead.copy()
        spin[self.hinged] = self.axis[self.hinged] * self._spin_of_hinged(momentum)[:, None]
        if len(self.tumbling):
            own = np.einsum("nde,nd->ne", self.frame, momentum[self.tumbling]) / self.moments
            spin[self.tumbling] = np.einsum("nde,ne->nd", self.frame, own)
        return spin

    def state(self) -> dict:
        """What the next steps rest on, as lists of numbers."""
        return {name: getattr(self, name).tolist() for name in KEPT}

    def restore(self, state: dict) -> None:
        """Go on from there."""
        for name in KEPT:
            setattr(self, name, np.array(state[name], dtype=float).reshape(getattr(self, name).shape))

    def turned(self, row: int) -> np.ndarray:
        """The turn of a body since the start as axis times angle, rad (3,)."""
        if row in self.hinged:
            return self.axis[row] * self.angle[self.hinged == row][0]
        m = self.turn[row]
        twist = np.array([m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]])
        size = float(np.sqrt(twist @ twist))
        angle = np.arctan2(size, np.trace(m) - 1.0)
        if size > HALF_TURN:
            return twist * (angle / size)
        if angle < 1.0:
            return 0.5 * twist
        axis = np.sqrt(np.maximum(0.5 * (np.diag(m) + 1.0), 0.0))  # half a turn: m = 2 n nᵀ − 1
        first = int(axis.argmax())
        return angle * np.copysign(axis, m[first] + np.eye(3)[first])

    def at(self, row: int, point: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Where a point of a body has come that was at ``point`` (3,) m at the start, and its velocity,
        m/s."""
        arm = self.turn[row] @ (point - self.reference[row])
        return self.place[row] + arm, self.ahead[row] + np.cross(self.spin_ahead[row], arm)

    def kinetic_energy(self) -> np.ndarray:
        """M V²/2 + L·ω/2 of each body, J (n,), with V of the centre of mass."""
        own = self.ahead + np.cross(self.spin_ahead, self.arm)
        about_centre = self.inertia - self.mass[:, :, None] * (
            (self.lever**2).sum(axis=1)[:, None, None] * np.eye(3) - _outer(self.lever)
        )
        there = np.einsum("nde,nef,ngf->ndg", self.turn, about_centre, self.turn)
        whirl = np.einsum("nd,nde,ne->n", self.spin_ahead, there, self.spin_ahead)
        return 0.5 * (self.mass[:, 0] * (own**2).sum(axis=1) + whirl)

    @property
    def _driving(self) -> np.ndarray:
        """Torques about the reference points, N m (n, 3), less r × M A where these are told to move: the
        acceleration A of a pivot, m/s², swings the centre of mass at the end of the arm r."""
        if not self._swung:
            return self.torque
        return self.torque - self.mass * np.cross(self.arm, self.prescribed)

    def _begin(self) -> None:
        """Velocity and spin of the start, in what is free."""
        velocity = np.array([one.velocity for one in self.bodies]).reshape(-1, 3)
        spin = np.array([one.spin for one in self.bodies]).reshape(-1, 3)
        self.velocity = np.where(self.slides, velocity, self.velocity)
        for row in (*self.tumbling, *self.hinged):
            self.angular_momentum[row] = self.inertia[row] @ (
                spin[row] if row in self.tumbling else self.axis[row] * (self.axis[row] @ spin[row])
            )
        self._show(self.held == 0.0, self.velocity, self.angular_momentum)

    def _show(self, loose: np.ndarray, velocity: np.ndarray, momentum: np.ndarray) -> None:
        """The velocities that others see: none of a body that is not ``loose`` (n, 1) yet."""
        self.loose = loose.astype(float)
        self.ahead = np.where(self.slides & ~loose, 0.0, velocity)
        self._spin(np.where(loose, momentum, 0.0))

    def _go(self, then: float, step: np.ndarray) -> None:
        """Places and turns at ``then``, s, each body after its own ``step`` (n, 1), s."""
        self.place = np.where(self.slides, self.place + step * self.velocity, self.place)
        self._tumble(step[self.tumbling, 0])
        self.angle = self.angle + step[self.hinged, 0] * self._spin_of_hinged(self.angular_momentum)
        self._follow(then)

    def _lasting(self, then: float, dt: float) -> np.ndarray:
        """How much of the step of ``dt`` s that ends at ``then`` each body is not held in, s (n, 1)."""
        return np.clip(then - self.held, 0.0, dt)

    def _kick(self, then: float, dt: float) -> None:
        half = 0.5 * self._lasting(then, dt)
        self.velocity = np.where(self.slides, self.velocity + half * self.force / self.mass, self.velocity)
        self.angular_momentum = self.angular_momentum + half * self._driving

    def _tumble(self, dt: np.ndarray) -> None:
        """The free turns, of each body over its own ``dt``, s."""
        if not len(self.tumbling):
            return
        momentum = self.angular_momentum[self.tumbling]
        turned = (np.sqrt((self.spin_ahead[self.tumbling] ** 2).sum(axis=1)) * dt).max()
        parts = int(np.fmin(np.fmax(np.ceil(turned / LARGEST_PART), 1.0), MOST_PARTS))  # of NaN one
        for k, share in FIRST_TO_LAST * parts:
            about = np.einsum("nd,nd->n", self.frame[:, :, k], momentum)
            self.frame = _turned_about(self.frame, k, share / parts * dt * about / self.moments[:, k])
        self.turn[self.tumbling] = self.frame @ self.principal.transpose(0, 2, 1)

    def _follow(self, time: float) -> None:
        """What is prescribed, and where the hinges have their bodies."""
        self._lead(self._led, time)
        self.turn[self.hinged] = _rotations(self.axis[self.hinged], self.angle)

    def _lead(self, rows: Sequence[int], time: float) -> None:
        """Bodies that are not free in all, where their motion has them; those without one stay there."""
        for row in rows:
            one, pose, fixed = self.bodies[row], self.bodies[row].pose(time), ~self.slides[row]
            self.place[row, fixed] = np.array(pose.place(one.reference))[fixed]
            self.velocity[row, fixed] = np.array(pose.velocity_of(one.reference))[fixed]
            self.prescribed[row, fixed] = np.array(pose.acceleration_of(one.reference))[fixed]
            if not any(one.turns):
                self.turn[row] = np.reshape(pose.rotation, (3, 3))
                self.spin_ahead[row] = pose.angular_velocity
                self.prescribed_turn[row] = pose.angular_acceleration

    def _spin_of_hinged(self, momentum: np.ndarray) -> np.ndarray:
        return np.einsum("nd,nd->n", self.axis[self.hinged], momentum[self.hinged]) / self.about

    def _spin(self, momentum: np.ndarray) -> None:
        """The angular velocities of what turns freely or about an axis, from its angular momentum."""
        self.spin_ahead = self.spin_by(momentum)


def crossing(a: np.ndarray) -> np.ndarray:
    """The matrices [a] with [a] r = a × r, of vectors (n, 3)."""
    found = np.zeros((len(a), 3, 3))
    for d, (e, f) in enumerate(((1, 2), (2, 0), (0, 1))):
        found[:, e, f], found[:, f, e] = -a[:, d], a[:, d]
    return found


def _rotations(axis: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """The matrices (n, 3, 3) that turn by ``angle`` (n,) rad about unit ``axis`` (n, 3): Rodrigues."""
    s, t = np.sin(angle), 2.0 * np.sin(0.5 * angle) ** 2  # 1 − c without cancellation
    across = crossing(axis)
    return np.eye(3) + s[:, None, None] * across + t[:, None, None] * (across @ across)


def _outer(a: np.ndarray) -> np.ndarray:
    return a[:, :, None] * a[:, None, :]


def _turned_about(frame: np.ndarray, k: int, angle: np.ndarray) -> np.ndarray:
    """The frames (n, 3, 3) turned by ``angle`` (n,) about their own axis ``k``."""
    a, b = (k + 1) % 3, (k + 2) % 3
    c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
    turned = frame.copy()
    turned[:, :, a] = c * frame[:, :, a] + s * frame[:, :, b]
    turned[:, :, b] = c * frame[:, :, b] - s * frame[:, :, a]
    return turned
