"""A bracket that is thrown and tumbles far from all else, in a scene in 3D, against Newton's and Euler's equations."""

import numpy as np
import pytest
from drafts import draft
from scipy.integrate import solve_ivp
from simulation.test_floating import started

SCENE = """
space = { dimensions = 3, spacing = 0.05 }
time.end = 10.0
physics.gravity = [0.5, 0.0, -9.81]
fluids.water.shape.box = { lower = [0.0, 0.0, 0.0], upper = [0.2, 0.2, 0.2] }
walls.floor.shape.box = { lower = [-0.1, -0.1, -0.15], upper = [0.3, 0.3, 0.0] }
[bodies.bracket]
shape.union = [
  { box = { lower = [-0.2, 0.0, 4.0], upper = [0.5, 0.15, 4.15] } },
  { box = { lower = [-0.2, 0.0, 4.0], upper = [-0.05, 0.4, 4.15] } },
  { box = { lower = [-0.2, 0.0, 4.0], upper = [-0.05, 0.15, 4.3] } },
]
density = 700.0
velocity = [0.3, -0.2, 1.0]
spin = [1.0, 6.0, -2.0]
"""
"""Moments of inertia in the ratio of 1 : 4.1 : 4.5 and no plane of symmetry."""
GRAVITY, THROWN, SPIN = np.array([0.5, 0.0, -9.81]), np.array([0.3, -0.2, 1.0]), np.array([1.0, 6.0, -2.0])


def turned(inertia, end):
    """Turn and spin in the body at ``end``, s: Ṙ = R[ω]×, I ω̇ = Iω × ω."""

    def rates(_, state):
        turn, w = state[:9].reshape(3, 3), state[9:]
        cross = np.array([[0.0, -w[2], w[1]], [w[2], 0.0, -w[0]], [-w[1], w[0], 0.0]])
        return np.r_[(turn @ cross).ravel(), np.linalg.solve(inertia, np.cross(inertia @ w, w))]

    start = np.r_[np.eye(3).ravel(), SPIN]
    state = solve_ivp(rates, (0.0, end), start, rtol=1e-11, atol=1e-12, method="DOP853").y[:, -1]
    return state[:9].reshape(3, 3), state[9:]


def test_a_bracket_tumbles_as_newton_and_euler_say(tmp_path):
    """Measured in steps as long as those of one pass: turn within 2e-7, spin 2e-6 rad/s of 6; in twice as long ones
    four times that."""
    simulation, bodies, _ = started(draft(tmp_path, SCENE, "time.cfl=0.125"))
    begun, momentum, end = bodies.centre[0].copy(), bodies.angular_momentum[0].copy(), 0.6
    inertia, mass = bodies.inertia[0], bodies.mass[0, 0]
    while simulation.time < end:
        simulation.step(end)
    assert bodies.centre[0] == pytest.approx(begun + THROWN * end + 0.5 * GRAVITY * end**2, abs=1e-11)
    assert np.array_equal(bodies.angular_momentum[0], momentum)
    speed = THROWN + GRAVITY * end
    own = bodies.kinetic_energy()[0] - 0.5 * mass * speed @ speed
    assert own == pytest.approx(0.5 * SPIN @ inertia @ SPIN, rel=1e-6)
    turn, spin = turned(inertia, end)
    assert bodies.turn[0] == pytest.approx(turn, abs=1e-6)
    assert bodies.turn[0].T @ bodies.spin[0] == pytest.approx(spin, abs=1e-6 * 6.5)
    store = simulation.store
    held = np.flatnonzero(store.shown("group") == 2)
    there = [bodies.at(0, anchor)[0] for anchor in store.shown("anchor")[held]]
    assert store.shown("position")[held] == pytest.approx(np.array(there), abs=1e-12)
