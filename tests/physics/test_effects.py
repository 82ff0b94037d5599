"""Every effect on a hand-made pair: the formula written out, plain against compiled, invariants."""

import math

import numpy as np
import pytest
from physics.pairs import H, OPEN, pair_of, rates, view

from psph.physics.catalogue import CATALOGUE
from psph.physics.continuity import Continuity
from psph.physics.gravity import Gravity
from psph.physics.pressure import MinimumPressure, SymmetricPressure
from psph.physics.slip import NoSlip
from psph.physics.surface import FreeSurface
from psph.physics.trial import UnknownField, reads
from psph.physics.viscosity import ArtificialViscosity, LaminarViscosity
from psph.smoothing import kernel

DIMENSIONS = (1, 2, 3)


def made(effect, dim):
    """An instance with its defaults, or with a vector where it asks for one."""
    needed = [n for n in effect._fields if n not in effect._field_defaults]
    return effect(**dict.fromkeys(needed, (0.0, -9.8, 0.3)[:dim]))


def written_out(particles, a, b):
    """x_ij, u_ij, r, W and ∇W of the hyperbolic kernel, with numpy alone."""
    x = np.array([p[a] - p[b] for p in particles.position])
    u = np.array([p[a] - p[b] for p in particles.velocity])
    r = np.linalg.norm(x)
    s, alpha = r / H, {1: 1 / (7 * H), 2: 1 / (3 * math.pi * H**2), 3: 15 / (62 * math.pi * H**3)}
    w = s**3 - 6 * s + 6 if s < 1 else (2 - s) ** 3
    dw = 3 * s * s - 6 if s < 1 else -3 * (2 - s) ** 2
    alpha = alpha[len(x)]
    return x, u, r, alpha * w, alpha * dw / H * x / r


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_geometry(dim):
    particles = view(dim=dim)
    x, u, r, w, grad_w = written_out(particles, 0, 1)
    _, _, pair = pair_of(particles, 0, 1)
    assert pair.x_ij == pytest.approx(x) and pair.u_ij == pytest.approx(u)
    assert pair.r2 == pytest.approx(r * r) and pair.w == pytest.approx(w)
    assert pair.u_dot_x == pytest.approx(u @ x)
    assert np.multiply(pair.dw_r, pair.x_ij) == pytest.approx(grad_w)


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_continuity(dim):
    particles = view(dim=dim)
    _, u, _, _, grad_w = written_out(particles, 0, 1)
    assert Continuity().density_rate(*pair_of(particles, 0, 1)) == pytest.approx(
        particles.mass[1] * (u @ grad_w)
    )


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_symmetric_pressure(dim):
    p = view(dim=dim)
    x, _, _, _, grad_w = written_out(p, 0, 1)
    rho = 1 / p.specific_volume
    a = -p.mass[1] * (p.pressure[0] / rho[0] ** 2 + p.pressure[1] / rho[1] ** 2) * grad_w
    assert SymmetricPressure().radial(*pair_of(p, 0, 1)) * x == pytest.approx(a)


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_minimum_pressure_over_three_neighbours(dim):
    p = view(n=4, dim=dim)
    effect, rho = MinimumPressure(), 1 / p.specific_volume
    i = pair_of(p, 0, 1)[0]
    total, relative = effect.start(i), np.zeros(dim)
    for b in (1, 2, 3):
        _, j, pair = pair_of(p, 0, b)
        total = effect.gather(total, i, j, pair)
        relative += effect.radial(i, j, pair) * np.array(pair.x_ij)
    lowest = p.pressure[1:].min()
    expected = -sum(
        p.mass[b] / (rho[0] * rho[b]) * (p.pressure[b] - lowest) * written_out(p, 0, b)[4]
        for b in (1, 2, 3)
    )
    assert relative + effect.finish_acceleration(total, i) == pytest.approx(expected)


