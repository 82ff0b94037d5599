"""Every effect on a hand-made pair: the formula written out, plain against compiled, invariants."""

import itertools
import math
from itertools import product
from types import SimpleNamespace
from typing import get_origin, get_type_hints

import numpy as np
import pytest
from long import long_but_for
from physics.pairs import OPEN, H, corrected, pair_of, rates, sums_of, view
from remedies import ENTRIES, remedy

from psph.composition.pair import take
from psph.composition.trial import UnknownField, reads
from psph.physics.catalogue import BUILT_IN
from psph.physics.damping.diffusion import DensityDiffusion, TankDiffusion
from psph.physics.damping.matter import SeveralMatters
from psph.physics.fluid.absorbing import AbsorbingZone, DampingZone
from psph.physics.fluid.continuity import Continuity
from psph.physics.fluid.correction import CorrectionBesideWalls, DifferenceCorrection, GradientCorrection
from psph.physics.fluid.gravity import CentralForce, Gravity
from psph.physics.fluid.parting import Parting, PartingBesideStrength
from psph.physics.fluid.pressure import (
    BackgroundPressure,
    DifferencePressure,
    MinimumPressure,
    SymmetricPressure,
    TensileControl,
)
from psph.physics.fluid.viscosity import ArtificialViscosity, ImpactDamping, PairDamping
from psph.physics.fluid.weight import InFrame, Steady
from psph.physics.gas.conduction import Conduction, OfOneGamma, OfPressure
from psph.physics.gas.pressure import OfUnlikeMasses
from psph.physics.motion import Fixed
from psph.physics.order.potential import neutral_potential
from psph.physics.order.shifting import LatticeShift, ParticleShifting, lattice_shift
from psph.physics.order.stress import NeighbourStress
from psph.physics.rigid.motion import Rigid
from psph.physics.solid.anvil import Anvils
from psph.physics.surface.free import FreeSurface, TensionFloor
from psph.physics.walls.dry import DryWall
from psph.physics.walls.extrapolated import ExtrapolatedWall
from psph.physics.walls.penalty import PenaltyWall, Spring, mean_distance
from psph.physics.walls.repulsive import RepulsiveWall
from psph.smoothing import kernel

DIMENSIONS = (1, 2, 3)

RiemannDissipation, ConservativeSmoothing, XSPH = map(
    remedy, ("RiemannDissipation", "ConservativeSmoothing", "XSPH")
)
TransportVelocity, GeneralisedTransportVelocity = map(
    remedy, ("TransportVelocity", "GeneralisedTransportVelocity")
)


def made(effect, dim):
    """An instance with its defaults, or with a number or vector where it asks for one; of anvils, one that most
    particles have come too near to; of those of a gas, one with the kernel and the conduction that a scene would give it."""
    if effect is Anvils:
        return Anvils((((0.3, -0.8, 0.3)[:dim], (0.6, 0.8, 0.0)[:dim]),), 2.0, 50.0)
    hints = get_type_hints(effect)
    needed = [n for n in effect._fields if n not in effect._field_defaults]
    vector = (0.3, -9.8, 0.3)[:dim]
    unit = kernel("wendland-c2", 1.0, dim)
    spread = Conduction(0.7, OfPressure(), OfOneGamma())
    given = {"kernel": unit, "form": OfUnlikeMasses(unit), "spread": spread}
    told = {n: given[n] for n, default in effect._field_defaults.items() if default is None}
    return effect(*(vector if get_origin(hints[n]) is tuple else 0.7 for n in needed), **told)


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
    assert pair.m_dw_r == pytest.approx(particles.mass[1] * pair.dw_r)
    assert (pair.r, 1.0 / pair.inverse_r) == pytest.approx((r, r))


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
        p.mass[b] / (rho[0] * rho[b]) * (p.pressure[b] - lowest) * written_out(p, 0, b)[4] for b in (1, 2, 3)
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


def gathered(effect, particles, i, *others):
    """The effect's sum at particle ``i`` over the others, finished."""
    one = pair_of(particles, i, others[0])[0]
    total = effect.start(one)
    for b in others:
        total = effect.gather(total, *pair_of(particles, i, b))
    return effect.finish_value(total, one, kernel("hyperbolic", H, len(particles.position)))


