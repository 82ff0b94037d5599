"""Joints between rigid bodies, and of bodies with what stands still or moves as it is told.

All joints are held at once, by impulses and not by springs: a step moves the bodies so that at its end
every joint fits, and lets them go on with velocities at which it stays so.
"""

from collections.abc import Callable, Sequence

import numpy as np

from psph.physics.rigid.bodies import Bodies
from psph.physics.rigid.contact import Yielding
from psph.physics.rigid.joint_rows import (
    GO,
    LENGTH,
    ORIGIN,
    SLIDE,
    SPIN,
    TILT,
    TURN,
    Joint,
    JointRows,
    rows_of,
    turned,
    vector_of,
)
from psph.physics.rigid.joints_answer import Jointed, answering
from psph.physics.rigid.linear import factored, solved
from psph.physics.rigid.lines import STEP

ROUNDS = 40
"""In which the joints of a step are made to fit, at most; some four do."""

FITS = 1e-13
"""Of the longest arm of a joint, or of 1 rad: what is left of a gap."""

STILL = 1e-12
"""Of the largest rate at which gaps open: what a limit takes for none."""

ROUNDED = 8.0
"""Units in the last place of the farthest point that are left of a gap at least."""

KEPT = ("push", "twist", "ways", "latched")
"""The arrays of a state."""


