"""Joints of rigid bodies: exact motions, gaps, energy, momenta, limits."""

import math

import numpy as np
import pytest

from psph.physics.rigid.bodies import Bodies
from psph.physics.rigid.body import RigidBody
from psph.physics.rigid.joints import Joint, Joints
from psph.physics.rigid.pose import Pose

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
FLAT, DEEP = (X, Y), (X, Y, Z)
PULL = (0.0, -9.81, 0.0)


def rod(start, end, mass=1.0, spatial=False, velocity=(0.0, 0.0, 0.0), spin=(0.0, 0.0, 0.0), wide=1e-3):
    """A rod from here to there, in the plane of x and y."""
    start, end = np.array(start), np.array(end)
    along = (end - start) / np.linalg.norm(end - start)
    about = mass * ((end - start) @ (end - start)) / 12.0
    inertia = about * (np.eye(3) - np.outer(along, along)) + wide * mass * np.eye(3)
    return RigidBody(
        "rod",
        mass,
        tuple(0.5 * (start + end)),
        tuple(inertia.ravel()),
        velocity,
        spin,
        (True, True, spatial),
        (spatial, spatial, True),
    )


def hinge(body, other, at, spatial=False, **keys):
    """About z."""
    held = {"slides": DEEP, "tilts": FLAT, "axis": Z} if spatial else {"slides": FLAT}
    return Joint("hinge", body, other, at, at, **held, along=Z, **keys)


class Dry:
    """Bodies and joints that nothing but gravity moves."""

    def __init__(self, bodies, joints, pull=PULL):
        self.bodies, self.time, self.widest = Bodies(bodies, pull), 0.0, 0.0
        self.joints = Joints(joints, self.bodies)
        self._load()

    def _load(self):
        self.bodies.load(*self.joints.pulls(self.bodies))

    def go(self, steps, dt):
        """So many steps; returns the energy after each."""
        found = []
        for _ in range(steps):
            self.time += dt
            self.bodies.drift(self.time, dt, None, self.joints)
            self._load()
            self.bodies.kick(self.time, dt, None, self.joints)
            self.widest = max(self.widest, self.joints.widest()[0])
            found.append(self.energy)
        return np.array(found)

    @property
    def energy(self):
        """Kinetic and of weight, J."""
        return self.bodies.kinetic_energy().sum() - (self.bodies.weight * self.bodies.centre).sum()

    @property
    def momenta(self):
        """Linear and angular, about the origin."""
        b = self.bodies
        p = b.mass * b.ahead
        return np.concatenate([p.sum(axis=0), (b.angular_momentum + np.cross(b.place, p)).sum(axis=0)])


def double_pendulum(end, steps=4000):
    """Angles and rates of two rods of 1 m and 1 kg that start level, by Lagrange's equations and Runge & Kutta."""
    wide = 1e-3

    def rates(s):
        a, b, u, v = s
        matrix = [[4.0 / 3.0 + wide, 0.5 * math.cos(a - b)], [0.5 * math.cos(a - b), 1.0 / 3.0 + wide]]
        right = (
            -0.5 * math.sin(a - b) * v * v - 1.5 * 9.81 * math.cos(a),
            0.5 * math.sin(a - b) * u * u - 0.5 * 9.81 * math.cos(b),
        )
        return np.array([u, v, *np.linalg.solve(matrix, right)])

    s, h = np.zeros(4), end / steps
    for _ in range(steps):
        one = rates(s)
        two = rates(s + 0.5 * h * one)
        three = rates(s + 0.5 * h * two)
        s = s + h / 6.0 * (one + 2.0 * two + 2.0 * three + rates(s + h * three))
    return s


@pytest.mark.parametrize("spatial", (False, True))
def test_a_double_pendulum(spatial):
    """Converges to Lagrange's equations in second order."""
    exact, off = double_pendulum(1.0), []
    for dt in (4e-3, 2e-3):
        bodies = [rod((k, 0, 0), (k + 1.0, 0, 0), spatial=spatial) for k in (0, 1)]
        dry = Dry(bodies, [hinge(k, k - 1 if k else None, (float(k), 0.0, 0.0), spatial) for k in (0, 1)])
        dry.go(round(1.0 / dt), dt)
        off.append(np.abs([dry.bodies.turned(k)[2] - exact[k] for k in (0, 1)]).max())
        assert dry.joints.ways == pytest.approx([exact[0], exact[1] - exact[0]], abs=1e-3)
        assert dry.widest < 1e-12
    assert off[1] < 5e-5 and off[0] / off[1] == pytest.approx(4.0, rel=0.05)