@pytest.mark.parametrize("dim", DIMENSIONS)
@pytest.mark.parametrize("moves", (False, True))
@pytest.mark.parametrize("soils", (False, True))
def test_an_extrapolated_wall_has_the_pressure_of_the_fluid_and_its_weight(dim, moves, soils):
    """Of a wall that moves g − a_w is the weight; the mean stress of a soil takes (1 + 2K₀)/3 of it."""
    gravity = (2.0, -9.8, 0.5)[:dim]
    wall = SimpleNamespace(extrapolated=True, motion=Rigid(()) if moves else Fixed())
    strengths = (None,) if soils else ()
    effect = ExtrapolatedWall().in_scene(
        SimpleNamespace(gravity=gravity, frame=None, species=(wall,), strengths=strengths)
    )
    p = view(n=5, dim=dim)
    gravity = np.add(gravity, [x[1] for x in p.apparent]) if moves else gravity
    p = p._replace(is_fluid=np.array([1, 0, 1, 1, 0.0]), extrapolated=np.array([0, 1, 0, 0, 0.0]))
    fluid = (0, 2, 3)
    w = np.array([written_out(p, 1, b)[3] for b in fluid])
    depth = np.array([written_out(p, 1, b)[0] @ gravity for b in fluid])
    if soils:
        depth = depth * (1.0 + 2.0 * p.rest_coefficient[[*fluid]]) / 3.0
    told = p.pressure[[*fluid]] + depth / p.specific_volume[[*fluid]]
    assert gathered(effect, p, 1, 0, 2, 3, 4) == pytest.approx(w @ told / w.sum())  # 4 is a wall too
    assert gathered(effect, p, 1, 4) == 0.0  # no fluid in reach
    for other in (0, 4):  # fluid, and a wall that does not ask
        assert gathered(effect, p, other, 1, 2, 3) == p.pressure[other]
        assert not effect.has_sum(take(p, other))
    assert effect.has_sum(take(p, 1))


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_the_particles_of_a_repulsive_wall_repel_the_fluid(dim):
    dx, speed = H / 1.4, 3.0
    effect = RepulsiveWall().in_scene(SimpleNamespace(spacing=dx, smoothing_length=H, expected_speed=speed))
    p = view(n=3, dim=dim)
    p = p._replace(is_fluid=np.array([1.0, 0.0, 1.0]))
    x, _, r, *_ = written_out(p, 0, 1)
    w = 1.77 / 32 * (1 + 2.5 * r / H + 2 * (r / H) ** 2) * max(2 - r / H, 0) ** 5
    expected = speed**2 / 2 * x / (r * max(r - dx / 3, 0.1 * dx)) * w
    assert effect.radial(*pair_of(p, 0, 1)) * x == pytest.approx(expected)
    assert effect.radial(*pair_of(p, 0, 2)) == 0.0  # a neighbour that is no such wall
    assert effect.radial(*pair_of(p, 1, 1 + 1)) == 0.0  # a wall is not pushed


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_a_penalty_wall_pushes_back_along_its_normal_what_is_too_near(dim):
    effect = Spring(stiffness=900.0, damping=30.0, rest=10.0 * H, onset=0.1 * H)
    p = view(n=4, dim=dim)
    p = p._replace(is_fluid=np.array([1.0, 0.0, 0.0, 1.0]), penalty=np.array([0.0, 1.0, 1.0, 0.0]))

    def pushed(effect, i, *others):
        one, total = take(p, i), effect.start(take(p, i))
        for b in others:
            total = effect.gather(total, *pair_of(p, i, b))
        return np.array(effect.finish_acceleration(total, one))

    w = np.array([written_out(p, 0, b)[3] for b in (1, 2)])
    away, motion = (w @ [written_out(p, 0, b)[k] for b in (1, 2)] / w.sum() for k in (0, 1))
    d = np.sqrt(away @ away)
    expected = (900.0 * (10.0 * H - d) - 30.0 * motion @ away / d) * away / d
    assert pushed(effect, 0, 1, 2, 3) == pytest.approx(expected)  # 3 is fluid
    half = (900.0 * 0.05 * H - 0.5 * 30.0 * motion @ away / d) * away / d  # the damper has half set in
    assert pushed(effect._replace(rest=d + 0.05 * H), 0, 1, 2, 3) == pytest.approx(half)
    assert not pushed(effect._replace(rest=0.9 * d), 0, 1, 2).any()  # far enough
    assert not pushed(effect, 0, 3).any()  # no wall in reach
    assert not pushed(effect, 1, 2).any()  # a wall is not pushed


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_half_a_spacing_before_a_flat_penalty_wall_nothing_pushes(dim):
    dx, one = 0.1, kernel("wendland-c2", 0.14, dim)
    rest = (
        PenaltyWall().in_scene(SimpleNamespace(kernel=one, spacing=dx, dimensions=dim, sound_speed=20.0)).rest
    )
    assert rest == mean_distance(one, dx, dim)
    assert dx < rest < 1.3 * dx  # the first layer, a spacing away, weighs most
    assert mean_distance(kernel("wendland-c2", 0.28, dim), 2 * dx, dim) == pytest.approx(2 * rest)


@pytest.mark.parametrize("approaching", (True, False))
def test_artificial_viscosity(approaching):
    p = view()
    x, u, r, _, grad_w = written_out(p, 0, 1)
    if (u @ x < 0) != approaching:
        p = p._replace(velocity=tuple(-v for v in p.velocity))
        u = -u
    mu = H * (u @ x) / (r * r + 0.01 * H * H) if approaching else 0.0
    rho = (1 / p.specific_volume).mean()
    big_pi = (-0.3 * p.sound_speed.min() * mu + 0.6 * mu * mu) / rho
    a = ArtificialViscosity(0.3, 0.6).radial(*pair_of(p, 0, 1)) * x
    assert a == pytest.approx(-p.mass[1] * big_pi * grad_w)
    assert (a != 0).all() == approaching


def test_gravity():
    assert Gravity((0.0, -9.8)).body(pair_of(view(), 0, 1)[0]) == (0.0, -9.8)


def test_a_central_force_pulls_to_its_centre():
    """a = −B² (x − X): a particle at rest swings with the period 2π/B."""
    force, h = CentralForce(3.0, (1.0, -2.0)), 1e-3
    at = lambda x: force.body(view()._replace(position=x))
    assert at((1.5, -2.0)) == pytest.approx((-4.5, 0.0)) and at((1.0, -2.0)) == (0.0, 0.0)
    x, u = 1.5, 0.0
    for _ in range(round(2.0 * math.pi / 3.0 / h)):
        u += h * at((x, -2.0))[0]
        x += h * u
    assert x == pytest.approx(1.5, abs=1e-5)


