"""A square bar of rubber in 3D, clamped at one end, four particles across: it swings about its axis and across it."""

import numpy as np
import pytest
from drafts import draft
from gauging import start

from psph.physics.solid.shares import HELD

SIDE, LENGTH, DX, DENSITY, YOUNG, POISSON = 0.02, 0.2, 0.005, 1000.0, 2.0e6, 0.3
CLAMP = 9 * DX

BAR = f"""
time.end = 1.0
space = {{ dimensions = 3, spacing = {DX} }}
[solids.bar]
shape.box = {{ lower = [{-CLAMP}, 0.0, 0.0], upper = [{LENGTH}, {SIDE}, {SIDE}] }}
clamped.box = {{ lower = [{-CLAMP}, 0.0, 0.0], upper = [0.0, {SIDE}, {SIDE}] }}
density = {DENSITY}
young = {YOUNG}
poisson = {POISSON}
"""

TWIST = 4.0 * LENGTH * np.sqrt(DENSITY / (0.5 * YOUNG / (1.0 + POISSON)) / (6.0 * 0.140577))
"""s, 4L/c of torsion, c² = μJ/(ρI_p), J = 0.1406 a⁴ (Timoshenko & Goodier, Theory of Elasticity, § 109)."""
BEND = 1.0078 * 2.0 * np.pi * LENGTH**2 / 1.8751**2 * np.sqrt(12.0 * DENSITY / YOUNG) / SIDE
"""s, the first of a cantilever by Euler and Bernoulli, and what Timoshenko's shear and rotary inertia add to it."""
PERIODS = {"twist": TWIST, "bend": BEND}


def shape(kind, x, y, z):
    """The first mode, its displacements (n, 3) at places from the clamp and from the axis, m."""
    x, zero = np.maximum(x, 0.0), np.zeros(len(x))
    if kind == "twist":
        turn = np.sin(0.5 * np.pi * x / LENGTH)
        return np.stack([zero, -turn * z, turn * y], axis=1)
    b, r = 1.8751 / LENGTH, 0.7341
    across = np.cosh(b * x) - np.cos(b * x) - r * (np.sinh(b * x) - np.sin(b * x))
    slope = b * (np.sinh(b * x) + np.sin(b * x) - r * (np.cosh(b * x) - np.cos(b * x)))
    return np.stack([-slope * y, across, zero], axis=1)


def period(kind, case):
    """Twice the time, s, after which a bar that starts in its first mode is straight again."""
    simulation = start(case)
    store = simulation.store
    x, y, z = store.shown("reference").T
    mode = shape(kind, x, y - 0.5 * SIDE, z - 0.5 * SIDE)
    for name in ("velocity", "predicted_velocity"):
        for of, value in zip(store[name], 0.01 / PERIODS[kind] * mode.T):
            of[store.inner] = value
    told = []
    while simulation.time < 0.6 * PERIODS[kind]:
        simulation.step()
        moved = store.shown("position") - store.shown("reference")
        told.append((simulation.time, (moved * mode).sum()))
    time, swung = np.transpose(told)
    last = np.flatnonzero(swung > 0.0)[-1]
    assert last + 1 < len(time)
    return 2.0 * (time[last] + swung[last] / (swung[last] - swung[last + 1]) * (time[last + 1] - time[last]))


@pytest.mark.parametrize("kind", PERIODS)
def test_a_bar_four_particles_across_has_the_periods_of_theory(kind, tmp_path):
    assert period(kind, draft(tmp_path, BAR)) == pytest.approx(PERIODS[kind], rel=0.03)


def test_a_control_for_plane_strain_twists_too_fast(tmp_path):
    """The control: the default of 2D, and no shares."""
    assert period("twist", draft(tmp_path, BAR, "solids.bar.hourglass=1.5")) < 0.92 * TWIST


def test_shares_are_handed_out_whole(tmp_path):
    """What is clamped counts more; corners of the free end are held to 2."""
    store = start(draft(tmp_path, BAR)).store
    x, y, z = (store.shown("reference") / DX).T
    share = store.shown("share") / np.where(x < 0.0, HELD, 1.0)
    section = np.abs(x - 20.5) < 0.1
    assert share[section].mean() == pytest.approx(1.0, rel=1e-12)
    edge = np.abs(y - 2.0) + np.abs(z - 2.0) > 2.5
    inside = np.abs(y - 2.0) + np.abs(z - 2.0) < 1.5
    assert (share[section & edge] > 1.5).all() and (share[section & inside] < 0.6).all()
    assert share.max() == 2.0 and share.min() > 0.0
