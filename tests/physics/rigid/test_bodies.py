"""Rigid bodies without a fluid, against exact motions."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from psph.physics.rigid.bodies import Bodies
from psph.physics.rigid.body import RigidBody
from psph.physics.rigid.laws import Accelerated
from psph.physics.rigid.lines import Lines, SpringLine, longest_step
from psph.physics.rigid.motion import MotionPart, Rigid
from psph.physics.rigid.pose import Pose
from psph.physics.rigid.schedule import ActingTime

FREE, FIXED = (True,) * 3, (False,) * 3
BRICK = (2.0, 0.1, -0.2, 0.1, 3.0, 0.15, -0.2, 0.15, 4.5)
"""Inertia of a body without symmetry, kg m²."""


def body(**different):
    """A free body off the origin; what differs is given."""
    return RigidBody("brick", 3.0, (1.0, -2.0, 0.5), BRICK, (0.0,) * 3, (0.0,) * 3, FREE, FREE)._replace(
        **different
    )


def pulls(lines, bodies):
    """Forces and torques of springs, and their tensions."""
    one = Lines(lines, bodies)
    return *one.pulls(bodies, 0.0, 0.0), one.tensions


def moved(bodies, dt, steps, lines=()):
    """The bodies after so many steps under their weight and ``lines``."""
    held = Lines(lines, bodies)
    bodies.load(*held.pulls(bodies, 0.0, 0.0))
    for n in range(1, steps + 1):
        bodies.drift(n * dt, dt)
        bodies.load(*held.pulls(bodies, n * dt, dt))
        bodies.kick(n * dt, dt)
    return bodies


def test_free_fall_is_a_parabola():
    thrown = moved(Bodies([body(velocity=(1.0, 2.0, -0.5))], (0.3, 0.0, -9.8)), 1e-3, 1000)
    assert thrown.place[0] == pytest.approx([1.0 + 1.0 + 0.15, 0.0, 0.5 - 0.5 - 4.9], abs=1e-12)
    assert thrown.velocity[0] == pytest.approx([1.3, 2.0, -10.3], abs=1e-12)


def test_free_spin_keeps_its_angular_momentum_and_energy():
    spinning = Bodies([body(spin=(2.0, -1.0, 5.0)), body(spin=(0.1, 6.0, 0.2))], (0.0, 0.0, -9.8))
    momentum, energy = spinning.angular_momentum.copy(), spinning.kinetic_energy()
    spinning = moved(spinning, 1e-3, 3000)
    assert np.array_equal(spinning.angular_momentum, momentum)
    fallen = 0.5 * 3.0 * (9.8 * 3.0) ** 2
    assert spinning.kinetic_energy() - fallen == pytest.approx(energy, rel=1e-6)
    assert spinning.turn @ spinning.turn.transpose(0, 2, 1) == pytest.approx(
        np.array([np.eye(3)] * 2), abs=1e-12
    )
    assert not np.allclose(spinning.spin[0], [2.0, -1.0, 5.0], atol=0.1)  # it tumbles


def test_a_spinning_top_precesses_as_euler_says():
    # I = diag(1, 1, 2): ω turns about the axis of the top at (I₃ − I₁) ω₃/I₁ in the body, L stays.
    inertia = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0)
    top = Bodies([body(inertia=inertia, spin=(0.5, 0.0, 3.0))], (0.0,) * 3)
    dt, steps = 5e-4, 2000
    top = moved(top, dt, steps)
    own = top.turn[0].T @ top.spin[0]
    turned = 3.0 * dt * steps
    assert own == pytest.approx([0.5 * math.cos(turned), 0.5 * math.sin(turned), 3.0], abs=1e-6)


@pytest.mark.parametrize(
    "moments", [(1.06, 0.9, 0.34), (0.34, 1.06, 0.9), (0.34, 0.9, 1.06), (0.9, 0.34, 1.06)]
)
def test_a_body_turns_as_its_spin_says_however_its_axes_lie(moments):
    # Against Euler's equations, about no principal axis and near the middle one, where small errors grow.
    own = np.array(moments)
    start = np.array([0.3, 0.4, -0.5]) + 4.0 * (own == 0.9)
    tumbling = Bodies([body(inertia=tuple(np.diag(own).ravel()), spin=tuple(start))], (0.0,) * 3)
    energy, end = tumbling.kinetic_energy()[0], 1.5
    tumbling = moved(tumbling, 2e-3, 750)
    turned = solve_ivp(lambda t, w: -np.cross(w, own * w) / own, (0.0, end), start, rtol=1e-11, atol=1e-12).y[
        :, -1
    ]
    assert tumbling.turn[0].T @ tumbling.spin[0] == pytest.approx(turned, abs=1e-4)
    assert tumbling.kinetic_energy()[0] == pytest.approx(energy, rel=1e-6)
    one = moved(
        Bodies([body(inertia=tuple(np.diag(own).ravel()), spin=(0.0, 3.0, 0.0))], (0.0,) * 3), 1e-2, 30
    )
    assert one.turned(0) == pytest.approx([0.0, 0.9, 0.0], abs=1e-12)


def test_a_turn_about_one_axis_has_no_error():
    door = body(slides=FIXED, turns=(False, True, False), spin=(1.0, 4.0, 1.0))
    turned = moved(Bodies([door], (0.0, 0.0, -9.8)), 1e-2, 500)
    assert turned.angle == pytest.approx([20.0], abs=1e-12)
    assert turned.place[0] == pytest.approx([1.0, -2.0, 0.5]) and turned.spin[0] == pytest.approx(
        [0.0, 4.0, 0.0]
    )


def test_a_pendulum_swings_as_long_as_it_should():
    # About z in the plane: M 3 kg at 0.8 m, I_zz 4.5 about its centre; small swings: T = 2π √((I + Ml²)/Mgl).
    length, small = 0.8, 1e-3
    centre = (length * math.sin(small), -length * math.cos(small), 0.0)
    bob = body(centre=centre, pivot=(0.0, 0.0, 0.0), slides=FIXED, turns=(False, False, True))
    bodies = Bodies([bob], (0.0, -9.8))
    period = 2.0 * math.pi * math.sqrt((4.5 + 3.0 * length**2) / (3.0 * 9.8 * length))
    bodies = moved(bodies, period / 4000, 3000)  # three quarters: passing the middle
    assert bodies.centre[0, 0] == pytest.approx(0.0, abs=1e-3 * length * small)
    assert np.linalg.norm(bodies.centre[0]) == pytest.approx(length, rel=1e-14)


def test_a_hinge_bears_the_tension_of_its_pendulum():
    # Let go at the level of its hinge. At an angle θ below it, by energy: ω² = 2Mgl sin θ/I, I = 4.5 + Ml²;
    # along the rod R = Mg sin θ + Mlω², across it Mg cos θ (1 − Ml²/I).
    mass, length, g = 3.0, 0.8, 9.8
    bob = body(centre=(length, 0.0, 0.0), pivot=(0.0,) * 3, slides=FIXED, turns=(False, False, True))
    bodies = Bodies([bob], (0.0, -g))
    about, turned = 4.5 + mass * length**2, []
    for n in (1, 400, 300, 200):
        bodies = moved(bodies, 1e-3, n)
        angle = -bodies.angle[0]
        rate2 = 2.0 * mass * g * length * math.sin(angle) / about
        rod = np.array([math.cos(angle), -math.sin(angle), 0.0])
        across = np.array([math.sin(angle), math.cos(angle), 0.0])
        expected = -rod * mass * (g * math.sin(angle) + length * rate2)
        expected += across * mass * g * math.cos(angle) * (1.0 - mass * length**2 / about)
        force, moment = bodies.reaction
        assert force[0] == pytest.approx(expected, abs=2e-4 * mass * g)
        assert moment[0, 2] == 0.0
        turned.append(angle)
    assert max(turned) > 1.3


def test_a_hinge_bears_the_moments_that_would_tip_its_body():
    # A door that spins about y off its centre: ω × I ω in its plane, and the centripetal force.
    door = body(slides=FIXED, turns=(False, True, False), spin=(0.0, 4.0, 0.0))
    bodies = moved(Bodies([door], (0.0, 0.0, -9.8)), 1e-2, 50)
    force, moment = bodies.reaction
    assert force[0] == pytest.approx([0.0, 0.0, 3.0 * 9.8])
    there = bodies.turn[0] @ np.reshape(BRICK, (3, 3)) @ bodies.turn[0].T
    spin = np.array([0.0, 4.0, 0.0])
    assert moment[0] == pytest.approx(np.cross(spin, there @ spin)) and np.abs(moment[0]).max() > 1.0


def test_what_moves_a_body_pushes_it_and_what_is_free_needs_nothing():
    told = Rigid((MotionPart(Accelerated((2.0, 0.0, 0.5, 0.0)), ActingTime()),))
    pushed = body(slides=(False, True, False), turns=FIXED, motion=told)
    held = body(held=10.0)
    bodies = moved(Bodies([pushed, body(spin=(2.0, -1.0, 5.0)), held], (0.0, -9.8, 0.0)), 1e-2, 10)
    force, moment = bodies.reaction
    assert force == pytest.approx(np.array([[6.0, 0.0, 1.5], [0.0] * 3, [0.0, 29.4, 0.0]]))
    assert moment == pytest.approx(np.zeros((3, 3)), abs=1e-12)
    assert not force[1].any() and not moment[1].any()


def test_a_pendulum_on_a_hinge_that_speeds_up_leans_back():
    # In the frame of the hinge the weight is turned by atan(a/g): it swings about that angle, let go from rest.
    length, g, a = 0.8, 9.8, 2.0
    ahead = Rigid((MotionPart(Accelerated((a, 0.0, 0.0, 0.0)), ActingTime()),))
    bob = body(centre=(0.0, -length, 0.0), pivot=(0.0,) * 3, slides=FIXED, turns=(False, False, True))
    angles = {}
    for name, motion in (("ahead", ahead), ("still", None)):
        bodies, angles[name] = Bodies([bob._replace(motion=motion)], (0.0, -g)), []
        force, torque, _ = pulls((), bodies)
        bodies.load(force, torque)
        for n in range(1, 4000):
            bodies.drift(n * 1e-3, 1e-3)
            bodies.load(force, torque)
            bodies.kick(n * 1e-3, 1e-3)
            angles[name].append(float(bodies.angle[0]))
    lean = math.atan2(a, g)
    assert min(angles["ahead"]) == pytest.approx(-2.0 * lean, rel=1e-4)
    assert max(angles["ahead"]) == pytest.approx(0.0, abs=1e-4)
    assert not any(angles["still"])  # the control


def test_a_body_on_a_spring_swings_as_long_as_it_should_and_a_damper_brakes_it():
    spring = SpringLine("s", 0, (1.0, -2.0, 0.5), None, (1.0, -2.0, 1.5), 12.0, 1.0, 0.0, False)
    # Thrown off its rest along the line.
    swinging = Bodies([body(velocity=(0.0, 0.0, 0.1))], (0.0,) * 3)
    period = 2.0 * math.pi / math.sqrt(12.0 / 3.0)
    steps = 2000
    assert period / steps < longest_step([spring], swinging)
    swinging = moved(swinging, 0.75 * period / steps, steps, [spring])
    assert swinging.place[0, 2] - 0.5 == pytest.approx(-0.05, rel=1e-4)
    assert swinging.velocity[0, 2] == pytest.approx(0.0, abs=1e-4)
    damped = spring._replace(damping=0.6)
    braked = moved(Bodies([body(velocity=(0.0, 0.0, 0.1))], (0.0,) * 3), period / steps, steps, [damped])
    rate, swing = 0.6 / (2 * 3.0), math.sqrt(4.0 - (0.6 / 6.0) ** 2)
    exact = 0.1 / swing * math.exp(-rate * period) * math.sin(swing * period)
    assert braked.place[0, 2] - 0.5 == pytest.approx(exact, abs=1e-6)


LINES = {
    "a spring": ((12.0, 0.0), 1, 9.9),
    "a damper": ((0.0, 6.0), 1, 4.9),
    "both": ((12.0, 6.0), 1, 4.1),
    "ten springs": ((12.0, 0.0), 10, 9.9),
    "ten dampers": ((0.0, 6.0), 10, 4.9),
}
"""Stiffness and damping; how many stand side by side; and up to which times the limit is
stable: ω²Δt²/4 + ζΔt/m ≤ 1."""


def swung(lines, times):
    """The speed after 400 steps ``times`` as long as the limit, over that of the start."""
    swinging = Bodies([body(velocity=(0.0, 0.0, 0.1))], (0.0,) * 3)
    step = times * longest_step(lines, swinging)
    return abs(float(moved(swinging, step, 400, lines).velocity[0, 2])) / 0.1


@pytest.mark.parametrize("name", LINES)
def test_lines_are_stable_at_the_limit_of_the_step_however_many_they_are(name):
    """Six dampers, each at its own limit, had blown up.  The limit is of accuracy: five to ten times it, they do."""
    (stiffness, damping), count, beyond = LINES[name]
    lines = [
        SpringLine("l", 0, (1.0, -2.0, 0.5), None, (1.0, -2.0, 1.5), stiffness, 1.0, damping, False)
    ] * count
    assert swung(lines, 1.0) < 1.001 and swung(lines, beyond) < 1.001
    with np.errstate(over="ignore", invalid="ignore"):
        assert not swung(lines, 1.2 * beyond) < 1e3


def test_a_mooring_line_that_goes_slack_keeps_the_energy_at_the_limit_of_the_step():
    """Between two bodies; in steps four times as long it wins a tenth of the speed and more."""
    two = [body(velocity=(0.0, 0.0, -0.1)), body(centre=(1.0, -2.0, 1.5), velocity=(0.0, 0.0, 0.1))]
    line = SpringLine("l", 0, (1.0, -2.0, 0.5), 1, (1.0, -2.0, 1.5), 12.0, 1.0, 0.0, True)
    struck = moved(Bodies(two, (0.0,) * 3), step := longest_step([line], Bodies(two, (0.0,) * 3)), 30, [line])
    assert step == pytest.approx(0.2 / math.sqrt(8.0)) and struck.velocity[0, 2] == pytest.approx(
        0.1, rel=0.01
    )
    rough = moved(Bodies(two, (0.0,) * 3), 4.0 * step, 8, [line])
    assert abs(rough.velocity[0, 2] - 0.1) > 0.005


def test_lines_between_bodies_push_back_what_pulls():
    bodies = Bodies([body(), body(mass=5.0, centre=(3.0, 0.0, 0.0))], (0.0,) * 3)
    line = SpringLine("l", 0, (1.2, -1.8, 0.4), 1, (2.5, 0.3, 0.1), 7.0, 0.5, 0.2, False)
    force, torque, tension = pulls([line], bodies)
    assert tension[0] > 1.0 and force.sum(axis=0) == pytest.approx([0.0] * 3, abs=1e-15)
    total = torque + np.cross(bodies.place, force)
    assert np.abs(torque).max() > 0.1 and total.sum(axis=0) == pytest.approx([0.0] * 3, abs=1e-14)
    slack = line._replace(length=5.0, pulls_only=True)
    assert not pulls([slack], bodies)[0].any()
    assert pulls([slack._replace(pulls_only=False)], bodies)[2][0] < 0.0


def test_a_held_body_stays_until_its_time():
    dropped = moved(Bodies([body(held=0.5)], (0.0, 0.0, -10.0)), 1e-3, 1000)
    assert dropped.place[0, 2] == pytest.approx(0.5 - 5.0 * 0.5**2, abs=0.02)
    assert moved(Bodies([body(held=2.0)], (0.0, 0.0, -10.0)), 1e-3, 1000).place[0, 2] == 0.5


@pytest.mark.parametrize("turns", [FREE, (False, False, True)])
def test_a_held_body_sets_off_at_its_release(turns):
    """Until then nobody sees its velocity; afterwards it goes as one does that was let go at the start."""
    thrown = body(velocity=(1.0, 2.0, -0.5), spin=(0.0, 0.0, 3.0), turns=turns)
    held = Bodies([thrown._replace(held=0.5)], (0.3, 0.0, -10.0))
    assert not held.ahead.any() and not held.spin.any()
    moved(held, 1 / 1024, 512)
    assert np.array_equal(held.place, [[1.0, -2.0, 0.5]]) and not held.ahead.any() and not held.spin.any()
    assert not held.acceleration.any() and not held.angular_acceleration.any()
    assert held.turn[0] == pytest.approx(np.eye(3), abs=1e-15) and not held.kinetic_energy().any()
    late, free = Bodies([thrown._replace(held=0.5)], (0.3, 0.0, -10.0)), Bodies([thrown], (0.3, 0.0, -10.0))
    moved(late, 1 / 1024, 1024), moved(free, 1 / 1024, 512)
    for name in ("place", "velocity", "ahead", "turn", "spin_ahead"):
        assert getattr(late, name) == pytest.approx(getattr(free, name), abs=1e-12), name


def test_a_body_falls_from_its_release_within_a_step():
    held = Bodies(
        [body(velocity=(1.0, 2.0, -0.5), spin=(0.0, 0.0, 3.0), held=0.1003, turns=(False, False, True))],
        (0.3, 0.0, -10.0),
    )
    moved(held, 1 / 64, 64)
    since = 1.0 - 0.1003
    assert held.place[0] == pytest.approx(
        [1.0 + since + 0.15 * since**2, -2.0 + 2.0 * since, 0.5 - 0.5 * since - 5.0 * since**2], abs=1e-12
    )
    assert held.velocity[0] == pytest.approx([1.0 + 0.3 * since, 2.0, -0.5 - 10.0 * since], abs=1e-12)
    assert held.angle == pytest.approx([3.0 * since], abs=1e-12)


def test_what_is_not_free_stays():
    guided = body(slides=(False, True, False), turns=FIXED, velocity=(1.0, 1.0, 1.0), spin=(1.0, 1.0, 1.0))
    bodies = moved(Bodies([guided], (1.0, 2.0, 3.0)), 1e-2, 100)
    assert bodies.place[0] == pytest.approx([1.0, -2.0 + 1.0 + 1.0, 0.5])
    assert np.array_equal(bodies.turn[0], np.eye(3)) and not bodies.spin.any()


class Swaying:
    """x = 0.2 sin 3t, turned by t² about z, through the reference point of the body below."""

    def pose(self, time):
        x, v, a = 0.2 * math.sin(3 * time), 0.6 * math.cos(3 * time), -1.8 * math.sin(3 * time)
        c, s = math.cos(time**2), math.sin(time**2)
        centre = (1.0, -2.0, 0.5)
        return Pose(
            centre,
            (1.0 + x, -2.0, 0.5),
            (c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0),
            (v, 0.0, 0.0),
            (0.0, 0.0, 2 * time),
            (a, 0.0, 0.0),
            (0.0, 0.0, 2.0),
        )


def test_what_is_prescribed_has_the_acceleration_of_its_motion():
    told = Bodies([body(slides=(False, True, False), turns=FIXED, motion=Swaying())], (5.0, -6.0, 7.0))
    told = moved(told, 1e-3, 700)
    assert told.acceleration[0] == pytest.approx([-1.8 * math.sin(2.1), -6.0, 0.0], abs=1e-12)
    assert told.angular_acceleration[0] == pytest.approx([0.0, 0.0, 2.0], abs=1e-12)
    resumed = Bodies(told.bodies, (5.0, -6.0, 7.0))
    resumed.restore(told.state())
    assert np.array_equal(resumed.acceleration, told.acceleration)


def test_a_held_body_has_no_acceleration_until_its_release():
    held = Bodies([body(held=0.5, spin=(0.0, 1.0, 2.0))], (1.0, -9.8, 2.0))
    assert not moved(held, 1e-2, 40).acceleration.any() and not held.angular_acceleration.any()
    assert moved(Bodies(held.bodies, (1.0, -9.8, 2.0)), 1e-2, 60).acceleration[0, 1] == -9.8
