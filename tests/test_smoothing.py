"""Kernels against their definition and against the lattice sums of the prototype."""

import math
from itertools import product

import numba
import numpy as np
import pytest
from remedies import FOLDER

from psph.case.extensions import catalogue_of
from psph.composition.space import BEYOND
from psph.moments import fastest_smoothing, moments_below_a_surface, normalised
from psph.smoothing import KERNELS, kernel, slope_over_r

H = 0.7
BESIDE = ("quadratic", "spiky")
"""Kernels of a file of run/remedies."""
ALL = [(name, dim) for name in (*KERNELS, *BESIDE) for dim in (1, 2, 3)]
JOINTS = sorted({0.0, 1.0, 2.0, 3.0, *(math.sqrt(2.0) * k for k in (1, 2, 3))})
"""r/h at which pieces of some spline join."""


@pytest.fixture(autouse=True)
def with_those_beside(kernels_as_they_were):
    """As a case that uses the file does."""
    catalogue_of(str(FOLDER / "case.toml"), ["kernels.py"])


def sphere(dim, r):
    return {1: 2.0, 2: 2 * math.pi * r, 3: 4 * math.pi * r * r}[dim]


@pytest.mark.parametrize("name, dim", ALL)
def test_weighs_one(name, dim):
    k = kernel(name, H, dim)
    nodes, weights = np.polynomial.legendre.leggauss(40)
    total = 0.0
    for a, b in zip(JOINTS, JOINTS[1:]):  # piece by piece
        r = H * (0.5 * (a + b) + 0.5 * (b - a) * nodes)
        share = sum(w * k.w(x) * sphere(dim, x) for w, x in zip(weights, r))
        total += 0.5 * (b - a) * H * share
    assert total == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("name, dim", ALL)
def test_slope_is_the_derivative(name, dim):
    k = kernel(name, H, dim)
    for r in np.linspace(0.01, k.support * H * 0.999, 57):
        if min(abs(r / H - s) for s in JOINTS) < 1e-3:
            continue
        step = 1e-6
        slope = (k.w(r + step) - k.w(r - step)) / (2 * step)
        assert k.dw(r) == pytest.approx(slope, rel=1e-5, abs=1e-6 * k.w(0.0) / H)
        assert k.dw(r) < 0.0 or not getattr(k, "repels", True)


@pytest.mark.parametrize("name, dim", ALL)
def test_slope_over_r(name, dim):
    k = kernel(name, H, dim)
    compiled = numba.njit(lambda k, r, inverse_r: slope_over_r(k, r, inverse_r))
    for r in (1e-3, 0.3, 0.9, 1.3, 5.0):
        expected = pytest.approx(k.dw(r) / r, rel=1e-12, abs=1e-30)
        assert slope_over_r(k, r, 1.0 / r) == expected and compiled(k, r, 1.0 / r) == expected


@pytest.mark.parametrize("name, dim", ALL)
def test_is_zero_beyond_its_support_and_where_rows_are_filled_up(name, dim):
    k = kernel(name, H, dim)
    for r in (k.support * H * (1 + 1e-12), 5 * H, BEYOND * H, 1e30):
        assert abs(k.w(r)) <= 1e-30 and abs(k.dw(r)) <= 1e-20


@pytest.mark.parametrize("dim", (1, 2, 3))
def test_the_fourth_order_kernel_has_no_second_moment(dim):
    nodes, weights = np.polynomial.legendre.leggauss(40)
    for name, vanishes in (("fourth-order", True), ("quintic", False)):
        k, moment = kernel(name, H, dim), 0.0
        for a, b in zip(JOINTS, JOINTS[1:]):
            r = H * (0.5 * (a + b) + 0.5 * (b - a) * nodes)
            moment += 0.5 * (b - a) * H * (weights * r**2 * sphere(dim, r) * list(map(k.w, r))).sum()
        assert (abs(moment) < 1e-12) == vanishes


def bend(k, r, step=1e-5):
    return (k.dw(r + step) - k.dw(r - step)) / (2 * step)


def test_which_kernels_are_convex():
    convex = {
        name
        for name in KERNELS
        if all(bend(kernel(name, 1.0, 2), r) >= -1e-9 for r in np.linspace(0.01, 2.9, 291))
    }
    assert convex == {"hyperbolic", "quadratic", "spiky"}


