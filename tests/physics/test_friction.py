"""Friction of viscous fluids: its coefficient, what turns as a whole, walls without slip, the time step."""

import itertools
from types import SimpleNamespace

import numpy as np
import pytest
from physics.pairs import H, corrected, pair_of, sums_of, view
from physics.test_effects import DIMENSIONS, agree_compiled, gathered, patch, written_out

from psph.composition.loads import Couple
from psph.moments import fastest_smoothing
from psph.physics.fluid.correction import GradientCorrection
from psph.physics.fluid.friction import Apparent, Arithmetic, CorrectedRub, Harmonic, Rub, friction_step, rub
from psph.physics.fluid.pressure import SymmetricPressure
from psph.physics.fluid.viscosity import (
    CentralNewtonianFriction,
    LaminarViscosity,
    LaplacianFriction,
    NewtonianFriction,
)
from psph.physics.motion import Fixed
from psph.physics.rigid.motion import Rigid
from psph.physics.walls.slip import MirroredFlow, NoSlip, Straight, Turning
from psph.smoothing import KERNELS, kernel

FORMS = (Rub(), CorrectedRub(), Rub(Apparent()), CorrectedRub(Apparent()), Rub(Apparent(), Arithmetic()))


def fluids(n=2, dim=2):
    """Particles of viscous fluids alone, different in all they are."""
    return view(n=n, dim=dim)._replace(is_fluid=np.ones(n), rubs=np.ones(n))


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_the_stress_between_two_fluids_is_that_of_the_harmonic_mean_between_their_volumes(dim):
    p = fluids(dim=dim)
    x, u, r, _, grad_w = written_out(p, 0, 1)
    rho = 1 / p.specific_volume
    one, two = p.viscosity * rho
    force = p.mass[0] / rho[0] * p.mass[1] / rho[1] * 4 * one * two / (one + two)
    force *= (x @ grad_w) / (r * r + 0.01 * H * H)
    i, j, pair = pair_of(p, 0, 1)
    assert p.mass[0] * rub(Rub(), i, j, pair) == pytest.approx(force)
    assert force < 0.0  # friction
    central = CentralNewtonianFriction().radial(i, j, pair)
    assert p.mass[0] * central == pytest.approx((dim + 2) * force * (u @ x) / (r * r))
    shown = p._replace(apparent_viscosity=p.viscosity * rho)
    assert rub(Rub(Apparent()), *pair_of(shown, 0, 1)) == pytest.approx(force / p.mass[0])


def test_of_one_viscosity_it_is_that_of_the_paper():
    """Between equal viscosities ν and densities that differ as in a compressed fluid: the former formula."""
    p = fluids()._replace(viscosity=np.full(2, 0.3))
    x, _, r, _, grad_w = written_out(p, 0, 1)
    mu, rho = 0.3 / p.specific_volume, 1 / p.specific_volume
    a = 4 * p.mass[1] * mu.sum() * (x @ grad_w) / rho.sum() ** 2 / (r * r + 0.01 * H * H)
    assert rub(Rub(), *pair_of(p, 0, 1)) == pytest.approx(a, rel=1e-13)


def test_the_laplacian_is_the_formula_of_the_paper_and_acts_where_fluids_rub():
    """Of two fluids, and in a flow that turns as a whole too: there it is the friction that is too much."""
    p = fluids()
    x, _, r, _, grad_w = written_out(p, 0, 1)
    rho = 1 / p.specific_volume
    a = 4 * p.mass[1] * (p.viscosity * rho).sum() / rho.sum() ** 2 * (x @ grad_w) / (r * r + 0.01 * H * H)
    found = LaplacianFriction().shear(*pair_of(p, 0, 1))
    assert found == pytest.approx(a) and found < 0.0
    beside = p._replace(rubs=np.array([1.0, 0.0]))
    assert LaplacianFriction().shear(*pair_of(beside, 0, 1)) == 0.0