@pytest.mark.parametrize(("begin", "end", "axis"), [(1.0, 3.0, "x"), (3.0, 1.0, "x"), (-0.5, 1.5, "y")])
def test_a_damping_zone_takes_speed_within_it_alone(begin, end, axis):
    """a = −β s² v, s from 0 where the zone begins to 1 where it ends."""
    zone = DampingZone(begin, end, axis, 8.0).in_scene(SimpleNamespace(dimensions=2))
    assert isinstance(zone, AbsorbingZone) and zone.longest_step(None) == pytest.approx(0.5 / 8.0)
    d, v = "xy".index(axis), (0.3, -0.7)

    def at(s, velocity=v, shear_modulus=0.0):
        x = [5.0, 7.0]
        x[d] = begin + s * (end - begin)
        one = view()._replace(position=tuple(x), velocity=velocity, shear_modulus=shear_modulus)
        return zone.body(one)

    assert at(0.5) == pytest.approx((-0.6, 1.4)) and at(0.999) == pytest.approx((-2.4, 5.6), rel=3e-3)
    assert at(-0.01) == at(1.01) == at(-3.0) == at(4.0) == (0.0, 0.0)
    assert at(0.7, (0.0, 0.0)) == (0.0, 0.0)
    assert at(0.7, shear_modulus=2e6) == (0.0, 0.0)  # in a soil


def test_a_damping_zone_in_a_stream_leaves_the_stream():
    """a = −β s² (v − U): what goes with it feels nothing, at rest it is carried on.  Control: the zone at rest."""
    zone = DampingZone(1.0, 3.0, "y", 8.0, 0.4).in_scene(SimpleNamespace(dimensions=2))
    assert zone.longest_step(None) == pytest.approx(0.5 / 8.0)
    at = lambda velocity: view()._replace(position=(5.0, 2.0), velocity=velocity, shear_modulus=0.0)
    assert zone.body(at((0.0, 0.4))) == (0.0, 0.0)
    assert zone.body(at((0.3, 0.0))) == pytest.approx((-0.6, 0.8))
    still = DampingZone(1.0, 3.0, "y", 8.0).in_scene(SimpleNamespace(dimensions=2))
    assert still.body(at((0.0, 0.4))) == pytest.approx((0.0, -0.8))


def test_free_surface():
    p = view()
    effect, (i, j, pair) = FreeSurface(0.9), pair_of(p, 0, 1)
    own = kernel("hyperbolic", H, 2).w(0.0) * p.mass[0] * p.specific_volume[0]
    share = p.mass[1] * p.specific_volume[1] * pair.w
    total = effect.gather(effect.start(i), i, j, pair)
    found = effect.finish_value(total, i, kernel("hyperbolic", H, 2))
    assert found == pytest.approx(own + share)
    for kernel_sum, rho in ((0.89, i.rest_density), (0.91, 987.0)):
        assert effect.limit_density(i._replace(kernel_sum=kernel_sum), 987.0) == rho


OFTEN_USED = {
    "Continuity",
    "SymmetricPressure",
    "MinimumPressure",
    "FreeSurface",
    "ArtificialViscosity",
    "PairDamping",
    "ImpactDamping",
    "DensityDiffusion",
    "DryWall",
}


@pytest.mark.parametrize("dim", long_but_for(("2",), DIMENSIONS))
@pytest.mark.parametrize(
    "effect", long_but_for(OFTEN_USED, [e.effect for e in ENTRIES], lambda e: e.__name__)
)
def test_compiled_is_plain(effect, dim):
    agree_compiled(made(effect, dim), dim)


def agree_compiled(one, dim):
    """Fails where compiled and plain Python differ in anything that the effect does to a pair."""
    reductions = (one,) if hasattr(one, "start") else ()
    args = ((one,), reductions, kernel("hyperbolic", H, dim), OPEN[:dim], view(n=3, dim=dim), 0, 1)
    for compiled, plain in zip(rates(*args), rates.py_func(*args)):
        assert compiled is plain is None or compiled == pytest.approx(plain, rel=1e-12)


@pytest.mark.parametrize("dim", long_but_for((2, 3), DIMENSIONS, int))
@pytest.mark.parametrize("one", [neutral_potential, LatticeShift])
def test_forms_of_a_scene_are_compiled_as_they_are_plain(one, dim):
    agree_compiled(one(0.5, 50.0, 0.01, dim) if one is neutral_potential else one(0.1, -2.0, 1e-6), dim)


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_difference_pressure(dim):
    p = view(dim=dim)
    x, _, _, _, grad_w = written_out(p, 0, 1)
    rho = 1 / p.specific_volume
    a = -p.mass[1] / (rho[0] * rho[1]) * (p.pressure[1] - p.pressure[0]) * grad_w
    assert DifferencePressure().radial(*pair_of(p, 0, 1)) * x == pytest.approx(a)
    level = p._replace(pressure=np.full(2, 700.0))
    assert DifferencePressure().radial(*pair_of(level, 0, 1)) == 0.0


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_background_pressure_is_the_symmetric_form_of_a_constant(dim):
    p = view(dim=dim)
    i, j, pair = pair_of(p, 0, 1)
    raised = SymmetricPressure().radial(*pair_of(p._replace(pressure=p.pressure + 40.0), 0, 1))
    found = BackgroundPressure(40.0).radial(i, j, pair)
    assert found > 0.0  # it pushes
    assert found == pytest.approx(raised - SymmetricPressure().radial(i, j, pair), rel=1e-9)


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_density_diffusion(dim):
    p = view(dim=dim)._replace(sound_speed=np.full(2, 50.0))  # of one matter
    x, _, r, _, grad_w = written_out(p, 0, 1)
    rho = 1 / p.specific_volume
    excess = rho - p.rest_density
    rate = 2 * 0.3 * H * 50.0 * p.mass[1] / rho[1] * (excess[0] - excess[1]) * (x @ grad_w)
    rate /= max(r * r, 0.01 * H * H)
    found = DensityDiffusion(0.3).density_rate(*pair_of(p, 0, 1))
    assert found == pytest.approx(rate)
    assert found * (excess[1] - excess[0]) > 0.0
    pulled = TankDiffusion(0.3, Steady((0.3, -9.8, 1.0)[:dim]))
    for effect, q in ((DensityDiffusion(0.3), p), (pulled, p._replace(is_fluid=np.ones(2)))):
        there, back = (effect.density_rate(*pair_of(q, *ends)) for ends in ((0, 1), (1, 0)))
        assert (p.mass / rho) @ (there, back) == pytest.approx(0.0, abs=1e-12 * abs(there))


