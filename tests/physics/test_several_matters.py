"""What spreads between neighbours where soils differ from each other, or from a fluid."""

from types import SimpleNamespace

import numpy as np
import pytest
from physics.pairs import corrected, pair_of, sums_of, view

from psph.physics.damping.diffusion import BesideSmoothDensity, TankDiffusion
from psph.physics.damping.matter import OneMatter, SeveralMatters
from psph.physics.fluid.weight import Steady
from psph.physics.stress.spreading import AnyOrder, SeenOrder, StressSlopes, levelled, spread

PULL = (0.4, -9.8)
LEVEL = levelled(SimpleNamespace(gravity=PULL))
SPREADING = (TankDiffusion, BesideSmoothDensity)


def beside(**fields):
    """A pair of particles that both flow, with further fields."""
    p = view()._replace(is_fluid=np.ones(2), mass=np.array([0.06, 0.09]), sound_speed=np.full(2, 50.0))
    return p._replace(**{name: np.array(values) for name, values in fields.items()})


@pytest.mark.parametrize("effect", SPREADING)
def test_density_spreads_within_a_matter_alone_and_what_one_gains_the_other_loses(effect):
    apart, within = beside(wave_speed=(60.0, 45.0)), beside(wave_speed=(45.0, 45.0))
    several, one = effect(0.1, Steady(PULL), SeveralMatters()), effect(0.1, Steady(PULL), OneMatter())
    assert several.density_rate(*pair_of(apart, 0, 1)) == 0.0
    assert one.density_rate(*pair_of(apart, 0, 1)) != 0.0  # the control: as in a fluid
    gained = [several.density_rate(*pair_of(within, *ends)) for ends in ((0, 1), (1, 0))]
    volume = within.mass * within.specific_volume
    assert gained[0] * volume[0] == pytest.approx(-gained[1] * volume[1], rel=1e-12)
    assert gained[0] != 0.0


@pytest.mark.parametrize("effect", SPREADING)
def test_a_still_column_keeps_the_slope_of_its_own_matter(effect):
    """ρ − ρ₀ = ρ₀ g·x/c² with the c of the soil, not that of the scene."""
    p = beside(wave_speed=(30.0, 30.0), rest_density=(900.0, 900.0))
    x = np.array(p.position)
    slope = 900.0 * np.array(PULL) / 30.0**2
    level = p._replace(
        specific_volume=1.0 / (900.0 + slope @ x), density_gradient=tuple(np.full(2, g) for g in slope)
    )
    i, j, pair = pair_of(level, 0, 1)
    still = effect(0.1, Steady(PULL), SeveralMatters()).density_rate(i, j, pair)
    assert abs(still) < 1e-9 * abs(effect(0.1, Steady(PULL), OneMatter()).density_rate(i, j, pair))


def test_stress_spreads_within_a_soil_alone_and_what_one_gains_the_other_loses():
    apart, within = beside(strength=(1.0, 2.0)), beside(strength=(2.0, 2.0))
    assert spread(SeenOrder(), LEVEL, *pair_of(apart, 0, 1)) == (0.0, 0.0, 0.0)
    assert spread(SeenOrder(), LEVEL, *pair_of(beside(strength=(0.0, 0.0)), 0, 1)) == (0.0, 0.0, 0.0)
    gained = [np.array(spread(SeenOrder(), LEVEL, *pair_of(within, *ends))) for ends in ((0, 1), (1, 0))]
    volume = within.mass * within.specific_volume
    assert gained[0] * volume[0] == pytest.approx(-gained[1] * volume[1], rel=1e-12)
    assert (gained[0] != 0.0).all()


@pytest.mark.parametrize("dim", (2, 3))
def test_a_stress_that_is_linear_stays_whatever_else_is_near(dim):
    """In disorder, with neighbours on one side alone, another soil among them."""
    upper = dim * (dim + 1) // 2
    slopes = np.random.default_rng(2).normal(size=(dim, upper)) * 1e4
    level = levelled(SimpleNamespace(gravity=(0.4, -9.8, 0.3)[:dim]))
    p = view(n=40, dim=dim)._replace(strength=np.resize((1.0, 1.0, 2.0), 40))
    x = np.array(p.position)
    other = 1e5 * (p.strength > 1.0)
    p = p._replace(deviator=tuple(slopes.T @ x + other))
    found = [np.ravel(sums_of(StressSlopes(), p, b)) for b in (0, 1)]
    assert found[0] == pytest.approx(slopes.ravel(), rel=1e-9)
    known = p._replace(stress_slopes=tuple(np.resize(at, 40) for at in found[0]))
    plain = p._replace(stress_slopes=tuple(np.zeros(40) for _ in found[0]))
    left, whole = (np.abs(spread(AnyOrder(), level, *pair_of(q, 0, 1))).max() for q in (known, plain))
    assert left < 1e-9 * whole


def test_where_nothing_smooth_stays_the_stress_of_level_ground_does():
    """In disorder, s = (1 − K₀) ρg·x of the weight; control: with the slopes of that instead, which disorder forgets."""
    disorder = tuple(np.full(2, x) for x in (1.6, 0.0, 0.0, 1.6))
    p = beside(strength=(2.0, 2.0), rest_coefficient=(0.4, 0.4), rest_density=(1600.0, 1600.0))
    p = corrected(p, disorder)._replace(stress_slopes=tuple(np.zeros(2) for _ in p.stress_slopes))
    depth = 0.6 * 1600.0 * np.array(LEVEL[0]) @ np.array(p.position)
    ground = p._replace(deviator=tuple(shape * depth for shape in LEVEL[1]))
    left = np.abs(spread(SeenOrder(), LEVEL, *pair_of(ground, 0, 1))).max()
    forgotten = np.abs(spread(AnyOrder(), LEVEL, *pair_of(ground, 0, 1))).max()
    assert left < 1e-9 * forgotten