class Joints:
    """The ``joints`` of the ``bodies`` of a scene (psph.physics.rigid.bodies).

    With g(X) = 0 for all joints and the rows G = ∂g/∂X: V½ = V + Δt M⁻¹ F/2 + M⁻¹ G(X)ᵀ λ with the λ for
    which g = 0 after the step, and V = V½ + Δt M⁻¹ F/2 + M⁻¹ Gᵀ μ with the μ for which G V = 0: SHAKE and
    RATTLE (Ryckaert, Ciccotti & Berendsen 1977, J. Comput. Phys. 23, 327; Andersen 1983, J. Comput. Phys.
    52, 24), for bodies that turn.  What several rows could bear is shared evenly.  A limit is a row as long
    as it is reached and pushes back: where it throws back, G V = −e v with the speed v at which it was met.
    Contacts of bodies and what joints bear of them are solved as one (psph.physics.rigid.joints_answer).

    ``push`` N s and ``twist`` N m s (n, 3) are the impulses of each joint on its first body in the last
    step, about its point; ``ways`` (n,) the coordinates q, angles beyond half a turn too; ``latched`` (n,)
    −1 or 1 for what stays at its lower or upper limit, else 0.
    """

    def __init__(self, joints: Sequence[Joint], bodies: Bodies):
        self.joints, count = tuple(joints), len(bodies.bodies)
        led = [one.leader for one in joints if one.other is None]
        self._leaders = [one for k, one in enumerate(led) if not any(one is other for other in led[:k])]
        self._first = np.array([one.body for one in joints])
        self._second = np.array(
            [count + self._lead(one) if one.other is None else one.other for one in joints]
        )
        origin = [one.pose(0.0).reference if one else ORIGIN for one in self._leaders]
        self._reference = np.concatenate([bodies.reference, np.reshape(origin, (-1, 3))])
        points = (np.array([getattr(one, of) for one in joints]) for of in ("here", "there", "over"))
        self._here, self._there, self._over = points
        rows = [(j, *row) for j, one in enumerate(joints) for row in rows_of(one)]
        self._of, self._what, self._way = (np.array(of) for of in zip(*rows))
        self._axis = np.array([one.axis or ORIGIN for one in joints])[self._of]
        self._length = np.array([one.length or 0.0 for one in joints])[self._of]
        self._lower, self._upper = (
            np.array([one.limits[side] for one in joints])[self._of] for side in (0, 1)
        )
        self._latches, self._free = np.array([one.latch for one in joints]), self._what >= GO
        arms = np.abs(self._here - self._reference[self._first]).max()
        gyration = np.sqrt(np.trace(bodies.inertia, axis1=1, axis2=2) / bodies.mass[:, 0])
        size = max(float(arms), float(gyration.max()), float(self._length.max()))
        self._ways = np.isin(self._what, (SLIDE, LENGTH, GO))
        self._enough, self._arm = FITS * np.where(self._ways, size, 1.0), size
        self.push, self.twist = np.zeros((2, len(joints), 3))
        self.ways, self.latched, self._stops, self._bounce = np.zeros((4, len(joints)))
        self._see(bodies, 0.0)

    def move(
        self, bodies: Bodies, then: float, dt: float, go: Callable[[], None], meet: Callable[..., None]
    ) -> None:
        """Let the bodies ``go`` to ``then``, s, by impulses at its beginning after which all joints fit, by
        those too of contacts where they ``meet`` others."""
        self._stops, self._bounce = self.latched.copy(), np.zeros(len(self.joints))
        before, start, motion = self._now, bodies.pose(), bodies.motion()
        for number in range(ROUNDS):
            bodies.put(start)
            bodies.set_off(motion)
            self.push, self.twist = np.zeros_like(self.push), np.zeros_like(self.twist)
            given, gaps = self._fitted(bodies, then, dt, go, meet)
            if not dt > 0.0 or not self._switch(bodies, gaps, given, dt, number > 0):
                break
        self.latched = np.where(self._latches, self._stops, 0.0)
        self._see(bodies, then)
        self._bear(bodies, self._sums(before, given), dt)

    def rest(self, bodies: Bodies, dt: float, contacts=None) -> None:
        """Velocities at the end of a step of ``dt`` s at which all joints stay as they are, and what rests in
        ``contacts`` does (psph.simulation.touching)."""
        held: list[Jointed] = []

        def hold() -> Jointed:
            share, binds = self._staying(*_moving(bodies))
            self._act(bodies, self._now, share)
            held.append(self._holding(self._now, self._give, binds, share))
            return held[0]

        if contacts:
            contacts.rest(bodies, dt, hold)
        share = self._staying(*_moving(bodies))[0]
        self._act(bodies, self._now, share)
        for one in held:
            share = share + self._noted(self._now, one)
        self._bear(bodies, self._sums(self._now, share), dt)

    def steadied(self, bodies: Bodies, velocity: np.ndarray, momentum: np.ndarray) -> tuple:
        """The ``velocity`` and angular ``momentum`` (n, 3) that the joints would make of these."""
        push, twist = self._sums(self._now, self._staying(velocity, bodies.spin_by(momentum))[0])
        return np.where(bodies.slides, velocity + push / bodies.mass, velocity), momentum + twist

    def pulls(self, bodies: Bodies) -> tuple[np.ndarray, np.ndarray]:
        """Forces, N, and torques about the reference points, N m, (n, 3) of springs and dampers in joints."""
        rates = self._rates(self._now, bodies.ahead, bodies.spin_ahead)
        stiff, rest, damped = (self._told(name) for name in ("stiffness", "rest", "damping"))
        share = stiff * (rest - self.ways[self._of]) - damped * rates
        return self._sums(self._now, np.where(self._free, share, 0.0))

    def longest_step(self) -> float:
        """Δt ≤ 0.2/√(k y) and 0.2/(ζ y), s, with y by which a joint gives way along its coordinate, 1/kg or
        1/(kg m²), where no other joint holds it."""
        give = np.where(self._free, np.diagonal(self._answers(self._now, self._give)), 0.0)
        rates = np.sqrt(self._told("stiffness") * give), self._told("damping") * give
        rate = max(float(one.max()) for one in rates)
        return STEP / rate if rate > 0.0 else float(np.inf)

    def widest(self) -> tuple[float, int]:
        """How far a joint gapes at most, m, an angle at the longest arm; and the number of that joint."""
        gaps = np.abs(np.where(self._binds(), self._gaps(self._now), 0.0))
        gaps = np.where(self._ways, gaps, self._arm * gaps)
        return float(gaps.max()), int(self._of[gaps.argmax()])

    def state(self) -> dict:
        """What the next steps rest on, as lists of numbers."""
        return {name: getattr(self, name).tolist() for name in KEPT} | {"time": self._time}

    def restore(self, state: dict, bodies: Bodies) -> None:
        """Go on from there."""
        for name in KEPT:
            setattr(self, name, np.reshape(state[name], getattr(self, name).shape).astype(float))
        self._stops, self._bounce = self.latched.copy(), np.zeros(len(self.joints))
        self._see(bodies, state["time"])

    def _fitted(self, bodies: Bodies, then: float, dt: float, go, meet) -> tuple[np.ndarray, np.ndarray]:
        """One try of a step, with the limits that are reached so far: impulses (m,), and the gaps after."""
        before, start, give, binds = self._now, bodies.pose(), bodies.yielding(then), self._binds()
        solve, enough, held = self._solver(before, give, binds), self._fitting(bodies), []

        def hold() -> Jointed:
            opening = self._gaps(before) / dt + self._rates(before, *_moving(bodies))
            share = solve(np.where(binds, -opening, 0.0))
            self._act(bodies, before, share)
            held.append(self._holding(before, give, binds, share))
            return held[0]

        meet(hold)
        given = sum((self._noted(before, one) for one in held), np.zeros(len(self._of)))
        for _ in range(ROUNDS):
            go()
            gaps = self._gaps(self._rows(bodies, then))
            if not dt > 0.0 or not (np.abs(np.where(binds, gaps, 0.0)) > enough).any():
                break
            bodies.put(start)
            share = solve(np.where(binds, -gaps / dt, 0.0))
            given = given + share
            self._act(bodies, before, share)
        else:
            go()
        return given, gaps

    def _holding(self, rows: JointRows, give: Yielding, binds: np.ndarray, given: np.ndarray) -> Jointed:
        """What the rows that bind answer to contacts, after the impulses ``given`` (m,)."""
        return Jointed(np.flatnonzero(binds), given, *(of[binds] for of in self._whole(rows, give)))

    def _noted(self, rows: JointRows, held: Jointed) -> np.ndarray:
        """The impulses (m,) of what held in contacts, added to those of the step."""
        found = held.given.copy()
        share = np.zeros(len(found))
        share[held.which] = -held.borne
        self._note(rows, share)
        return found + share

    def _lead(self, joint: Joint) -> int:
        """Which leader it has."""
        return next(k for k, one in enumerate(self._leaders) if one is joint.leader)

    def _see(self, bodies: Bodies, time: float) -> None:
        """Take in where the joints are at ``time``, s, and how bodies give way there."""
        self._now, self._time = self._rows(bodies, time), time
        self._give = bodies.yielding(float(np.nextafter(time, np.inf)))  # none is loose at the time 0
        self._calm: tuple | None = None
        unrolled = self._unrolled(self._now.gap)
        self.ways[self._of[self._free]] = unrolled[self._free]

    def _unrolled(self, gap: np.ndarray) -> np.ndarray:
        """The coordinates: of angles the ones nearest to those of before."""
        turns = np.round((self.ways[self._of] - gap) / (2.0 * np.pi))
        return np.where(self._what == SPIN, gap + 2.0 * np.pi * turns, gap)

    def _gaps(self, rows: JointRows) -> np.ndarray:
        """Of what binds; of limits, how far beyond them it is."""
        way, side = self._unrolled(rows.gap), self._stops[self._of]
        limit = np.where(side > 0.0, self._upper, self._lower)
        beyond = np.where(way > self._upper, way - self._upper, np.minimum(way - self._lower, 0.0))
        with np.errstate(invalid="ignore"):  # where there is no limit
            return np.where(self._free, np.where(side != 0.0, way - limit, beyond), rows.gap)

    def _fitting(self, bodies: Bodies) -> np.ndarray:
        """What may be left of gaps (m,), m or rad, no less than what places are rounded to."""
        far = max(float(np.abs(bodies.place).max()), float(np.abs(self._there).max()))
        return np.maximum(self._enough, np.where(self._ways, ROUNDED * np.spacing(far), 0.0))

    def _binds(self) -> np.ndarray:
        """Which rows hold."""
        return ~self._free | (self._stops[self._of] != 0.0)

    def _switch(self, bodies: Bodies, gaps: np.ndarray, given: np.ndarray, dt: float, alone: bool) -> bool:
        """Whether a limit has been reached, or pulls and lets go; of several the first ``alone``, so that it
        ends (Murty 1974, Linear Algebra Appl. 9, 65)."""
        side = self._stops[self._of]
        pulls = self._free & (side * given > 0.0) & (self.latched[self._of] == 0.0)
        reached = self._free & (side == 0.0) & (np.abs(gaps) > self._fitting(bodies))
        changed = np.flatnonzero(pulls | reached)[: 1 if alone else None]
        self._stops[self._of[changed]] = np.where(reached, np.sign(gaps), 0.0)[changed]
        self._bounce[self._of[changed]] = np.where(reached, self._thrown(bodies, gaps, dt), 0.0)[changed]
        return bool(len(changed))

    def _thrown(self, bodies: Bodies, beyond: np.ndarray, dt: float) -> np.ndarray:
        """The rates (m,) at which limits throw back what would be ``beyond`` them after the step of ``dt`` s.

        It meets them at v + f a dt, after the part f of its way in the step.
        """
        start, before = self.ways[self._of], self._rates(self._now, bodies.ahead, bodies.spin_ahead)
        limit = np.where(beyond > 0.0, self._upper, self._lower)
        with np.errstate(invalid="ignore"):  # where there is no limit
            free = limit + beyond - start
            part = np.clip((limit - start) / np.where(free != 0.0, free, 1.0), 0.0, 1.0)
            meeting = before + 2.0 * part * (free / dt - before)
            side = np.sign(beyond)
            return -side * self._told("restitution") * np.maximum(side * meeting, 0.0)

    def _back(self) -> np.ndarray:
        """The rates (m,) that limits ask for."""
        return np.where(self._free, self._bounce[self._of], 0.0)

    def _staying(self, velocity: np.ndarray, spin: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The impulses (m,) after which no gap opens, and the rows that bind; a limit does not pull."""
        if self._calm is None:
            self._calm = self._binds(), self._solver(self._now, self._give, self._binds())
        binds, solve = self._calm
        lacks = self._back() - self._rates(self._now, velocity, spin)
        share = solve(np.where(binds, lacks, 0.0))
        side = np.where(self.latched == 0.0, self._stops, 0.0)[self._of] * self._free
        for _ in range(ROUNDS if side.any() else 0):
            more = side * (self._answers(self._now, self._give) @ share - lacks)
            wrong = np.where(binds, side * share > 0.0, more > STILL * np.abs(lacks).max())
            if not wrong.any():
                break
            binds = binds ^ (np.arange(len(binds)) == wrong.argmax())
            share = self._solver(self._now, self._give, binds)(np.where(binds, lacks, 0.0))
        return share, binds

    def _rows(self, bodies: Bodies, time: float) -> JointRows:
        """All rows where the bodies stand at ``time``, s."""
        place, turn, velocity, spin = self._standing(bodies, time)
        one, other = self._first[self._of], self._second[self._of]
        here = place[one] + turned(turn[one], self._here[self._of] - self._reference[one])
        there = place[other] + turned(turn[other], self._there[self._of] - self._reference[other])
        over = self._over[self._of]
        apart, way = here - there - over, turned(turn[other], self._way)
        distance = np.sqrt((apart**2).sum(axis=1))
        is_length = self._what == LENGTH
        way = np.where(is_length[:, None], apart / np.where(distance > 0.0, distance, 1.0)[:, None], way)
        slides = self._ways[:, None]
        arm = np.where(is_length[:, None], there, here - over) - place[other]
        push = np.where(slides, way, 0.0)
        twist = np.where(slides, np.cross(here - place[one], way), way)
        back = np.where(slides, np.cross(arm, way), way)
        relative = turn[one] @ turn[other].transpose(0, 2, 1)
        sine, cosine = vector_of(relative), 0.5 * (np.trace(relative, axis1=1, axis2=2) - 1.0)
        tilted = np.cross(turned(turn[other], self._axis), turned(turn[one], self._axis))
        along = {
            SLIDE: apart,
            TURN: sine,
            TILT: tilted,
            LENGTH: apart,
            GO: apart,
            SPIN: sine,
        }
        gap = sum(np.where(self._what == what, (way * of).sum(axis=1), 0.0) for what, of in along.items())
        gap = np.where(self._what == SPIN, np.arctan2(gap, cosine), gap - self._length * is_length)
        told = -(push * velocity[other]).sum(axis=1) - (back * spin[other]).sum(axis=1)
        return JointRows(gap, push, twist, back, told)

    def _standing(self, bodies: Bodies, time: float) -> tuple[np.ndarray, ...]:
        """Place and turn of bodies and of what leads them; velocity and spin of what leads, 0 of bodies."""
        poses = [one.pose(time) if one else None for one in self._leaders]
        still = ORIGIN, np.eye(3), ORIGIN, ORIGIN
        led = [
            (p.translation, np.reshape(p.rotation, (3, 3)), p.velocity, p.angular_velocity) if p else still
            for p in poses
        ]
        none = np.zeros_like(bodies.place)
        own = bodies.place, bodies.turn, none, none
        return tuple(
            np.concatenate([of, np.reshape([k[n] for k in led], (-1, *of.shape[1:]))])
            for n, of in enumerate(own)
        )

    def _rates(self, rows: JointRows, velocity: np.ndarray, spin: np.ndarray) -> np.ndarray:
        """How fast gaps open, m/s or rad/s (m,), of bodies with this ``velocity`` and ``spin`` (n, 3)."""
        one, other = self._first[self._of], np.minimum(self._second[self._of], len(velocity) - 1)
        first = (rows.push * velocity[one]).sum(axis=1) + (rows.twist * spin[one]).sum(axis=1)
        second = (rows.push * velocity[other]).sum(axis=1) + (rows.back * spin[other]).sum(axis=1)
        return first - np.where(self._second[self._of] < len(velocity), second, 0.0) + rows.told

    def _whole(self, rows: JointRows, give: Yielding) -> tuple[np.ndarray, np.ndarray]:
        """Impulses and moments on the bodies (m, n, 6) of unit impulses of the rows, and what these change of
        velocities and spins."""
        count, m = len(give.sliding), len(self._of)
        one, other, each = self._first[self._of], self._second[self._of], np.arange(m)
        whole, free = np.zeros((m, count, 6)), other < count
        whole[each, one] = np.hstack([rows.push, rows.twist])
        whole[each[free], other[free]] -= np.hstack([rows.push, rows.back])[free]
        moved = np.concatenate(
            [whole[:, :, :3] * give.sliding, np.einsum("mnd,nde->mne", whole[:, :, 3:], give.turning)], axis=2
        )
        return whole, moved

    def _answers(self, rows: JointRows, give: Yielding) -> np.ndarray:
        """How fast the gap of a row opens after a unit impulse of another (m, m)."""
        return answering(*self._whole(rows, give))

    def _solver(
        self, rows: JointRows, give: Yielding, binds: np.ndarray
    ) -> Callable[[np.ndarray], np.ndarray]:
        """What finds the impulses (m,) of the rows that bind, by the rates (m,) that they have to make."""
        rows_held = np.flatnonzero(binds)
        factors = factored(self._answers(rows, give)[np.ix_(rows_held, rows_held)])

        def solve(rates: np.ndarray) -> np.ndarray:
            found = np.zeros(len(binds))
            found[rows_held] = solved(factors, rates[rows_held])
            return found

        return solve

    def _sums(self, rows: JointRows, share: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Impulses and their moments about the reference points (n, 3) of each body."""
        count = len(self._reference) - len(self._leaders)
        found = np.zeros((2, len(self._reference), 3))
        for of, first, second in zip(found, (rows.push, rows.twist), (rows.push, rows.back)):
            np.add.at(of, self._first[self._of], share[:, None] * first)
            np.add.at(of, self._second[self._of], -share[:, None] * second)
        return found[0, :count], found[1, :count]

    def _act(self, bodies: Bodies, rows: JointRows, share: np.ndarray) -> None:
        """Let impulses act, and add them to those of the step."""
        bodies.shoved(*self._sums(rows, share))
        self._note(rows, share)

    def _note(self, rows: JointRows, share: np.ndarray) -> None:
        slides = (rows.push != 0.0).any(axis=1)[:, None]
        np.add.at(self.push, self._of, share[:, None] * rows.push)
        np.add.at(self.twist, self._of, np.where(slides, 0.0, share[:, None] * rows.twist))

    def _bear(self, bodies: Bodies, impulses: tuple[np.ndarray, np.ndarray], dt: float) -> None:
        """What bears bodies, by the impulses of half a step of ``dt`` s."""
        bodies.bearing, bodies.bearing_turn = (2.0 * one / dt if dt > 0.0 else one for one in impulses)

    def _told(self, name: str) -> np.ndarray:
        """A number of the joint of each row."""
        return np.array([getattr(one, name) for one in self.joints])[self._of]


def _moving(bodies: Bodies) -> tuple[np.ndarray, np.ndarray]:
    """Velocities and spins (n, 3), of their own."""
    return bodies.velocity, bodies.spin_by(bodies.angular_momentum)