@pytest.mark.parametrize("steps", (800, pytest.param(10000, marks=pytest.mark.long)))
def test_a_chain_of_ten_keeps_its_joints(steps):
    """To 1e-11 of a link; its energy stays within 2 % of what it falls.  Control: without joints they part."""
    bodies = [rod((0.1 * k, 0, 0), (0.1 * k + 0.1, 0, 0), wide=1e-5) for k in range(10)]
    dry = Dry(bodies, [hinge(k, k - 1 if k else None, (0.1 * k, 0.0, 0.0)) for k in range(10)])
    before = dry.energy
    energy = dry.go(steps, 1e-3)
    assert dry.widest < 1e-12
    assert np.abs(energy - before).max() < 0.02 * 9.81 * 10 * 0.5
    loose = Dry(bodies, [hinge(0, None, (0.0, 0.0, 0.0))])
    loose.go(100, 1e-3)
    (end, _), (start, _) = (
        loose.bodies.at(0, np.array((0.1, 0, 0))),
        loose.bodies.at(1, np.array((0.1, 0, 0))),
    )
    assert np.abs(end - start).max() > 0.01


def test_a_slider_and_a_crank():
    """A crank that turns as it is told drives a piston: x = r cos φ + √(l² − r² sin² φ)."""

    class Crank:
        def pose(self, t):
            c, s = math.cos(2.0 * t), math.sin(2.0 * t)
            turn = (c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0)
            return Pose(rotation=turn, angular_velocity=(0.0, 0.0, 2.0))

    pin, piston = (0.3, 0.0, 0.0), (1.3, 0.0, 0.0)
    bodies = [rod(pin, piston), rod((1.25, 0, 0), (1.35, 0, 0))]
    joints = [
        hinge(0, None, pin, leader=Crank()),
        hinge(1, 0, piston),
        Joint("guide", 1, None, piston, piston, slides=(Y,), turns=(Z,), along=X, goes=True),
    ]
    dry = Dry(bodies, joints, (0.0, 0.0, 0.0))
    for _ in range(10):
        dry.go(40, 5e-3)
        phi = 2.0 * dry.time
        exact = 0.3 * math.cos(phi) + math.sqrt(1.0 - (0.3 * math.sin(phi)) ** 2)
        assert dry.joints.ways[2] + 1.3 == pytest.approx(exact, abs=1e-11)
    assert dry.widest < 1e-12


def test_what_flies_keeps_its_momenta():
    """Two bodies on a ball joint, of unlike masses, that tumble: to rounding, energy to 1e-4."""
    bodies = [
        rod((0, 0, 0), (1.0, 0, 0), 1.0, True, (0.0, 0.2, 0.5), (1.0, 2.0, -1.0), 0.05),
        rod((1.0, 0, 0), (1.0, 0.6, 0), 3.0, True, (0.3, 0.0, -0.2), (0.0, -1.0, 2.0), 0.02),
    ]
    ball = Joint("ball", 1, 0, X, X, slides=DEEP)
    dry = Dry(bodies, [ball], (0.0, 0.0, 0.0))
    dry.joints.rest(dry.bodies, 0.0)
    dry.bodies._show(np.ones((2, 1), bool), dry.bodies.velocity, dry.bodies.angular_momentum)
    before, energy = dry.momenta, dry.energy
    after = dry.go(400, 2e-3)
    assert dry.momenta == pytest.approx(before, abs=1e-11)
    assert np.abs(after / energy - 1.0).max() < 1e-4 and dry.widest < 1e-12
    assert not np.allclose(dry.bodies.ahead[0], bodies[0].velocity, atol=0.1)


def test_what_is_fixed_moves_as_one():
    """Two halves of a rod swing as the rod does, to the order of the steps."""
    halves = Dry(
        [rod((0, 0, 0), (0.5, 0, 0), 0.5, wide=0.0), rod((0.5, 0, 0), (1.0, 0, 0), 0.5, wide=0.0)],
        [hinge(0, None, (0.0, 0.0, 0.0)), Joint("weld", 1, 0, X, X, slides=FLAT, turns=(Z,))],
    )
    whole = Dry([rod((0, 0, 0), (1.0, 0, 0), wide=0.0)], [hinge(0, None, (0.0, 0.0, 0.0))])
    for dry in (halves, whole):
        dry.go(400, 2e-3)
    assert halves.joints.ways[0] == pytest.approx(whole.joints.ways[0], abs=1e-5)
    assert halves.joints.ways[0] < -1.0


def test_a_rod_without_mass_is_a_pendulum():
    """Of a point mass: θ̈ = −g/l sin θ, its period at small angles."""
    ball = rod((0.05, -1, 0), (0.15, -1, 0), wide=0.0)
    dry = Dry([ball], [Joint("rod", 0, None, ball.centre, (0.0, 0.0, 0.0), length=math.hypot(0.1, 1.0))])
    crossings, last = [], 0.1
    for _ in range(1200):
        dry.go(1, 4e-3)
        x = dry.bodies.centre[0, 0]
        if last > 0.0 >= x:
            crossings.append(dry.time)
        last = x
    length, angle = math.hypot(0.1, 1.0), math.atan2(0.1, 1.0)
    period = 2.0 * math.pi * math.sqrt(length / 9.81) * (1.0 + angle**2 / 16.0)
    assert np.diff(crossings) == pytest.approx(period, rel=2e-3)