@pytest.mark.parametrize("form", FORMS)
def test_a_wall_takes_the_viscosity_of_the_fluid_and_what_does_not_rub_bears_no_stress(form):
    p = fluids()
    wall = np.array([1.0, 0.0])
    alike = p._replace(apparent_viscosity=np.full(2, 3.0), viscosity=3.0 * p.specific_volume)
    expected = rub(form, *pair_of(alike, 0, 1))
    # whatever viscosity a wall is said to have: that of another fluid, or none
    for other in (0.0, 70.0):
        shown = alike._replace(
            is_fluid=wall,
            viscosity=np.array([alike.viscosity[0], other]),
            apparent_viscosity=np.array([3.0, 0.0]),
        )
        assert rub(form, *pair_of(shown, 0, 1)) == pytest.approx(expected)
        there, back = rub(form, *pair_of(shown, 0, 1)), rub(form, *pair_of(shown, 1, 0))
        assert p.mass[0] * there == pytest.approx(p.mass[1] * back)
        slippery = shown._replace(rubs=np.array([1.0, 0.0]))
        if isinstance(form.mean, Harmonic):
            assert rub(form, *pair_of(slippery, 0, 1)) == rub(form, *pair_of(slippery, 1, 0)) == 0.0
    dry = alike._replace(viscosity=np.array([0.0, 1.0]), apparent_viscosity=np.array([0.0, 1.0]))
    if isinstance(form.mean, Harmonic):
        assert rub(form, *pair_of(dry, 0, 1)) == 0.0
    still = shown._replace(is_fluid=np.zeros(2), apparent_viscosity=np.zeros(2))
    assert rub(form, *pair_of(still, 0, 1)) == 0.0


def turned(p, gradient, still=()):
    """Velocities of a linear flow, 0 at the particles ``still``."""
    u = gradient @ np.array(p.position) + 0.3
    u[:, list(still)] = 0.0
    return p._replace(velocity=tuple(u))


@pytest.mark.parametrize("dim", DIMENSIONS)
@pytest.mark.parametrize("friction", FORMS[:2])
def test_each_pair_that_turns_as_a_whole_is_free_of_force(dim, friction):
    """With fluid and wall, in disorder; the control is the part of u_ij alone, and a shear is felt."""
    n = 14
    p = fluids(n, dim)
    p = p._replace(mass=p.mass * 1e4, is_fluid=np.array([1.0] * (n - 2) + [0.0] * 2))
    rng = np.random.default_rng(3)
    spin, shear = rng.normal(size=(2, dim, dim))
    spin, effect = spin - spin.T, NewtonianFriction(friction)

    def pushed(gradient):
        flow = turned(p, gradient)
        found = np.array([sums_of(effect, flow, k) for k in range(n)])
        assert not found[n - 2 :].any()  # none in a wall
        flow = flow._replace(velocity_gradient=tuple(found.T))
        pairs = [pair_of(flow, a, b) for a, b in itertools.permutations(range(n), 2)]
        forces = np.array([np.multiply(i.mass, effect.push(i, j, pair)) for i, j, pair in pairs])
        parts = [rub(friction, i, j, pair) * i.mass * np.array(pair.u_ij) for i, j, pair in pairs]
        return np.abs(forces).max(), np.abs(parts).max()

    force, part = pushed(spin)
    assert force <= 1e-9 * part and (part > 0.0 or dim == 1)
    force, part = pushed(shear + shear.T)
    assert force > 0.5 * part  # 2D x_ij


def test_a_gradient_counts_viscous_neighbours_alone():
    """Not soil or water without viscosity beside it, which move otherwise."""
    n = 14
    p = fluids(n)._replace(rubs=np.array([1.0] * (n - 3) + [0.0] * 3))
    p = p._replace(mass=p.mass * 1e4)
    gradient = np.array([[0.3, -1.0], [0.7, 0.2]])
    flow = turned(p, gradient, range(n - 3, n))
    assert sums_of(NewtonianFriction(), flow, 0) == pytest.approx(gradient.ravel(), rel=1e-9)
    control = sums_of(NewtonianFriction(), flow._replace(rubs=np.ones(n)), 0)
    assert np.abs(np.array(control) - gradient.ravel()).max() > 0.1


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_a_wall_without_slip_mirrors_the_mean_of_the_fluid_around_it(dim):
    p = view(n=5, dim=dim)
    p = p._replace(is_fluid=np.array([1, 0, 1, 1, 0.0]), no_slip=np.array([0, 1, 0, 0, 0.0]))
    fluid = (0, 2, 3)
    w = np.array([written_out(p, 1, b)[3] for b in fluid])
    u = np.array([[v[b] for v in p.velocity] for b in fluid])
    own = np.array([v[1] for v in p.velocity])
    found = gathered(MirroredFlow(), p, 1, 0, 2, 3, 4)
    assert found == pytest.approx(own - w @ u / w.sum())  # the other wall, 4, is left out
    assert gathered(MirroredFlow(), p, 4, 0, 1, 2, 3) == (0.0,) * dim  # a wall that does not ask
    assert gathered(MirroredFlow(), p, 0, 1, 2, 3, 4) == (0.0,) * dim  # fluid
    assert gathered(MirroredFlow(), p, 1, 4) == (0.0,) * dim  # no fluid in reach
    whirl = np.array([component[1] for component in p.whirl]).reshape(dim, dim)
    away = np.array([written_out(p, 1, b)[0] for b in fluid])
    turning = gathered(MirroredFlow(Rub(), Turning()), p, 1, 0, 2, 3, 4)
    assert turning == pytest.approx(own - w @ (u + away @ whirl.T) / w.sum())