def test_density_diffusion_leaves_two_fluids_apart():
    p = view()
    i, j, pair = pair_of(p, 0, 1)
    i = i._replace(rest_density=800.0, specific_volume=1 / 801.0)
    j = j._replace(rest_density=1000.0, specific_volume=1 / 1001.0)
    assert DensityDiffusion(0.3).density_rate(i, j, pair) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_hydrostatic_diffusion_leaves_a_still_column_alone(dim):
    """Of one fluid, and of two of which each has half of the way from one particle to the other."""
    p, g = view(dim=dim), (0.3, -9.8, 1.0)[:dim]
    depth = np.array(g) @ p.position  # m²/s²
    excess = p.rest_density.mean() * depth / 50.0**2
    p = p._replace(specific_volume=1 / (p.rest_density + excess), is_fluid=np.ones(2))
    pair = pair_of(p, 0, 1)
    plain = DensityDiffusion(0.1).density_rate(*pair)
    still = TankDiffusion(0.1, Steady(g)).density_rate(*pair)
    assert abs(still) < 1e-9 * abs(plain)
    for none in (0.0, None):
        assert TankDiffusion(0.1, Steady((none,) * dim)).density_rate(*pair) == pytest.approx(plain)


def test_walls_take_density_over_and_give_none():
    """A wall without pressure gives none to another either, and draws none off: one of its rest density, and
    where walls bear no tension one of less."""
    i, j, pair = pair_of(view(), 0, 1)
    for own, other, denser, tension in product((0.0, 1.0), (0.0, 1.0), (-2e-5, 0.0, 2e-5), (0.0, 1.0)):
        tank = TankDiffusion(0.1, Steady((0.0, 0.0)), tension=tension)
        neighbour = j._replace(is_fluid=other, specific_volume=1.0 / (j.rest_density * (1.0 + denser)))
        rate = tank.density_rate(i._replace(is_fluid=own), neighbour, pair)
        bears = denser > 0.0 or (denser < 0.0 and tension == 1.0)
        assert (rate == 0.0) == (not other and bool(own or not bears))


def test_two_wall_particles_exchange_no_density_by_riemann_problems():
    i, j, pair = pair_of(view(), 0, 1)
    for own, other in product((0.0, 1.0), repeat=2):
        rate = RiemannDissipation().density_rate(i._replace(is_fluid=own), j._replace(is_fluid=other), pair)
        assert (rate == 0.0) == (own == other == 0.0)


def test_a_wall_is_not_shifted():
    effect, p = ParticleShifting(), patch(2, 0.2)
    assert np.abs(sums_of(effect, p._replace(is_fluid=np.ones(len(p.mass))), 0)).max() > 0.0
    assert sums_of(effect, p._replace(is_fluid=np.zeros(len(p.mass))), 0) == pytest.approx(
        (0.0, 0.0), abs=0.0
    )


def test_a_dry_wall_has_its_rest_density():
    i = pair_of(view(), 0, 1)[0]
    assert DryWall().limit_wall_density(i._replace(wet=1.0), 987.0) == 987.0
    assert DryWall().limit_wall_density(i._replace(wet=0.0), 987.0) == i.rest_density


def patch(dim, jitter=0.0, reach=3):
    """A lattice of equal volumes around particle 0, h/dx = 1.3, perhaps out of order."""
    dx = H / 1.3
    sites = (
        np.array(sorted(np.ndindex(*(2 * reach + 1,) * dim), key=lambda s: sum((k - reach) ** 2 for k in s)))
        - reach
    )
    x = dx * (sites + jitter * np.random.default_rng(5).uniform(-1, 1, sites.shape))
    n = len(x)
    return view(n=n, dim=dim)._replace(
        position=tuple(x.T), mass=np.full(n, 1000 * dx**dim), specific_volume=np.full(n, 1e-3)
    )


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_shifting_leaves_a_lattice_and_flees_a_neighbour_that_comes_near(dim):
    effect, p = ParticleShifting(0.1), patch(dim)
    assert sums_of(effect, p, 0) == pytest.approx((0.0,) * dim, abs=1e-12)
    nearest = next(k for k in range(1, len(p.mass)) if p.position[-1][k] > 0.5 * H)
    p.position[-1][nearest] *= 0.9
    crowding = sums_of(effect, p, 0)
    i = pair_of(p, 0, 0)[0]._replace(crowding=crowding)
    shift = effect.displacement(i, 1e-5)
    assert shift[-1] < 0.0
    assert shift == pytest.approx(np.multiply(crowding, -2 * 0.1 * 50.0 * 1e-5), rel=1e-12)
    i = i._replace(crowding=(3.0,) * dim)
    assert np.linalg.norm(effect.displacement(i, 1e-5)) == pytest.approx(0.1 * 50.0 * 1e-5)