def test_hyperbolic_kernel_is_the_paper_s():
    k = kernel("hyperbolic", 1.0, 2)
    for s in (0.0, 0.3, 0.9):
        assert k.w(s) == pytest.approx((s**3 - 6 * s + 6) / (3 * math.pi))
    assert k.w(1.5) == pytest.approx(0.5**3 / (3 * math.pi))
    assert k.dw(0.0) == pytest.approx(-6 / (3 * math.pi))


def square_lattice(smoothing, dx=1.0, n=5):
    axis = np.arange(-n, n + 1) * dx
    x, y = np.meshgrid(axis, axis, indexing="ij")
    return kernel("hyperbolic", smoothing * dx, 2), x.ravel(), y.ravel()


@pytest.mark.parametrize("smoothing, inside, row", [(1.2, 1.083, 0.882), (1.3, 1.065, 0.843)])
def test_kernel_sums_on_the_square_lattice(smoothing, inside, row):
    k, x, y = square_lattice(smoothing)
    w = np.array([k.w(r) for r in np.hypot(x, y)])
    assert w.sum() == pytest.approx(inside, abs=5e-4)
    assert w[y <= 0].sum() == pytest.approx(row, abs=5e-4)


@pytest.mark.parametrize("dim, rows", [(1, (0.5, 0.870)), (2, (0.631, 0.936)), (3, (0.678, 0.960))])
def test_moments_below_a_plane_surface(dim, rows):
    *found, full = moments_below_a_surface(kernel("wendland-c2", 1.4, dim), 1.0, dim)
    assert np.array(found[:2]) / full == pytest.approx(rows, abs=5e-4)


@pytest.mark.parametrize("smoothing, moment", [(1.2, 0.945), (1.3, 0.974)])
def test_first_moment_on_the_square_lattice(smoothing, moment):
    k, x, y = square_lattice(smoothing)
    r = np.hypot(x, y)
    near = r > 0
    slope = np.array([k.dw(d) for d in r[near]])
    assert -(x[near] ** 2 / r[near] * slope).sum() == pytest.approx(moment, abs=5e-4)


def test_unknown_kernel():
    with pytest.raises(KeyError):
        kernel("cubical", 1.0, 2)


@pytest.mark.parametrize("dim", (1, 2, 3))
def test_a_normalised_slope_has_the_right_first_moment_and_the_same_weight(dim):
    plain, dx = kernel("hyperbolic", 0.013, dim), 0.01
    even = normalised(plain, dx, dim)
    radii = [dx * math.hypot(*k) for k in product(range(-3, 4), repeat=dim) if any(k)]
    assert -sum(r * even.dw(r) for r in radii) * dx**dim / dim == pytest.approx(1.0, rel=1e-14)
    assert -sum(r * plain.dw(r) for r in radii) * dx**dim / dim != pytest.approx(1.0, rel=1e-3)
    assert even.w(0.004) == plain.w(0.004)
    assert even.dw_r(0.004, 250.0) == pytest.approx(even.dw(0.004) / 0.004, rel=1e-14)


@pytest.mark.parametrize("dim", (1, 2, 3))
def test_no_wave_on_the_lattice_is_smoothed_faster(dim):
    """Waves drawn at random, each by its own sum; the fastest of the fine grid of waves is reached."""
    dx, k = 0.1, kernel("wendland-c2", 0.14, dim)
    sites = np.stack(np.meshgrid(*[np.arange(-3, 4)] * dim), axis=-1).reshape(-1, dim)
    sites = sites[np.any(sites != 0, axis=1)]
    r = dx * np.linalg.norm(sites, axis=1)
    pull = np.array([-k.dw(x) / x for x in r]) * dx**dim
    waves = np.random.default_rng(1).uniform(0.0, 2.0 * np.pi, (3000, dim))
    rates = [(pull * (1.0 - np.cos(sites @ wave))).sum() for wave in waves]
    found = fastest_smoothing(k, dx, dim)
    assert max(rates) < 1.01 * found and max(rates) > 0.95 * found
    assert 1.9 < 0.14**2 * found < 5.7