def test_minimum_pressure_ignores_what_is_out_of_reach():
    p = view(n=3)
    p.position[0][2] = 1e30
    p.pressure[2] = -1e9
    effect = MinimumPressure()
    i, j, pair = pair_of(p, 0, 2)
    assert effect.gather(effect.start(i), i, j, pair)[0] > 1e29
    alone = effect.finish_acceleration(effect.start(i), i)
    assert alone == (0.0, 0.0)


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_laminar_viscosity(dim):
    p = view(dim=dim)
    x, u, r, _, grad_w = written_out(p, 0, 1)
    rho = 1 / p.specific_volume
    mu = p.viscosity * rho
    a = 4 * p.mass[1] * (mu[0] + mu[1]) * (x @ grad_w) * u
    a /= (rho[0] + rho[1]) ** 2 * (r * r + 0.01 * H * H)
    assert LaminarViscosity().shear(*pair_of(p, 0, 1)) * u == pytest.approx(a)
    assert a @ u < 0  # friction


def gathered(effect, particles, i, *others):
    """The effect's sum at particle ``i`` over the others, finished."""
    one = pair_of(particles, i, others[0])[0]
    total = effect.start(one)
    for b in others:
        total = effect.gather(total, *pair_of(particles, i, b))
    return effect.finish_value(total, one, kernel("hyperbolic", H, len(particles.position)))


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_a_wall_without_slip_mirrors_the_mean_of_the_fluid_around_it(dim):
    p = view(n=5, dim=dim)
    p = p._replace(wall=np.array([0, 1, 0, 0, 1.0]), no_slip=np.array([0, 1, 0, 0, 0.0]))
    w = np.array([written_out(p, 1, b)[3] for b in (0, 2, 3)])
    u = np.array([[v[b] for v in p.velocity] for b in (0, 2, 3)])
    own = np.array([v[1] for v in p.velocity])
    found = gathered(NoSlip(), p, 1, 0, 2, 3, 4)
    assert found == pytest.approx(own - w @ u / w.sum())  # the other wall, 4, is left out
    assert gathered(NoSlip(), p, 4, 0, 1, 2, 3) == (0.0,) * dim  # a wall that does not ask
    assert gathered(NoSlip(), p, 0, 1, 2, 3, 4) == (0.0,) * dim  # fluid
    assert gathered(NoSlip(), p, 1, 4) == (0.0,) * dim  # no fluid in reach


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_friction_at_a_wall_without_slip_is_that_with_the_mirrored_velocity(dim):
    p = view(dim=dim)
    mean, slip = np.full(dim, 0.3), [v[1] for v in p.velocity] - np.full(dim, 0.3)
    p = p._replace(slip=tuple(np.array([0.0, s]) for s in slip))
    i, j, pair = pair_of(p, 0, 1)
    mirrored = p._replace(velocity=tuple(
        np.array([v[0], 2.0 * v[1] - m]) for v, m in zip(p.velocity, mean)
    ))
    expected = LaminarViscosity().shear(i, j, pair) * np.array(pair_of(mirrored, 0, 1)[2].u_ij)
    found = LaminarViscosity().shear(i, j, pair) * np.array(pair.u_ij) + NoSlip().push(i, j, pair)
    assert found == pytest.approx(expected)


@pytest.mark.parametrize("approaching", (True, False))
def test_artificial_viscosity(approaching):
    p = view()
    x, u, r, _, grad_w = written_out(p, 0, 1)
    if (u @ x < 0) != approaching:
        p = p._replace(velocity=tuple(-v for v in p.velocity))
        u = -u
    mu = H * (u @ x) / (r * r + 0.01 * H * H) if approaching else 0.0
    rho = (1 / p.specific_volume).mean()
    big_pi = (-0.3 * 50.0 * mu + 0.6 * mu * mu) / rho
    a = ArtificialViscosity(0.3, 0.6).radial(*pair_of(p, 0, 1)) * x
    assert a == pytest.approx(-p.mass[1] * big_pi * grad_w)
    assert (a != 0).all() == approaching


def test_gravity():
    assert Gravity((0.0, -9.8)).body(pair_of(view(), 0, 1)[0]) == (0.0, -9.8)