def test_shifting_by_the_formula():
    effect, p = ParticleShifting(), patch(2, 0.2)
    k, dx = kernel("hyperbolic", H, 2), H / 1.3
    expected = np.zeros(2)
    for b in range(1, len(p.mass)):
        _, _, r, w, grad_w = written_out(p, 0, b)
        expected += dx**2 * (1 + 0.2 * (w / k.w(dx)) ** 4) * grad_w * (r < 2 * H)
    assert sums_of(effect, p, 0, "hyperbolic") == pytest.approx(H * expected, rel=1e-9)


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_velocity_and_density_follow_a_shift(dim):
    p = view(dim=dim)
    _, u, _, _, grad_w = written_out(p, 0, 1)
    i, j, pair = pair_of(p, 0, 1)
    effect, rho = ParticleShifting(0.1), 1 / p.specific_volume
    along = np.array(effect.displacement(i, 1.0)) @ grad_w * p.mass[1] / rho[1]
    assert effect.shear(i, j, pair) * u == pytest.approx(-along * u)
    above = rho - p.rest_density
    assert effect.density_rate(i, j, pair) == pytest.approx(along * (above[1] - above[0]))


def test_no_shift_at_a_surface():
    effect, p = ParticleShifting(), patch(2)
    half = p.position[1] > -0.1 * H  # a surface row, and what is above it
    p = p._replace(
        **{
            n: tuple(a[half] for a in x) if isinstance(x, tuple) else x[half]
            for n, x in p._asdict().items()
            if not np.isscalar(x)
        }
    )
    assert sums_of(effect, p, 0) == (0.0, 0.0)


def test_a_position_shift_stops_with_the_flow():
    effect = LatticeShift(0.1, -2.0, 1e-6)
    i = pair_of(view(), 0, 1)[0]
    fast = np.array(effect.displacement(i._replace(largest_speed=50.0), 1e-3))
    slow = np.array(effect.displacement(i._replace(largest_speed=2.0), 1e-3))
    assert slow == pytest.approx(fast * 2.0 / (0.1 * i.sound_speed))
    assert effect.displacement(i._replace(largest_speed=0.0), 1e-3) == pytest.approx((0.0, 0.0))


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_pair_damping_acts_on_approaching_and_parting_pairs_alike(dim):
    p = view(dim=dim)
    there, back = (
        PairDamping(0.3).radial(*pair_of(q, 0, 1))
        for q in (p, p._replace(velocity=tuple(-v for v in p.velocity)))
    )
    assert there == pytest.approx(-back, rel=1e-13) and there != 0.0


def test_impact_damping_acts_on_fast_approach_alone():
    p = view()
    i, j, pair = pair_of(p, 0, 1)
    onset = 0.5 * i.sound_speed  # above that of the effect

    def push(speed):
        return ImpactDamping(2.0).radial(i, j, pair._replace(u_dot_x=speed * pair.r2 / H))

    assert push(onset) == push(-0.15 * i.sound_speed) == 0.0
    assert push(-4.0 * onset) > 4.0 * push(-2.0 * onset) > 0.0  # x_ij points away from j


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_corrected_gradients_are_exact_for_linear_fields(dim):
    effect, p = GradientCorrection(0.01), patch(dim, jitter=0.2)
    slope = np.array([[0.7, -1.2, 0.4], [0.1, 0.5, -0.3], [-0.9, 0.2, 0.6]])[:dim, :dim]
    p = p._replace(velocity=tuple(slope @ p.position))
    more = plain = 0.0
    i = corrected(pair_of(p, 0, 0, "wendland-c2")[0], sums_of(effect, p, 0))
    for b in range(1, len(p.mass)):
        _, j, pair = pair_of(p, 0, b, "wendland-c2")
        plain += Continuity().density_rate(i, j, pair)
        more += effect.density_rate(i, j, pair)
    exact = -1000.0 * np.trace(slope)
    assert plain + more == pytest.approx(exact, rel=1e-10)
    assert abs(plain - exact) > 1e-3 * abs(exact)


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_corrected_pressure_is_exact_for_linear_pressure_on_a_lattice(dim):
    p, slope = patch(dim), np.array([400.0, -300.0, 250.0])[:dim]
    p = p._replace(pressure=slope @ p.position + 50.0)
    effect, found, plain = GradientCorrection(0.01), np.zeros(dim), np.zeros(dim)
    own = sums_of(effect, p, 0)
    for b in range(1, len(p.mass)):
        i, j, pair = pair_of(p, 0, b, "wendland-c2")
        i, j = (corrected(x, own) for x in (i, j))
        plain += SymmetricPressure().radial(i, j, pair) * np.array(pair.x_ij)
        found += effect.push(i, j, pair)
    assert plain + found == pytest.approx(-slope / 1000.0, rel=1e-10)
    assert np.abs(found).max() > 1e-3 * np.abs(plain).max()


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_corrected_pressure_does_the_work_that_compression_takes(dim):
    """Σ m a·u = −Σ m p/ρ² dρ/dt for any L, so that no energy comes from nowhere."""
    p, effect = view(dim=dim), GradientCorrection()
    work = compression = 0.0
    for a, b in itertools.permutations(range(len(p.mass)), 2):
        i, j, pair = pair_of(p, a, b)
        force = SymmetricPressure().radial(i, j, pair) * np.array(pair.x_ij)
        force += effect.push(i, j, pair)
        rate = Continuity().density_rate(i, j, pair) + effect.density_rate(i, j, pair)
        work += i.mass * force @ np.array(i.velocity)
        compression += i.mass * i.pressure * i.specific_volume**2 * rate
    assert work == pytest.approx(-compression, rel=1e-9)


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_corrected_differences_are_exact_for_linear_pressure(dim):
    p, slope = patch(dim, jitter=0.2), np.array([400.0, -300.0, 250.0])[:dim]
    p = p._replace(pressure=slope @ p.position + 50.0)
    effect, found = DifferenceCorrection(0.01), np.zeros(dim)
    i = corrected(pair_of(p, 0, 0)[0], sums_of(effect, p, 0))
    for b in range(1, len(p.mass)):
        _, j, pair = pair_of(p, 0, b, "wendland-c2")
        found += DifferencePressure().radial(i, j, pair) * np.array(pair.x_ij)
        found += effect.push(i, j, pair)
    assert found == pytest.approx(-slope / 1000.0, rel=1e-10)


