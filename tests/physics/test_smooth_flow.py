"""What smooth flow does not feel: reconstructed damping, diffusion of fourth order, the local potential."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from drafts import TANK, draft
from physics.pairs import corrected, pair_of, sums_of, view
from physics.test_conservation import potential_of_unequal

from psph.case import CaseError, load
from psph.physics.damping.diffusion import BesideSmoothDensity, DensityDiffusion, TankDiffusion
from psph.physics.damping.matter import SeveralFluids
from psph.physics.damping.reconstructed import (
    BesideLinearFlow,
    DampingToEdges,
    EndingAtOthers,
    ReconstructedDamping,
    Whole,
    WithStrengths,
    images_of,
)
from psph.physics.fluid.correction import GradientCorrection
from psph.physics.fluid.pressure import BackgroundPressure, CorrectedBackground
from psph.physics.fluid.viscosity import PairDamping
from psph.physics.fluid.weight import Steady
from psph.physics.order.potential import LocalPotential
from psph.scene import Scene
from psph.simulation.plan import make_plan

DIMENSIONS = (1, 2, 3)
ALPHA, C = 0.3, 50.0
OTHERS = EndingAtOthers(SeveralFluids())


def crowd(dim, n=12, seed=5):
    """Fluid particles in disorder within a support, each with its own L of all the others."""
    p = view(n=n, dim=dim, seed=seed)
    p = p._replace(is_fluid=np.ones(n), mass=p.mass * (20.0 if dim == 1 else 1.0))  # a full row
    found = [sums_of(GradientCorrection(1e-9), p, k) for k in range(n)]
    return corrected(p, tuple(map(np.array, zip(*found))))


def fourth(dim):
    """Diffusion of fourth order in a scene without gravity."""
    return BesideSmoothDensity(0.1, Steady((None,) * dim))


def linear_flow(p, dim, seed=2):
    """The same particles in a flow u = G x, with G, its symmetric part as a field, and the part itself."""
    g = np.random.default_rng(seed).normal(size=(dim, dim))
    u = g @ np.array(p.position)
    part = 0.5 * (g + g.T)
    upper = tuple(np.full(len(p.mass), part[a, b]) for a in range(dim) for b in range(a, dim))
    return p._replace(velocity=tuple(u), strain=upper), g, upper


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_the_rate_of_strain_of_a_linear_flow_is_exact_in_disorder(dim):
    p, _, upper = linear_flow(crowd(dim), dim)
    found = sums_of(BesideLinearFlow(ALPHA, 0.0), p, 3)
    assert found == pytest.approx([component[0] for component in upper], rel=1e-9)


def test_the_rate_of_strain_fades_where_neighbours_are_in_a_line():
    p, _, _ = linear_flow(crowd(2, n=2), 2)
    assert np.abs(sums_of(BesideLinearFlow(ALPHA, 0.0), p, 0)).max() < 1e-9


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_walls_are_as_nothing_to_the_rate_of_strain(dim):
    p, _, upper = linear_flow(crowd(dim), dim)
    walls = p._replace(is_fluid=np.append(np.ones(8), np.zeros(4)))
    walls = walls._replace(velocity=tuple(np.append(u[:8], 0.0 * u[8:]) for u in p.velocity))
    found = sums_of(DampingToEdges(ALPHA, 0.0), walls, 3)[: len(upper)]
    assert found == pytest.approx([part[3] for part in upper], rel=1e-9)
    all_flow = sums_of(BesideLinearFlow(ALPHA, 0.0), walls._replace(is_fluid=np.ones(12)), 3)
    assert found != pytest.approx(all_flow, rel=0.1)  # the control


def test_other_fluids_are_as_nothing_to_the_rate_of_strain():
    p, _, upper = linear_flow(crowd(2), 2)
    apart = p._replace(rest_density=np.append(np.full(6, 1000.0), np.full(6, 500.0)))
    apart = apart._replace(velocity=tuple(np.append(u[:6], 9.0 * u[6:]) for u in apart.velocity))
    apart = apart._replace(wave_speed=np.full(12, C))
    found = sums_of(DampingToEdges(ALPHA, 0.0, 0.0, OTHERS), apart, 3)[:3]
    assert found == pytest.approx([part[3] for part in upper], rel=1e-9)
    assert found != pytest.approx(sums_of(DampingToEdges(ALPHA, 0.0), apart, 3)[:3], rel=0.1)


@pytest.mark.parametrize(
    "laws, densities, flows, parts",
    (
        ((1.0, 2.0), (1600.0, 1900.0), 1.0, 0.0),  # two soils
        ((1.0, -1.0), (1600.0, 1600.0), 0.0, 0.0),  # soil, and its image where it is held
        ((1.0, 0.0), (1000.0, 1000.0), 0.0, 1.0),
        ((0.0, -1.0), (1000.0, 1600.0), 0.0, 1.0),
        ((0.0, 0.0), (1000.0, 1000.0), 1.0, 0.0),
        ((0.0, 0.0), (1000.0, 900.0), 0.0, 1.0),
    ),
)
def test_soils_flow_on_with_each_other_and_water_with_its_own(laws, densities, flows, parts):
    p = view()._replace(is_fluid=np.ones(2), strength=np.array(laws), rest_density=np.array(densities))
    i, j, _ = pair_of(p._replace(wave_speed=np.full(2, C)), 0, 1)
    images = WithStrengths(SeveralFluids())
    assert (images.flows(i, j), images.is_other(i, j)) == (flows, parts)


BLOCK = "[solids.block]\nshape.box = { lower = [0.3, 0.5], upper = [0.6, 0.8] }\ndensity = 1100.0\nyoung = 1e6\npoisson = 0.3\n"
OIL = "[fluids.oil]\nshape.box = { lower = [0.7, 0.5], upper = [0.9, 0.7] }\ndensity = 800.0\n"


def test_two_fluids_part_beside_solids_too(tmp_path):
    stable = ("scheme=stable", "physics.sound_speed=40.0")
    assert images_of(Scene(draft(tmp_path, TANK + OIL + BLOCK, *stable))) == OTHERS
    assert images_of(Scene(draft(tmp_path, TANK + BLOCK, *stable))) == Whole()


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_a_fluid_knows_the_normal_of_the_wall_it_is_at(dim):
    p = crowd(dim)._replace(is_fluid=np.append(np.ones(11), np.zeros(1)))  # one wall particle: it is there
    facing = np.array(sums_of(DampingToEdges(ALPHA, 0.0), p, 3)[-dim:])
    towards = np.array([x[3] - x[11] for x in p.position])
    assert facing == pytest.approx(towards / np.linalg.norm(towards), rel=1e-9)
    assert not np.any(sums_of(DampingToEdges(ALPHA, 0.0), p, 11)[-dim:])  # a wall itself has none
    assert not np.any(sums_of(DampingToEdges(ALPHA, 0.0), crowd(dim), 3)[-dim:])


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_a_linear_flow_is_not_damped_and_what_is_beside_it_is(dim):
    p, _, _ = linear_flow(crowd(dim), dim)
    smooth, plain = BesideLinearFlow(ALPHA, 0.0), PairDamping(ALPHA)
    for b in range(1, 5):
        i, j, pair = pair_of(p, 0, b)
        scale = abs(plain.radial(i, j, pair))
        assert scale > 0.0 and abs(smooth.radial(i, j, pair)) < 1e-12 * scale
        near = BesideLinearFlow(ALPHA, 2.0 * pair.r2)  # a pair in disorder: the whole of it
        assert near.radial(i, j, pair) == pytest.approx(plain.radial(i, j, pair), rel=1e-12)
        still = i._replace(strain=tuple(0.0 * e for e in i.strain))
        at_rest = j._replace(strain=tuple(0.0 * e for e in j.strain))
        assert smooth.radial(still, at_rest, pair) == pytest.approx(plain.radial(i, j, pair), rel=1e-12)


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_each_pair_only_loses_energy_whatever_the_strain(dim):
    """0 ≤ s′/s ≤ 1: between nothing and what plain pair damping takes."""
    rng = np.random.default_rng(7)
    some = 0
    for _ in range(200):
        p = view(dim=dim, seed=int(rng.integers(1000)))._replace(is_fluid=np.ones(2))
        strain = tuple(rng.normal(size=2) * 300.0 for _ in p.gradient_correction)
        i, j, pair = pair_of(p._replace(strain=strain), 0, 1)
        share = BesideLinearFlow(ALPHA, 0.0).radial(i, j, pair) / PairDamping(ALPHA).radial(i, j, pair)
        assert 0.0 <= share <= 1.0 + 1e-12
        some += 0.01 < share < 0.99
    assert some > 20


@pytest.mark.parametrize(
    "is_fluid, images, unfelt", ((0.0, Whole(), 0.02), (0.0, OTHERS, 0.02), (1.0, OTHERS, 0.1))
)
def test_a_wall_or_another_fluid_damps_what_comes_fast_and_nothing_else(is_fluid, images, unfelt):
    i, j, pair = beside(is_fluid, lambda x: x)
    effect, plain = DampingToEdges(ALPHA, 0.0, 0.0, images), PairDamping(ALPHA)
    for speed in (3.0 * C, 0.13 * C, 0.09 * C, 0.03 * C, 0.019 * C, 0.0, -0.5 * C):  # of approach
        u_ij = tuple(-speed * x / pair.r for x in pair.x_ij)
        moving = pair._replace(u_ij=u_ij, u_dot_x=-speed * pair.r)
        felt = max(speed - unfelt * C, 0.0)
        expected = plain.radial(i, j, pair._replace(u_dot_x=-felt * pair.r))
        assert effect.radial(i, j, moving) == pytest.approx(expected, rel=1e-12, abs=1e-12)


def test_what_slides_along_a_wall_does_not_approach_it():
    """The control: the same approach of the pair, along the normal."""
    effect, sliding = DampingToEdges(ALPHA, 0.0), (-1.7 * C, 1.1 * C)
    i, j, pair = beside(0.0, lambda x: (sliding[1], -sliding[0]))
    towards = np.sign(sliding[0] * pair.x_ij[0] + sliding[1] * pair.x_ij[1])
    u_ij = tuple(-towards * u for u in sliding)
    moving = pair._replace(u_ij=u_ij, u_dot_x=sum(u * x for u, x in zip(u_ij, pair.x_ij)))
    assert moving.u_dot_x < -0.1 * C * pair.r and effect.radial(i, j, moving) == 0.0
    i, j, _ = beside(0.0, lambda x: x)
    assert abs(effect.radial(i, j, moving)) > 0.0


def beside(is_fluid, normal):
    """A fluid particle and another, and their pair: the first ends at what has this normal, by their distance."""
    p = view()._replace(is_fluid=np.array([1.0, is_fluid]), strain=tuple(np.full(2, 9.0) for _ in range(3)))
    p = p._replace(sound_speed=np.array([C, 1.2 * C]))  # the slower one counts
    x_ij = pair_of(p, 0, 1)[2].x_ij
    n = np.array(normal(x_ij)) / np.linalg.norm(normal(x_ij))
    return pair_of(p._replace(facing=tuple(np.array([one, -is_fluid * one]) for one in n)), 0, 1)


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_the_gradient_of_a_linear_density_is_exact_in_disorder(dim):
    p = crowd(dim)
    slope = np.array((300.0, -700.0, 500.0)[:dim])
    rho = p.rest_density + 20.0 + slope @ p.position
    p = p._replace(specific_volume=1.0 / rho)
    found = [sums_of(GradientCorrection(1e-9), p, k) for k in range(len(rho))]  # volumes have changed
    p = corrected(p, tuple(map(np.array, zip(*found))))
    assert sums_of(fourth(dim), p, 4) == pytest.approx(slope, rel=1e-9)


def parabola(dim):
    """Two fluid particles in order, in a density of the second order, with its gradient; and this one."""
    p = view(dim=dim)._replace(is_fluid=np.ones(2))
    x, slope, bend = np.array(p.position), np.array((30.0, -70.0, 50.0)[:dim]), 4e3
    rho = p.rest_density + 2.0 + slope @ x + bend * (x * x).sum(axis=0)
    gradient = slope[:, None] + 2.0 * bend * x
    ordered = tuple(0.0 * e for e in p.gradient_correction)
    p = corrected(p, ordered)._replace(specific_volume=1.0 / rho)
    return p._replace(density_gradient=tuple(gradient)), gradient


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_a_quadratic_density_does_not_spread_and_a_step_does(dim):
    """∇ρ at both ends is that of the parabola: the mean of two slopes is the slope between them."""
    p, gradient = parabola(dim)
    second = DensityDiffusion(0.1).density_rate(*pair_of(p, 0, 1))
    assert abs(fourth(dim).density_rate(*pair_of(p, 0, 1))) < 1e-9 * abs(second)
    for wrong in (-gradient, 0.0 * gradient):  # with the wrong sign nothing is taken off, nor added
        pair = pair_of(p._replace(density_gradient=tuple(wrong)), 0, 1)
        assert fourth(dim).density_rate(*pair) == pytest.approx(second, rel=1e-12)


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_in_disorder_all_of_a_density_spreads(dim):
    p, _ = parabola(dim)
    second = DensityDiffusion(0.1).density_rate(*pair_of(p, 0, 1))
    symmetric = [np.eye(dim)[a, b] for a in range(dim) for b in range(a, dim)]
    for sizes, share in (((0.2, 0.9), 1.0), ((0.0, 0.2), 0.5), ((0.1, 0.1), 0.25)):
        rough = tuple(np.array(sizes) * e / np.sqrt(dim) for e in symmetric)
        found = fourth(dim).density_rate(*pair_of(corrected(p, rough), 0, 1))
        assert found == pytest.approx(share * second, rel=1e-9)


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_density_never_flows_to_where_there_is_more(dim):
    """0 ≤ s′/s ≤ 1, whatever the gradients say, beside what weight asks for."""
    rng, some = np.random.default_rng(3), 0
    pull = (None, -9.8, 4.0)[:dim] if dim > 1 else (-9.8,)
    for _ in range(200):
        p = view(dim=dim, seed=int(rng.integers(1000)))._replace(is_fluid=np.ones(2))
        gradient = tuple(rng.normal(size=2) * 3e4 for _ in range(dim))
        pair = pair_of(p._replace(density_gradient=gradient), 0, 1)
        second = TankDiffusion(0.1, Steady(pull)).density_rate(*pair)
        share = BesideSmoothDensity(0.1, Steady(pull)).density_rate(*pair) / second
        assert -1e-9 <= share <= 1.0 + 1e-9
        some += 0.01 < share < 0.99
    assert some > 20


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_damping_is_stronger_in_disorder(dim):
    p, _, _ = linear_flow(view(dim=dim)._replace(is_fluid=np.ones(2)), dim)
    p = p._replace(strain=tuple(0.0 * e for e in p.strain))
    symmetric = [np.eye(dim)[a, b] for a in range(dim) for b in range(a, dim)]
    for sizes, alpha in (((0.0, 0.0), 0.1), ((0.0, 0.2), 0.2), ((0.3, 0.2), 0.3)):
        rough = tuple(np.array(sizes) * e / np.sqrt(dim) for e in symmetric)
        pair = pair_of(corrected(p, rough), 0, 1)
        found = BesideLinearFlow(0.1, 0.0, 0.2).radial(*pair)
        assert found == pytest.approx(PairDamping(alpha).radial(*pair), rel=1e-12)


FILLED = """
[space]
dimensions = 2
spacing = 0.1
lower = [0.0, 0.0]
upper = [2.0, 2.0]
periodic = ["x", "y"]