@pytest.mark.parametrize("dim", (2, 3))
def test_a_wall_mirrors_fluid_that_turns_with_it_as_itself(dim):
    """The control: a mean of velocities that does not know of the turn."""
    p = view(n=5, dim=dim)
    spin = np.random.default_rng(3).normal(size=(dim, dim))
    spin = spin - spin.T
    p = turned(p, spin)._replace(
        is_fluid=np.array([1, 0, 1, 1, 0.0]),
        no_slip=np.ones(5),
        whirl=tuple(np.full(5, w) for w in spin.ravel()),
    )
    assert gathered(MirroredFlow(Rub(), Turning()), p, 1, 0, 2, 3) == pytest.approx([0.0] * dim, abs=1e-14)
    assert np.abs(gathered(MirroredFlow(), p, 1, 0, 2, 3)).max() > 1e-4


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_a_couple_has_each_force_of_a_fluid_halfway_between_the_pair(dim):
    """Of a wall beside two fluid particles and a wall; what acts along the line of a pair has none."""
    p = view(n=4, dim=dim)._replace(is_fluid=np.array([0, 1, 1, 0.0]), rubs=np.ones(4))
    effects = (LaplacianFriction(), NewtonianFriction(), SymmetricPressure())
    expected = np.zeros(3)
    for b in (1, 2):
        i, j, pair = pair_of(p, 0, b, "wendland-c2")
        x, u, *_ = written_out(p, 0, b)
        force = effects[0].shear(i, j, pair) * u + effects[1].push(i, j, pair)
        arm, force = (np.pad(one, (0, 3 - dim)) for one in (-0.5 * x, force))
        expected += np.cross(arm, force)
    first = {1: 3, 2: 2, 3: 0}[dim]  # in 2D about z alone
    assert sums_of(Couple(effects), p, 0) == pytest.approx(expected[first:])
    assert np.abs(expected).max() > 0.0 or dim == 1
    assert sums_of(Couple(effects[2:]), p, 0) == (0.0,) * (3 - first)


@pytest.mark.parametrize("correction", (None, GradientCorrection(0.5)))
def test_friction_at_a_wall_without_slip_is_that_with_the_mirrored_velocity(correction):
    """Whichever form of friction the scene takes, no-slip takes the same, and knows whether walls turn."""
    physics = SimpleNamespace(gradient_correction=correction, central_friction=None, laplacian_friction=None)

    def forms(*motions):
        common = {"viscosity": 1.0, "bonded": None}
        species = [SimpleNamespace(no_slip=n < 1, motion=one, **common) for n, one in enumerate(motions)]
        scene = SimpleNamespace(physics=physics, species=species, rheologies=())
        return LaminarViscosity().in_scene(scene), NoSlip().in_scene(scene)

    viscosity, no_slip = forms(Rigid(()), Fixed())
    assert isinstance(no_slip.walls, Turning)
    assert isinstance(forms(Fixed(), Rigid(()))[1].walls, Straight)  # a wall that turns, and does not stick
    assert {type(one.friction) for one in (viscosity, no_slip)} == {CorrectedRub if correction else Rub}
    p = view()._replace(rubs=np.ones(2))
    mean = np.full(2, 0.3)
    slip = [v[1] for v in p.velocity] - mean
    p = p._replace(slip=tuple(np.array([0.0, s]) for s in slip))
    i, j, pair = pair_of(p, 0, 1)
    mirrored = p._replace(velocity=tuple(np.array([v[0], 2.0 * v[1] - m]) for v, m in zip(p.velocity, mean)))
    found = np.add(viscosity.push(i, j, pair), no_slip.push(i, j, pair))
    assert found == pytest.approx(viscosity.push(*pair_of(mirrored, 0, 1)))


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_corrected_friction_is_exact_on_a_lattice(dim):
    """u = (|x|², 0, ...) has the Laplacian 2d everywhere; the plain form falls short of it."""
    p = patch(dim)
    n = len(p.mass)
    p = p._replace(
        velocity=(sum(x * x for x in p.position), *[0 * x for x in p.position[1:]]),
        viscosity=np.full(n, 0.3),
        rubs=np.ones(n),
    )
    stored = sums_of(GradientCorrection(), p, 0)  # the same all over a lattice
    i = corrected(pair_of(p, 0, 0)[0], stored)
    bent = plain = 0.0
    for b in range(1, n):
        _, j, pair = pair_of(p, 0, b, "wendland-c2")
        j = corrected(j, stored)
        bent += rub(CorrectedRub(), i, j, pair) * pair.u_ij[0]
        plain += rub(Rub(), i, j, pair) * pair.u_ij[0]
    exact = 0.3 * 2 * dim
    assert bent == pytest.approx(exact, rel=1e-10)
    assert abs(plain - exact) > 0.005 * exact