def pulled(delta, gravity):
    """With gravity along all axes."""
    return TankDiffusion(delta, Steady(gravity))


def in_a_frame(delta, gravity):
    """In a frame that moves."""
    return TankDiffusion(delta, InFrame(gravity))


def pulled_down(delta, gravity):
    """With gravity along some of the axes."""
    return TankDiffusion(delta, Steady((None, *gravity[1:])))


def beside_others(delta, gravity):
    """Among several matters."""
    return TankDiffusion(delta, Steady(gravity), SeveralMatters())


@pytest.mark.parametrize("dim", long_but_for((2, 3), DIMENSIONS, int))
@pytest.mark.parametrize(
    "one",
    [
        DifferenceCorrection(0.5),
        CorrectionBesideWalls(0.5, 1e-4),
        SymmetricPressure(Parting()),
        SymmetricPressure(PartingBesideStrength()),
        CorrectionBesideWalls(0.5, 1e-4, Parting()),
        pulled,
        pulled_down,
        in_a_frame,
        beside_others,
        NeighbourStress(0.2, 1e-4),
    ],
    ids=lambda one: getattr(one, "__name__", type(one).__name__),
)
def test_forms_for_a_scene_are_the_same_compiled(one, dim):
    agree_compiled(one(0.1, (0.3, -9.8, 1.0)[:dim]) if callable(one) else one, dim)


def _species(is_fluid):
    """A fluid or a wall of one density and speed of sound."""
    kind = SimpleNamespace(is_fluid=is_fluid, mobile=is_fluid, bonded=None, shear_modulus=0.0)
    kind.density, kind.sound_speed, kind.cell_count, kind.motion = 1000.0, 50.0, 1, None
    return kind


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_in_a_wall_the_correction_is_that_of_a_whole_lattice(dim):
    """Whatever is missing behind it; in a fluid it is that of the neighbours."""
    scene = SimpleNamespace(
        physics=SimpleNamespace(pressure_gradient="symmetric", tension_floor=None),
        species=[_species(is_fluid=True), _species(is_fluid=False)],
        kernel=kernel("wendland-c2", H, dim),
        spacing=H / 1.3,
        dimensions=dim,
    )
    effect, p = GradientCorrection(0.01).in_scene(scene), patch(dim)
    denser = p._replace(specific_volume=0.9 * p.specific_volume)
    near = 2 * dim + 1  # itself and the nearest: the outer ones are missing
    for crowd in (p, denser):
        whole = np.array(sums_of(GradientCorrection(0.01), crowd, 0))
        assert np.abs(whole).max() > 1e-3
        in_fluid, in_wall = (crowd._replace(is_fluid=np.full(len(p.mass), one)) for one in (1.0, 0.0))
        assert sums_of(effect, in_fluid, 0) == pytest.approx(whole, abs=1e-9)
        assert sums_of(effect, in_wall, 0) == pytest.approx(whole, abs=1e-9)
        assert sums_of(effect, first(in_wall, near), 0) == pytest.approx(whole, abs=1e-9)
        assert np.abs(np.array(sums_of(effect, first(in_fluid, near), 0)) - whole).max() > 1e-2


def first(p, n):
    """The first particles of some."""

    def cut(entry):
        return tuple(map(cut, entry)) if isinstance(entry, tuple) else entry[:n]

    return p._replace(**{k: cut(v) for k, v in p._asdict().items() if isinstance(v, tuple | np.ndarray)})


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_the_correction_fades_where_neighbours_are_missing(dim):
    p = patch(dim)
    matrix = dim * (dim + 1) // 2
    effect = GradientCorrection(0.5)
    i = pair_of(p, 0, 0)[0]
    alone = effect.finish_value(effect.start(i), i, None)
    assert dim == 1 or alone == (0.0,) * (matrix + 1)
    one = sums_of(effect, view(n=2, dim=dim)._replace(mass=np.full(2, 1e-4)), 0)
    assert np.abs(one[:matrix]).max() < 2.1


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
    found = reads(PairDamping(), 2, kernel("cubic", H, 2), BUILT_IN.fields)
    assert found.neighbour == {"mass", "specific_volume", "rest_density", "sound_speed"}
    assert found.own == {"specific_volume", "rest_density", "smoothing_length", "sound_speed"}
    assert found.pair == {"inverse_r", "u_dot_x", "m_dw_r"}


def test_both_sides_of_a_comparison_are_tried():
    assert "rest_density" in reads(FreeSurface(), 2, kernel("cubic", H, 2), BUILT_IN.fields).own
    found = reads(MinimumPressure(), 2, kernel("cubic", H, 2), BUILT_IN.fields)
    assert "pressure" in found.neighbour and "x_ij" in found.pair