[time]
end = 1.0

[physics]
sound_speed = 10.0

[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [2.0, 1.0] }
density = 1000.0

[fluids.oil]
shape.box = { lower = [0.0, 1.0], upper = [2.0, 2.0] }
density = 800.0
"""

SOIL = """[soils.sand]
young = 1e5
poisson = 0.3
friction_angle = 30.0"""


def test_damping_in_disorder_is_at_most_the_own_one_where_one_fluid_fills_the_domain(tmp_path):
    """By the viscosity of the fluid, in 2D 8ν/(ch); controls: the same with two fluids, with a tension between
    alike ones, beside soil, and with room above."""

    def more(*keys, of=FILLED):
        scene = Scene(draft(tmp_path, of, *keys))
        return ReconstructedDamping(0.03, 0.2).in_scene(scene).more

    same = "fluids.oil.density=1000.0"
    assert more(same) == 0.0
    viscous = [f"fluids.{name}.viscosity" for name in ("water", "oil")]
    acts = 8.0 * 0.01 / (10.0 * 0.14)  # 0.057
    assert more(same, *(f"{key}=0.01" for key in viscous)) == pytest.approx(acts - 0.03)
    assert more(same, *(f"{key}=1.0" for key in viscous)) == pytest.approx(0.17)
    assert more() == pytest.approx(0.17)
    assert more(same, "fluids.water.interfacial_tension={oil=0.03}") == pytest.approx(0.17)
    assert more(of=FILLED.replace("[fluids.oil]", SOIL)) == pytest.approx(0.17)
    assert more(of=FILLED.partition("[fluids.oil]")[0]) == pytest.approx(0.17)


def potential(dim):
    """The form of the local potential in a scene with spacing 0.01 m."""
    scene = SimpleNamespace(sound_speed=C, spacing=0.01, dimensions=dim)
    return LocalPotential(0.5, 0.2).in_scene(scene)


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_the_potential_acts_in_disorder_alone(dim):
    p, whole = view(dim=dim), potential_of_unequal(dim)
    symmetric = [np.eye(dim)[a, b] for a in range(dim) for b in range(a, dim)]

    def force(of_i, of_j):
        correction = tuple(np.array([of_i, of_j]) * e / np.sqrt(dim) for e in symmetric)
        return potential(dim).radial(*pair_of(corrected(p, correction), 0, 1))

    full = whole.radial(*pair_of(p, 0, 1))
    assert full != 0.0 and force(0.0, 0.0) == 0.0
    assert force(0.2, 7.0) == pytest.approx(full, rel=1e-12)
    assert force(0.0, 0.2) == pytest.approx(0.5 * full, rel=1e-12)
    assert force(0.1, 0.1) == pytest.approx(0.25 * full, rel=1e-12)


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_the_potential_is_stronger_where_a_pair_is_not_compressed(dim):
    """By p/ρ of both ends, whose densities differ: whole under tension, once from a mean of 0.004 (c/10)² on."""
    scene = SimpleNamespace(sound_speed=C, spacing=0.01, dimensions=dim, has_free_surface=True)
    filled = SimpleNamespace(sound_speed=C, spacing=0.01, dimensions=dim, has_free_surface=False)
    p, whole = view(dim=dim), LocalPotential(0.5, 0.2).in_scene(scene)
    stronger = LocalPotential(0.5, 0.2, 3.0).in_scene(scene)
    assert LocalPotential(0.5, 0.2, 3.0).in_scene(filled) == whole
    if dim == 3:
        assert stronger == whole
        return
    once, both = whole.radial(*pair_of(p, 0, 1)), 0.008 * (C / 10.0) ** 2

    def force(own, other):
        pressed = p._replace(pressure=np.array([own, other]) / p.specific_volume)
        return stronger.radial(*pair_of(pressed, 0, 1)) / once

    assert once != 0.0 and p.specific_volume[0] != p.specific_volume[1]
    assert [force(-own, 0.0) for own in (0.0, 5.0)] == pytest.approx([3.0, 3.0], rel=1e-12)
    assert force(0.75 * both, -0.25 * both) == pytest.approx(2.0, rel=1e-12)
    assert force(-0.25 * both, 0.5 * both) == pytest.approx(2.5, rel=1e-12)
    assert [force(both, 0.0), force(0.5 * both, 9.0 * both)] == pytest.approx([1.0, 1.0], rel=1e-12)


@pytest.mark.parametrize("dim", DIMENSIONS)
def test_a_corrected_background_is_the_plain_one_and_what_the_correction_adds(dim):
    p = view(dim=dim)
    i, j, pair = pair_of(p, 0, 1)
    plain = BackgroundPressure(40.0).radial(i, j, pair) * np.array(pair.x_ij)
    none = tuple(0.0 * e for e in i.gradient_correction)
    uncorrected = (corrected(i, none), corrected(j, none))
    assert CorrectedBackground(40.0).push(*uncorrected, pair) == pytest.approx(plain, rel=1e-12)
    raised, lower = (
        np.array(GradientCorrection().push(*pair_of(p._replace(pressure=p.pressure + up), 0, 1)))
        for up in (40.0, 0.0)
    )
    added = np.array(CorrectedBackground(40.0).push(i, j, pair)) - plain
    assert added == pytest.approx(raised - lower, rel=1e-6)


def test_they_say_what_they_need(tmp_path):
    for key in ("reconstructed_damping=0.05", "local_potential=0.008", "fourth_order_diffusion=0.1"):
        with pytest.raises(CaseError, match="takes corrected gradients; set physics.gradient_correction"):
            draft(tmp_path, TANK, f"physics.{key}")
    together = ("scheme=stable", "physics.density_diffusion=0.1")
    with pytest.raises(CaseError, match='set that to "off"'):
        draft(tmp_path, TANK, *together)
    assert draft(tmp_path, TANK, *together, "physics.fourth_order_diffusion=off")


CASES = Path(__file__).parents[2] / "run" / "cases" / "hard"
CORRECTED = ("physics.gradient_correction=1.0",)
SMOOTH = ("gradient_correction", "reconstructed_damping", "fourth_order_diffusion", "local_potential")
UNCORRECTED = tuple(f"physics.{name}=off" for name in SMOOTH)


@pytest.mark.parametrize(
    "case, keys, needed",
    [
        ("box", CORRECTED, 1.4 * 2500.0),
        ("box", (*CORRECTED, "fluids.fluid.velocity=[30.0, 0.0]"), 1.4 * 2500.0),
        ("box", (*CORRECTED, "fluids.fluid.pressure=2500.0"), None),
        ("taylor_green", CORRECTED, None),
        ("taylor_green", UNCORRECTED, 1.4 * 0.5),
        ("patch", CORRECTED, None),
    ],
)
def test_with_corrected_gradients_a_flow_bears_its_own_tension(case, keys, needed):
    """ "auto" is then what the start lacks everywhere, however fast it drifts; a free surface has none."""
    plan = make_plan(Scene(load(CASES / f"{case}.toml", list(keys))))
    found = [e.pressure for e in plan.effects if isinstance(e, (BackgroundPressure, CorrectedBackground))]
    assert found == pytest.approx([] if needed is None else [needed])
