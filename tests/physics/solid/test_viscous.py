"""Stress that relaxes, at one material point: the series of Prony, creep back to nothing, turns, energy that is lost."""

import numpy as np
import pytest
from physics.solid.test_laws import LAME, SHEAR, axis, rows, turned

from psph.physics.solid.history import History
from psph.physics.solid.laws import NeoHookean
from psph.physics.solid.viscous import Branch, Viscoelastic

LAW = NeoHookean(LAME, SHEAR)
BRANCHES = (Branch(0.7 * SHEAR, 0.1), Branch(0.3 * SHEAR, 1.0))
RELAXING = Viscoelastic(LAW, BRANCHES)


def fresh(d, branches=2):
    return History(None, None, None, None, ((0.0,) * (d * (d + 1) // 2),) * branches)


def held(f, times, d, past=None):
    """P at some times (s) after a deformation at once, by steps between them, and the history at the end."""
    past, found = past or fresh(d), []
    for dt in np.diff(times, prepend=0.0):
        p, past = RELAXING.flow(rows(f), past, dt, axis(d))
        found.append(np.reshape(p, (d, d)))
    return np.array(found), past


@pytest.mark.parametrize("d", (2, 3))
def test_a_shear_that_is_held_relaxes_by_prony(d):
    f, times = np.eye(d), np.linspace(0.0, 2.0, 401)
    f[0, 1] = 1e-4
    found, _ = held(f, times, d)
    expected = SHEAR + sum(one.shear * np.exp(-times / one.time) for one in BRANCHES)
    assert found[:, 0, 1] == pytest.approx(1e-4 * expected, rel=1e-4)


def test_a_change_of_volume_does_not_relax():
    found, _ = held(1.01 * np.eye(3), np.linspace(0.0, 2.0, 11), 3)
    assert found == pytest.approx(np.broadcast_to(found[0], found.shape), rel=1e-10)


def test_pulled_far_it_relaxes_to_the_law_that_lasts():
    f = np.diag([2.5, 0.6, 0.8])
    found, past = held(f, np.linspace(0.0, 30.0, 301), 3)
    lasts = np.reshape(LAW.stress(rows(f), axis(3)), (3, 3))
    assert (
        found[-1] == pytest.approx(lasts, rel=1e-6, abs=1e-6 * SHEAR) and found[0, 0, 0] > 1.3 * lasts[0, 0]
    )
    assert RELAXING.energy(rows(f), past, axis(3)) == pytest.approx(LAW.energy(rows(f), axis(3)), rel=1e-6)


@pytest.mark.parametrize("d", (2, 3))
def test_energy_is_lost_and_never_won(d):
    """To and fro, large: what comes back is less than what went in; the stored energy falls while it is held."""
    past, work, before = fresh(d), 0.0, np.eye(d)
    p = np.zeros((d, d))
    for t in np.linspace(0.0, 2.0 * np.pi, 2001)[1:]:
        f = np.eye(d)
        f[0, 1] = 0.8 * np.sin(t)
        now, past = RELAXING.flow(rows(f), past, 2.0 * np.pi / 2000 * 0.1, axis(d))
        now = np.reshape(now, (d, d))
        work += 0.5 * ((now + p) * (f - before)).sum()
        p, before = now, f
    stored = RELAXING.energy(rows(before), past, axis(d))
    assert 0.0 < stored < 0.5 * work
    _, later = held(before, np.linspace(0.1, 0.5, 5), d, past)
    assert RELAXING.energy(rows(before), later, axis(d)) < stored


@pytest.mark.parametrize("d", (2, 3))
def test_stress_turns_along(d):
    f, turn = np.eye(d) + 0.2 * np.random.default_rng(5).standard_normal((d, d)), turned(1.2, d)
    times = np.linspace(0.0, 0.3, 4)
    (one, past), (two, _) = held(f, times, d), held(turn @ f, times, d)
    assert two == pytest.approx(turn @ one, rel=1e-9, abs=1e-9 * SHEAR)
    alike = RELAXING.stress(rows(f), past, axis(d))
    assert np.reshape(alike, (d, d)) == pytest.approx(one[-1], rel=1e-9)


def test_across_is_that_of_three_dimensions():
    f = np.eye(2) + 0.2 * np.random.default_rng(6).standard_normal((2, 2))
    whole = np.eye(3)
    whole[:2, :2] = f
    times = np.linspace(0.0, 0.3, 4)
    (plane, past), (space, _) = held(f, times, 2), held(whole, times, 3)
    assert plane[-1] == pytest.approx(space[-1][:2, :2], rel=1e-10)
    assert RELAXING.across(rows(f), past, axis(2)) == pytest.approx(space[-1][2, 2], rel=1e-10)


def test_a_branch_that_this_solid_does_not_have_stays():
    other = ((0.0,) * 3, (0.0,) * 3, (0.1, 0.2, 0.3))
    past = History(None, None, None, None, other)
    _, now = RELAXING.flow((1.2, 0.1, 0.0, 1.0), past, 0.1, axis(2))
    assert now.branches[2] == other[2] and now.branches[0] != other[0]