def test_an_effect_that_reads_what_nobody_has():
    from typing import NamedTuple

    class Buoyancy(NamedTuple):
        def radial(self, i, j, pair):
            return i.temperature * pair.dw_r

    with pytest.raises(UnknownField, match="Buoyancy reads 'temperature'.*pressure"):
        reads(Buoyancy(), 2, kernel("cubic", H, 2), BUILT_IN.fields)


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_the_pair_potential_bears_no_pressure_on_its_lattice_and_repels_near_pairs(dim):
    dx, potential = 0.01, neutral_potential(0.5, 50.0, 0.01, dim)
    sites = [np.array(k) * dx for k in product(range(-3, 4), repeat=dim) if any(k)]
    forces = [coefficient(potential, x) * x for x in sites]
    pushes = [abs(f @ x) for f, x in zip(forces, sites)]
    assert abs(sum(f @ x for f, x in zip(forces, sites))) < 1e-12 * sum(pushes)
    near, far = (coefficient(potential, np.eye(dim)[0] * r * dx) for r in (0.75, 1.5))
    assert near > 0.0 > far
    # K = f ρ₀ (c/10)²: a = 2K/(ρ₀ dx) at three quarters of a spacing, in 3D half as much again
    assert near * 0.75 * dx == pytest.approx(2 * 0.5 * 5.0**2 / dx * (1.5 if dim == 3 else 1.0))


def coefficient(potential, x):
    """Of x_ij in the acceleration of a particle by one of 0.1 kg, x away."""
    p = view(dim=len(x))
    p = p._replace(
        position=tuple(np.array([c, 0.0]) for c in x),
        mass=np.array([0.1, 0.1]),
    )
    return potential.radial(*pair_of(p, 0, 1))


def test_a_floor_on_tension_for_water_and_for_walls():
    floor, i = TensionFloor(0.98), pair_of(view(), 0, 1)[0]._replace(rest_density=1000.0)
    assert [floor.limit_density(i, rho) for rho in (900.0, 985.0, 1001.0)] == [980.0, 985.0, 1001.0]
    assert [floor.limit_wall_density(i, rho) for rho in (900.0, 985.0)] == [980.0, 985.0]
    assert [floor.bearing_density(i, rho) for rho in (985.0, 1001.0)] == [1000.0, 1001.0]


def test_a_position_shift_sees_the_surface_and_what_crowds():
    """Full, a lattice holds still; at its edge nothing shifts; a near pair parts."""
    scene_kernel, dx = kernel("hyperbolic", H, 2), H / 1.3
    shift = lattice_shift(0.1, scene_kernel, dx, 2)
    x = np.array(list(product(range(-3, 4), repeat=2))) * dx
    centre = int(np.flatnonzero((x == 0.0).all(axis=1))[0])

    def stored(places):
        p = view(n=len(places))._replace(
            position=tuple(places.T),
            mass=np.full(len(places), 1000.0 * dx**2),
            specific_volume=np.full(len(places), 1e-3),
        )
        return np.array(sums_of(shift, p, centre, "hyperbolic"))

    assert stored(x) == pytest.approx((0.0, 0.0), abs=1e-12)
    crowded = x.copy()
    crowded[centre] += (0.3 * dx, 0.0)
    assert stored(crowded)[0] > 0.1 and abs(stored(crowded)[1]) < 1e-12
    edge = x.copy()
    edge[x[:, 1] > 0.5 * dx] += 100.0
    assert (stored(edge) == 0.0).all()


@pytest.mark.parametrize("dim", DIMENSIONS)
@pytest.mark.parametrize("signs", ((-1, -1), (-1, 1), (1, 1)))
def test_artificial_stress(signs, dim):
    p = view(dim=dim)
    p = p._replace(pressure=np.array([700.0, 300.0]) * signs)
    x, _, _, w, grad_w = written_out(p, 0, 1)
    near = kernel("hyperbolic", H, dim).w(H / 1.3)
    part = {(-1, -1): (0.2, 0.2), (-1, 1): (0.2, 0.0), (1, 1): (0.01, 0.01)}[signs]
    r = np.array(part) @ (np.abs(p.pressure) * p.specific_volume**2)
    i, j, pair = pair_of(p, 0, 1)
    push = NeighbourStress(0.2, 1 / near).radial(i, j, pair)
    assert push * x == pytest.approx(-p.mass[1] * r * (w / near) ** 4 * grad_w)
    assert push > 0.0  # it repels, whatever the sign


@pytest.mark.parametrize("dim", DIMENSIONS)
@pytest.mark.parametrize("pressure, inside, sign", ((-7.0, 1.0, -1), (-7.0, 0.0, 1), (7.0, 1.0, 1)))
def test_tensile_control_takes_differences_under_tension_inside(pressure, inside, sign, dim):
    p = view(dim=dim)
    _, _, _, w, grad_w = written_out(p, 0, 1)
    i, j, pair = pair_of(p, 0, 1)
    i, rho = i._replace(pressure=pressure, inside=inside), 1 / p.specific_volume
    a = -p.mass[1] / (rho[0] * rho[1]) * (p.pressure[1] + sign * pressure) * grad_w
    assert TensileControl().radial(i, j, pair) * np.array(pair.x_ij) == pytest.approx(a)
    found = TensileControl().gather(TensileControl().start(i), i, j, pair)
    assert found == pytest.approx(p.mass[1] / rho[1] * w)


def test_tensile_control_sees_a_surface_and_the_inside_of_a_disordered_fluid():
    p, effect = patch(2), TensileControl()
    assert sums_of(effect, p, 0) == 1.0 == sums_of(effect, patch(2, jitter=0.1), 0)
    above = p.position[1] > 0.1 * H
    assert sums_of(effect, p._replace(mass=np.where(above, 0.0, p.mass)), 0) == 0.0


