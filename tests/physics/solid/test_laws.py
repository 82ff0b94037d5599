"""Laws of elasticity: stress is the derivative of energy, small strains follow Hooke, turns give nothing."""

import numpy as np
import pytest

from psph.physics.solid.laws import LAWS, moduli
from psph.physics.solid.material import solid_of
from psph.physics.solid.rubber import MooneyRivlin, Ogden

YOUNG, POISSON = 2.0e6, 0.3
LAME, SHEAR = moduli(YOUNG, POISSON)
BULK = LAME + 2.0 * SHEAR / 3.0
RUBBERS = (
    MooneyRivlin(0.3 * SHEAR, 0.2 * SHEAR, BULK),
    Ogden((1.5 * SHEAR, 0.02 * SHEAR, -0.1 * SHEAR), (0.8, 20.0, -4.0), BULK),
)


def turned(angle, d):
    c, s = np.cos(angle), np.sin(angle)
    turn = np.eye(d)
    turn[:2, :2] = [[c, -s], [s, c]]
    if d == 3:
        turn = turn @ np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    return turn


def rows(matrix):
    return tuple(matrix.ravel().tolist())


def axis(d):
    return (1.0,) * d


laws = pytest.mark.parametrize(
    "law", [*(kind(LAME, SHEAR) for kind in LAWS.values()), *RUBBERS], ids=lambda law: type(law).__name__
)


@laws
@pytest.mark.parametrize("d", (2, 3))
def test_stress_is_the_derivative_of_the_energy(law, d):
    f = np.eye(d) + 0.2 * np.random.default_rng(3).standard_normal((d, d))
    stress, step = np.reshape(law.stress(rows(f), axis(d)), (d, d)), 1e-6
    for k in np.ndindex(d, d):
        change = np.zeros((d, d))
        change[k] = step
        ends = [law.energy(rows(f + sign * change), axis(d)) for sign in (1.0, -1.0)]
        assert (ends[0] - ends[1]) / (2.0 * step) == pytest.approx(stress[k], rel=1e-6, abs=1e-3)


@laws
@pytest.mark.parametrize("d", (2, 3))
def test_small_strains_follow_hooke(law, d):
    strain = 1e-7 * np.random.default_rng(4).standard_normal((d, d))
    strain = 0.5 * (strain + strain.T)
    found = np.reshape(law.stress(rows(np.eye(d) + strain), axis(d)), (d, d))
    hooke = LAME * np.trace(strain) * np.eye(d) + 2.0 * SHEAR * strain
    assert found == pytest.approx(hooke, rel=1e-5, abs=1e-6 * np.abs(hooke).max())
    if d == 2:
        assert law.across(rows(np.eye(d) + strain), axis(d)) == pytest.approx(
            LAME * np.trace(strain), rel=1e-4
        )


@laws
@pytest.mark.parametrize("d", (2, 3))
@pytest.mark.parametrize("angle", (0.3, 1.5, 3.1))
def test_a_turn_gives_no_stress_and_stress_turns_along(law, d, angle):
    turn, f = turned(angle, d), np.eye(d) + 0.1 * np.random.default_rng(5).standard_normal((d, d))
    assert np.abs(law.stress(rows(turn), axis(d))).max() < 1e-9 * YOUNG
    before, after = (np.reshape(law.stress(rows(g), axis(d)), (d, d)) for g in (f, turn @ f))
    assert after == pytest.approx(turn @ before, rel=1e-9, abs=1e-9 * YOUNG)


def test_neo_hooke_pushes_back_what_is_turned_inside_out():
    law = LAWS["neo-hookean"](LAME, SHEAR)
    inverted = law.stress((-0.5, 0.0, 0.0, 1.0), axis(2))
    assert np.isfinite(inverted).all() and inverted[0] < 0.0  # −∂ψ/∂F pushes F_xx up, towards 1


def test_saint_venant_kirchhoff_loses_stiffness_below_a_stretch_of_one_over_root_three():
    law = LAWS["saint-venant-kirchhoff"](0.0, SHEAR)
    forces = [law.stress((s, 0.0, 0.0, 1.0), axis(2))[0] for s in (0.5, 3**-0.5, 0.65)]
    assert forces[1] < forces[0] and forces[1] < forces[2]


def test_wave_speed_and_steps():
    one = solid_of("beam", 1000.0, 1.4e6, 0.4, "neo-hookean", 0.0, 0.1)
    assert one.wave_speed == pytest.approx(54.772, rel=1e-4) and one.stiffness == pytest.approx(1.4e5)
    assert one.longest_step(1e-3, 5.0) == pytest.approx(0.6e-3 / 59.772, rel=1e-4)
    assert one._replace(viscosity=1e3).longest_step(1e-3, 5.0) == pytest.approx(0.125 * 1e-6)
