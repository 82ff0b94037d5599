"""The softened pull of a mass, and its potential."""

import math

import numpy as np
import pytest

from psph.physics.self_gravity import FINE, REACH, STEEPEST, growing_depth, softened, softened_by_both
from psph.smoothing import kernel

H = 0.6


def field(r):
    """g and f at the distances ``r``."""
    return np.array([softened(one, H) for one in r]).T


def test_the_pull_is_the_slope_of_the_potential():
    r, d = np.linspace(0.01, 1.5, 400), 1e-6
    g, _ = field(r)
    slope = (field(r + d)[1] - field(r - d)[1]) / (2 * d)
    assert r * g == pytest.approx(-slope, rel=1e-7, abs=1e-8)
    assert np.abs(1 / r[r < H / 2] ** 2 / -slope[r < H / 2]).min() > 1.4  # the control: Newton's is another


def test_the_pull_is_that_of_the_mass_of_the_kernel_within():
    """r³ g = ∫ 4πs² W(s) ds up to r, W the Wendland C2 kernel of the support H; from there on 1."""
    r = np.linspace(1e-4, 1.2 * H, 20001)
    w = kernel("wendland-c2", H / 2, 3)
    shell = 4 * math.pi * r**2 * np.array([w.w(one) for one in r])
    within = np.concatenate([[0.0], np.cumsum(0.5 * (shell[1:] + shell[:-1]) * np.diff(r))])
    assert field(r)[0] * r**3 == pytest.approx(within, abs=1e-6)
    beyond = r > H
    assert field(r[beyond]) == pytest.approx(np.array([1 / r[beyond] ** 3, 1 / r[beyond]]), rel=1e-14)


def test_a_mass_has_the_depth_of_its_softening_length():
    assert softened(0.0, H) == pytest.approx((14 / H**3, REACH / H))
    r = np.linspace(0.0, 2 * H, 5001)
    steepest = float((r * field(r)[0]).max()) * (H / REACH) ** 2
    assert 0.99 * STEEPEST < steepest < STEEPEST


def test_a_pair_of_two_sizes_has_the_mean_of_both_fields_and_a_depth_that_changes_with_them():
    """∂f/∂H = −D/H²."""
    r, d = np.linspace(0.0, 1.0, 101), 1e-6
    slope = [(softened(one, H + d)[1] - softened(one, H - d)[1]) / (2 * d) for one in r]
    assert [-growing_depth(one / H) / H**2 for one in r] == pytest.approx(slope, abs=1e-6)
    assert growing_depth(0.0) == 3.0 and growing_depth(1.0) == growing_depth(2.0) == 0.0
    both = np.array([softened(0.3, H), softened(0.3, 2 * H)])
    assert softened_by_both(0.3, H, 2 * H) == pytest.approx(both.mean(axis=0), rel=1e-14)
    assert np.ptp(both, axis=0).min() > 0.1


@pytest.mark.parametrize(("softening", "kept"), [(0.1, True), (1e-3, False)])
def test_masses_pass_each_other_closely(softening, kept):
    """Two of 1 kg fall from 1 m, 1 mm beside each other, by leapfrog in steps of √(0.05 ε/|a|), ε = 0.1 m: their
    energy comes back; without so much softening a step throws them apart."""

    def pull(x):
        return -2.0 * softened(float(np.hypot(*x)), REACH * softening)[0] * x

    def energy(x, v):
        return 0.5 * v @ v - 2.0 * softened(float(np.hypot(*x)), REACH * softening)[1]

    x, v, time = np.array([1.0, 0.0]), np.array([0.0, 1e-3]), 0.0
    start, a, most = energy(x, v), pull(x), 0.0
    while time < 6.0:
        most = max(most, min(float(np.hypot(*a)), 2.0 * STEEPEST / 0.1**2))
        dt = math.sqrt(FINE * 0.1 / most)
        v += 0.5 * dt * a
        x = x + dt * v
        a = pull(x)
        v += 0.5 * dt * a
        time += dt
    assert (abs(energy(x, v) / start - 1.0) < 0.05) == kept