@pytest.mark.parametrize("dim", DIMENSIONS)
@pytest.mark.parametrize("approaching", (True, False))
def test_riemann_dissipation(approaching, dim):
    p, eta = view(dim=dim), 3.0
    x, u, r, _, grad_w = written_out(p, 0, 1)
    if (u @ x < 0) != approaching:
        p = p._replace(velocity=tuple(-v for v in p.velocity))
        u = -u
    rho, c, jump = 1 / p.specific_volume, 50.0, -(u @ x) / r
    for c in (50.0, 0.01):  # the limiter at work, and at its end
        beta = min(eta * max(jump, 0.0), c)
        i, j, pair = pair_of(p._replace(sound_speed=c), 0, 1)
        star = 0.5 * beta * rho.mean() * jump
        a = -2 * p.mass[1] / (rho[0] * rho[1]) * star * grad_w
        assert RiemannDissipation(eta).radial(i, j, pair) * x == pytest.approx(a)
        star = (p.pressure[0] - p.pressure[1]) / (2 * rho.mean() * c)
        rate = 2 * rho[0] * p.mass[1] / rho[1] * star * (grad_w @ x) / r
        assert RiemannDissipation(eta).density_rate(i, j, pair) == pytest.approx(rate)
    assert (a != 0).all() == approaching


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_conservative_smoothing(dim):
    p = view(dim=dim)._replace(is_fluid=np.ones(2))
    _, u, _, w, _ = written_out(p, 0, 1)
    effect, (i, j, pair) = ConservativeSmoothing(0.3), pair_of(p, 0, 1)
    mean = (1 / p.specific_volume).mean()
    a = -0.3 * p.sound_speed.min() / H * p.mass[1] / mean * w * u
    assert effect.shear(i, j, pair) * u == pytest.approx(a)
    back = effect.shear(*pair_of(p, 1, 0)) * -u * p.mass[1]
    assert back == pytest.approx(-p.mass[0] * a)
    assert effect.shear(i, j._replace(is_fluid=0.0), pair) == 0.0


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_xsph_moves_with_the_mean_and_keeps_both_momenta(dim):
    p, effect = view(n=3, dim=dim)._replace(is_fluid=np.ones(3), mobile=np.ones(3)), XSPH(0.4)
    momentum, turning = np.zeros(dim), np.zeros((dim, dim))
    for a in range(3):
        expected = np.zeros(dim)
        for b in set(range(3)) - {a}:
            _, u, _, w, _ = written_out(p, a, b)
            mean = 0.5 * (1 / p.specific_volume[a] + 1 / p.specific_volume[b])
            expected -= 0.4 * p.mass[b] / mean * u * w
        found = gathered(effect, p, a, *(set(range(3)) - {a}))
        assert found == pytest.approx(expected)
        i = pair_of(p, a, (a + 1) % 3)[0]._replace(transport=found)
        assert effect.displacement(i, 1e-3) == pytest.approx(1e-3 * expected)
        # dL/dt = Σ m ũ × u, and Σ m (ũ − u) is what particles carry past the fluid
        momentum += p.mass[a] * np.array(found)
        turning += p.mass[a] * np.outer(found, i.velocity)
    assert momentum == pytest.approx(np.zeros(dim), abs=1e-12)
    assert turning == pytest.approx(turning.T, abs=1e-12) and np.abs(turning).max() > 1e-6


def test_xsph_leaves_walls_alone():
    p, effect = (
        view(n=3)._replace(is_fluid=np.array([1.0, 0.0, 0.0]), mobile=np.array([1.0, 0.0, 0.0])),
        XSPH(0.4),
    )
    assert gathered(effect, p, 0, 1, 2) == pytest.approx((0.0, 0.0), abs=0.0)
    assert gathered(effect, p, 1, 0) == pytest.approx((0.0, 0.0), abs=0.0)


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_transport_velocities(dim):
    p = view(n=3, dim=dim)._replace(is_fluid=np.ones(3), pressure=np.array([3.0, -900.0, 4e6]))
    rho, c = 1 / p.specific_volume, 50.0
    both, own = np.zeros(dim), np.zeros(dim)
    for b in (1, 2):
        grad_w = written_out(p, 0, b)[4]
        both -= H / (8 * c) * p.mass[b] * (1 / rho[0] ** 2 + 1 / rho[b] ** 2) * grad_w
        own -= H / (8 * c) * p.mass[b] / rho[0] ** 2 * grad_w
    found = gathered(TransportVelocity(0.3), p, 0, 1, 2)
    assert found == pytest.approx(0.3 * p.rest_density[0] * c * c * both)
    effect = GeneralisedTransportVelocity(0.3)
    assert gathered(effect, p, 0, 1, 2) == pytest.approx(30.0 * own)
    p = p._replace(pressure=np.array([-4e6, 3.0, 3.0]))
    assert gathered(effect, p, 0, 1, 2) == pytest.approx(0.3 * p.rest_density[0] * c * c * own)
    p = p._replace(is_fluid=np.array([0.0, 1.0, 1.0]))
    assert gathered(effect, p, 0, 1, 2) == pytest.approx((0.0,) * dim, abs=0.0)


@pytest.mark.parametrize("effect", (TransportVelocity(), GeneralisedTransportVelocity(), XSPH()))
def test_what_is_carried_by_a_transport_velocity(effect):
    p = view(dim=3)
    _, _, _, _, grad_w = written_out(p, 0, 1)
    i, j, pair = pair_of(p, 0, 1)
    moved = np.array(i.transport), np.array(j.transport)
    assert effect.displacement(i, 1e-3) == pytest.approx(1e-3 * moved[0])
    rate = p.mass[1] * (moved[0] - moved[1]) @ grad_w
    assert effect.density_rate(i, j, pair) == pytest.approx(rate)
    if hasattr(effect, "push"):
        stress = sum(np.outer(np.array(k.velocity), d) * k.specific_volume for k, d in zip((i, j), moved))
        assert effect.push(i, j, pair) == pytest.approx(p.mass[1] * stress @ grad_w)