@pytest.mark.parametrize(
    "one",
    (
        NewtonianFriction(),
        NewtonianFriction(CorrectedRub()),
        CentralNewtonianFriction(),
        MirroredFlow(CorrectedRub(), Turning()),
    ),
)
def test_friction_is_the_same_compiled(one):
    agree_compiled(one, 2)


def decay(name, smoothing, dim, central):
    """Δt ν/h² times the fastest decay of a wave by friction over h²/ν: by the forces of the effects themselves
    on the lattice, its sums with cos k·x."""
    h, k = smoothing, kernel(name, smoothing, dim)
    reach = range(-int(np.ceil(k.support * h)), int(np.ceil(k.support * h)) + 1)
    sites = np.array([site for site in itertools.product(reach, repeat=dim) if any(site)], float)
    r = np.linalg.norm(sites, axis=1)
    weights = np.array([-k.dw(x) / x for x in r])
    waves = np.array([*itertools.product(np.linspace(0.0, np.pi, 9), repeat=dim)])
    part = 2.0 * weights * (1.0 - np.cos(waves @ sites.T))
    if not central:
        return part.sum(axis=1).max() * h * h
    unit = sites / r[:, None]
    matrices = (dim + 2) * np.einsum("ks,sa,sb->kab", part, unit, unit)
    return np.linalg.eigvalsh(matrices).max() * h * h


def amplification(rate):
    """The largest |z| of a step of the predicted kick-drift-kick: z a = −λ(v + a), (z − 1) v = ½(1 + z) a,
    times in steps, at ``rate`` λΔt."""
    # (z − 1)(z + λ) + ½λ(1 + z) = 0 of v, a
    return np.abs(np.roots([1.0, 1.5 * rate - 1.0, -0.5 * rate])).max()


@pytest.mark.parametrize("dim", (2, 3))
@pytest.mark.parametrize("central", (False, True))
@pytest.mark.parametrize("name", KERNELS)
def test_friction_is_stable_at_its_limit_of_the_time_step(name, central, dim):
    """By the amplification of a step, for every kernel; with Wendland C2 at h/dx 1.4 it grows at 1.5 times the
    limit.  The former limit, 0.125 h²/ν for both, is the other control."""
    form = CentralNewtonianFriction() if central else NewtonianFriction()
    for smoothing in (1.0, 1.2, 1.4, 2.0):
        fastest = decay(name, smoothing, dim, central)
        scene = SimpleNamespace(
            kernel=kernel(name, smoothing, dim),
            spacing=1.0,
            dimensions=dim,
            smoothing_length=smoothing,
            viscosity=0.3,
        )
        step = form.longest_step(scene) * 0.3 / smoothing**2
        assert amplification(fastest * step) < 1.0
        if name == "wendland-c2" and smoothing == 1.4:
            assert amplification(fastest * 1.5 * step) > 1.2
            assert amplification(fastest * 0.125) > 2.0 or not central
            assert step == pytest.approx(0.05 if central else 0.125, rel=0.06)


def test_the_limit_is_that_of_morris_where_the_kernel_allows_it():
    h = 1.4
    scene = SimpleNamespace(kernel=kernel("cubic", h, 2), spacing=1.0, dimensions=2, smoothing_length=h)
    assert friction_step(scene, 0.3) == 0.125 * h * h / 0.3
    sharp = SimpleNamespace(kernel=kernel("wendland-c6", h, 2), spacing=1.0, dimensions=2, smoothing_length=h)
    assert friction_step(sharp, 0.3) == pytest.approx(0.4 / fastest_smoothing(sharp.kernel, 1.0, 2) / 0.3)
    assert friction_step(sharp, 0.3) < 0.08 * h * h / 0.3