def test_free_surface():
    p = view()
    effect, (i, j, pair) = FreeSurface(0.9), pair_of(p, 0, 1)
    own = kernel("hyperbolic", H, 2).w(0.0) * p.mass[0] * p.specific_volume[0]
    share = p.mass[1] * p.specific_volume[1] * pair.w
    total = effect.gather(effect.start(i), i, j, pair)
    found = effect.finish_value(total, i, kernel("hyperbolic", H, 2))
    assert found == pytest.approx(own + share)
    for kernel_sum, rho in ((0.89, 1000.0), (0.91, 987.0)):
        assert effect.limit_density(i._replace(kernel_sum=kernel_sum), 987.0) == rho


@pytest.mark.parametrize("dim", DIMENSIONS)
@pytest.mark.parametrize("effect", [e.effect for e in CATALOGUE])
def test_compiled_is_plain(effect, dim):
    one = made(effect, dim)
    reductions = (one,) if hasattr(one, "start") else ()
    args = ((one,), reductions, kernel("hyperbolic", H, dim), OPEN[:dim], view(n=3, dim=dim), 0, 1)
    for compiled, plain in zip(rates(*args), rates.py_func(*args)):
        assert compiled is plain is None or compiled == pytest.approx(plain, rel=1e-12)


@pytest.mark.parametrize("effect", [SymmetricPressure, LaminarViscosity, ArtificialViscosity])
def test_conserves_momentum_where_the_formula_promises_it(effect):
    p = view(dim=3)
    one = made(effect, 3)
    force = []
    for a, b in ((0, 1), (1, 0)):
        i, j, pair = pair_of(p, a, b)
        radial = one.radial(i, j, pair) if hasattr(one, "radial") else 0.0
        shear = one.shear(i, j, pair) if hasattr(one, "shear") else 0.0
        force.append(p.mass[a] * (radial * np.array(pair.x_ij) + shear * np.array(pair.u_ij)))
    assert force[0] == pytest.approx(-force[1], rel=1e-13)


def test_minimum_pressure_does_not_conserve_momentum():
    p = view(n=3)
    total = np.zeros(2)
    for a in range(3):
        effect, i = MinimumPressure(), pair_of(p, a, (a + 1) % 3)[0]
        sums = effect.start(i)
        for b in range(3):
            if b != a:
                _, j, pair = pair_of(p, a, b)
                sums = effect.gather(sums, i, j, pair)
                total += p.mass[a] * effect.radial(i, j, pair) * np.array(pair.x_ij)
        total += p.mass[a] * np.array(effect.finish_acceleration(sums, i))
    assert np.abs(total).max() > 1e-3


def test_pressure_work_is_what_continuity_says():
    """(5) and (6) are adjoint: forces do the work p dV, so that energy is conserved."""
    p = view(n=2, dim=2)
    power = heating = 0.0
    for a, b in ((0, 1), (1, 0)):
        i, j, pair = pair_of(p, a, b)
        a_i = SymmetricPressure().radial(i, j, pair) * np.array(pair.x_ij)
        power += p.mass[a] * a_i @ np.array(i.velocity)
        rate = Continuity().density_rate(i, j, pair)
        heating += p.mass[a] * i.pressure * i.specific_volume**2 * rate
    assert power == pytest.approx(-heating, rel=1e-12)


def test_reads_are_found_by_a_trial_call():
    found = reads(LaminarViscosity(), 2, kernel("cubic", H, 2))
    assert found.neighbour == {"mass", "specific_volume", "viscosity"}
    assert found.own == {"specific_volume", "viscosity", "smoothing_length"}
    assert found.pair == {"r2", "dw_r"}


def test_both_sides_of_a_comparison_are_tried():
    assert "rest_density" in reads(FreeSurface(), 2, kernel("cubic", H, 2)).own
    found = reads(MinimumPressure(), 2, kernel("cubic", H, 2))
    assert "pressure" in found.neighbour and "x_ij" in found.pair


def test_an_effect_that_reads_what_nobody_has():
    from typing import NamedTuple

    class Buoyancy(NamedTuple):
        def radial(self, i, j, pair):
            return i.temperature * pair.dw_r

    with pytest.raises(UnknownField, match="Buoyancy reads 'temperature'.*pressure"):
        reads(Buoyancy(), 2, kernel("cubic", H, 2))