def test_springs_and_dampers_in_a_hinge():
    """ω² = k/I, and what swings fades by exp(−ζt/2I)."""
    inertia = 1.0 / 3.0
    dry = Dry(
        [rod((0, 0, 0), (1.0, 0, 0), spin=(0.0, 0.0, 1.0), velocity=(0.0, 0.5, 0.0), wide=0.0)],
        [hinge(0, None, (0.0, 0.0, 0.0), stiffness=30.0, damping=0.2)],
        (0.0, 0.0, 0.0),
    )
    assert dry.joints.longest_step() == pytest.approx(0.2 / math.sqrt(30.0 * 12.0))  # about the centre, free
    found = []
    for _ in range(1000):
        dry.go(1, 1e-3)
        found.append(dry.joints.ways[0])
    t = np.arange(1, 1001) * 1e-3
    decay = 0.2 / (2.0 * inertia)
    omega = math.sqrt(30.0 / inertia - decay**2)
    assert np.array(found) == pytest.approx(np.exp(-decay * t) * np.sin(omega * t) / omega, abs=2e-3 / omega)


@pytest.mark.parametrize("latch", (False, True))
def test_a_flap_stops_at_its_limit(latch):
    """It falls from level to −60° and rests there; lifted by a spin it leaves the limit, unless that latches."""
    limits = (-math.pi / 3.0, 1.0)
    dry = Dry([rod((0, 0, 0), (1.0, 0, 0))], [hinge(0, None, (0.0, 0.0, 0.0), limits=limits, latch=latch)])
    dry.go(800, 1e-3)
    assert dry.joints.ways[0] == pytest.approx(limits[0], abs=1e-12)
    assert np.abs(dry.bodies.spin_ahead).max() < 1e-12
    weight = 9.81 * 0.5 * math.cos(limits[0])  # its moment about the hinge
    assert dry.joints.twist[0, 2] / 1e-3 == pytest.approx(weight, rel=1e-6)
    dry.bodies.angular_momentum[0, 2] += 2.0
    dry.go(100, 1e-3)
    lifted = dry.joints.ways[0] - limits[0]
    assert lifted == pytest.approx(0.0, abs=1e-12) if latch else lifted > 0.05


@pytest.mark.parametrize("restitution", (0.3, 0.7, 1.0))
def test_what_meets_a_limit_goes_back(restitution):
    """With e times its speed: e² of the energy above the limit is left of each bounce, to 1e-3; then it rests there."""
    limits = (-math.pi / 3.0, 1.0)
    dry = Dry(
        [rod((0, 0, 0), (1.0, 0, 0), wide=0.0)],
        [hinge(0, None, (0.0, 0.0, 0.0), limits=limits, restitution=restitution)],
    )
    lowest = -9.81 * 0.5 * math.sin(math.pi / 3.0)
    above = np.concatenate([[dry.energy], dry.go(600, 4e-3)]) - lowest
    assert dry.widest < 1e-12
    drops = np.flatnonzero(above[1:] < 0.9 * above[:-1])
    if restitution == 1.0:
        assert not len(drops) and above[-1] == pytest.approx(above[0], rel=1e-3)
        return
    lost = above[drops + 1] / above[drops]
    assert lost[:3] == pytest.approx(restitution**2, abs=1e-3)
    if restitution == 0.3:
        assert above[-1] == pytest.approx(0.0, abs=1e-9) and dry.joints.ways[0] == pytest.approx(limits[0])


def test_many_limits_at_once_are_kept_and_give_no_energy():
    """Six links of 0.3 m that fall from level until all of their limits bear: what bars a limit that has let go
    once in a step left them by 5 degrees, and won 340 J."""
    limits = (-math.pi / 18.0, math.pi / 18.0)
    bodies = [rod((0.3 * k, 0, 0), (0.3 * k + 0.3, 0, 0), 20.0) for k in range(6)]
    joints = [hinge(k, k - 1 if k else None, (0.3 * k, 0.0, 0.0), limits=limits) for k in range(6)]
    dry = Dry(bodies, joints)
    energy = np.concatenate([[dry.energy], dry.go(200, 4e-3)])
    assert np.diff(energy).max() < 1e-4 * (energy[0] - energy[-1])
    assert dry.joints.ways == pytest.approx([limits[0]] * 6, abs=1e-9)


def test_a_state_goes_on():
    """Saved and taken up again, with an angle of more than a turn: the same bits."""

    def made():
        return Dry(
            [rod((0, 0, 0), (1.0, 0, 0), spin=(0.0, 0.0, 9.0), velocity=(0.0, 4.5, 0.0))],
            [hinge(0, None, (0.0, 0.0, 0.0))],
        )

    one, other = made(), made()
    one.go(1000, 1e-3)
    other.bodies.restore(one.bodies.state())
    other.joints.restore(one.joints.state(), other.bodies)
    other.time = one.time
    for dry in (one, other):
        dry.go(50, 1e-3)
    assert one.joints.ways[0] > 2.0 * math.pi
    assert np.array_equal(one.bodies.place, other.bodies.place) and one.joints.ways == other.joints.ways
