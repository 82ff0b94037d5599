"""Plasticity at one material point: yield in shear, the return, hardening, rate and heat, and turns."""

import numpy as np
import pytest
from physics.solid.test_laws import axis, rows, turned

from psph.engine.jit import compiled
from psph.physics.solid.compression import EvenBulk
from psph.physics.solid.history import History
from psph.physics.solid.laws import moduli
from psph.physics.solid.material import solid_of
from psph.physics.solid.plastic import JohnsonCook, Lasting, LinearHardening, Metal, strength
from psph.physics.solid.strain import elastic_part

YOUNG, POISSON = 117.0e9, 0.35
LAME, SHEAR = moduli(YOUNG, POISSON)
BULK = LAME + 2.0 * SHEAR / 3.0
VERGENT = JohnsonCook(90e6, 292e6, 0.31, 0.025, 1.09, 1063.0, 0.9 / (8930.0 * 383.0))


def copper(yielding):
    return Metal(EvenBulk(BULK), SHEAR, yielding)


def fresh(d):
    return History((0.0,) * (d * (d + 1) // 2), 0.0, 0.0)


def cauchy(law, f, past, d):
    """The Cauchy stress of 3D, Pa."""
    p = np.reshape(law.stress(rows(f), past, axis(d)), (d, d))
    whole, j = np.zeros((3, 3)), np.linalg.det(f)
    whole[:d, :d] = p @ f.T / j
    if d == 2:
        whole[2, 2] = law.across(rows(f), past, axis(d)) / j
    return whole


def mises(sigma):
    s = sigma - np.trace(sigma) / 3.0 * np.eye(3)
    return np.sqrt(1.5 * (s * s).sum())


def sheared(law, d, strains, dt=1e-6):
    """Simple shear in steps: the deformation and the history at its end."""
    past, f = fresh(d), np.eye(d)
    for strain in strains:
        f = np.eye(d)
        f[0, 1] = strain
        _, past = law.flow(rows(f), past, dt, axis(d))
    return f, past


@pytest.mark.parametrize("d", (2, 3))
def test_yield_in_simple_shear_is_at_the_yield_stress_over_root_three(d):
    """Strains of 1e-6 to 3e-6, so that the turn of the shear itself counts for nothing."""
    law = copper(LinearHardening(1e-6 * SHEAR, 0.0))
    f, past = sheared(law, d, np.linspace(0.0, 3e-6, 40)[1:])
    found = cauchy(law, f, past, d)
    assert found[0, 1] == pytest.approx(1e-6 * SHEAR / np.sqrt(3.0), rel=1e-10)
    assert past.strain == pytest.approx((3e-6 - 1e-6 / np.sqrt(3.0)) / np.sqrt(3.0), rel=1e-5)
    below, none = sheared(law, d, [0.5e-6])
    assert none == fresh(d) and cauchy(law, below, none, d)[0, 1] == pytest.approx(0.5e-6 * SHEAR, rel=1e-9)


@pytest.mark.parametrize("d", (2, 3))
@pytest.mark.parametrize("hardening", (0.0, 0.1e9))
def test_the_stress_stays_on_the_surface_and_the_history_isochoric(d, hardening):
    law = copper(LinearHardening(0.4e9, hardening))
    f, past = sheared(law, d, np.linspace(0.0, 0.8, 400)[1:])
    j = np.linalg.det(f)
    on = 0.4e9 + hardening * past.strain
    assert mises(j * cauchy(law, f, past, d)) == pytest.approx(on, rel=1e-3 if hardening else 1e-12)
    b, b_zz = elastic_part(rows(f), past.metric, j, axis(d))
    whole = np.zeros((3, 3))
    whole[np.triu_indices(d)], whole[2, 2] = b, b_zz if d == 2 else b[-1]
    whole = whole + whole.T - np.diag(np.diag(whole))
    assert np.linalg.det(whole) == pytest.approx(1.0, abs=1e-9)
    assert past.strain == pytest.approx(0.8 / np.sqrt(3.0), rel=0.02)
    assert past.work == pytest.approx(0.4e9 * past.strain + 0.5 * hardening * past.strain**2, rel=3e-3)


@pytest.mark.parametrize("d", (2, 3))
def test_unloaded_metal_springs_back_elastically_and_turns_change_nothing(d):
    law, turn = copper(LinearHardening(0.4e9, 0.1e9)), turned(0.9, d)
    f, past = sheared(law, d, np.linspace(0.0, 0.05, 60)[1:])
    back = f.copy()
    back[0, 1] -= 1e-3
    _, after = law.flow(rows(back), past, 1e-6, axis(d))
    assert after == past
    drop = cauchy(law, f, past, d)[0, 1] - cauchy(law, back, past, d)[0, 1]
    assert drop == pytest.approx(1e-3 * SHEAR, rel=5e-3)
    far = np.eye(d)
    far[0, 1] = 0.06
    (p, one), (q, other) = (law.flow(rows(g), past, 1e-6, axis(d)) for g in (far, turn @ far))
    assert np.reshape(q, (d, d)) == pytest.approx(turn @ np.reshape(p, (d, d)), abs=1e-9 * YOUNG)
    assert one.strain > past.strain and other.strain == pytest.approx(one.strain, rel=1e-9)
    assert np.allclose(one.metric, other.metric, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("d", (2, 3))
def test_stress_is_the_derivative_of_the_energy_at_what_is_remembered(d):
    law = copper(LinearHardening(0.4e9, 0.1e9))
    _, past = sheared(law, d, np.linspace(0.0, 0.1, 60)[1:])
    f = np.eye(d) + 0.05 * np.random.default_rng(3).standard_normal((d, d))
    stress, step = np.reshape(law.stress(rows(f), past, axis(d)), (d, d)), 1e-6
    for k in np.ndindex(d, d):
        change = np.zeros((d, d))
        change[k] = step
        ends = [law.energy(rows(f + sign * change), past, axis(d)) for sign in (1.0, -1.0)]
        assert (ends[0] - ends[1]) / (2.0 * step) == pytest.approx(stress[k], rel=1e-6, abs=1e-5 * YOUNG)


def test_johnson_and_cook_by_their_formula():
    warm = 0.9 * 2e8 / (8930.0 * 383.0)
    expected = (90e6 + 292e6 * 0.2**0.31) * (1.0 + 0.025 * np.log(5e3)) * (1.0 - (warm / 1063.0) ** 1.09)
    assert VERGENT.strength(0.2, 5e3, 2e8) == pytest.approx(expected, rel=1e-12)
    slow, hot = VERGENT.strength(0.2, 1e-4, 2e8), VERGENT.strength(0.2, 5e3, 1e11)
    assert slow == pytest.approx(expected / (1.0 + 0.025 * np.log(5e3)), rel=1e-12) and hot == 0.0


@pytest.mark.parametrize("d", (2, 3))
def test_johnson_and_cook_meets_its_yield_stress_at_the_rate_of_the_step(d):
    law, dt = copper(VERGENT), 1e-7
    strains = np.linspace(0.0, 0.3, 300)
    _, before = sheared(law, d, strains[1:-1], dt)
    f, past = sheared(law, d, strains[1:], dt)
    rate = (past.strain - before.strain) / dt
    assert rate > 1e3
    level = strength(VERGENT, past.strain, rate, before.work)
    assert mises(np.linalg.det(f) * cauchy(law, f, past, d)) == pytest.approx(level, rel=1e-10)
    slow, _ = sheared(law, d, strains[1:], 1e3), None
    assert mises(cauchy(law, *slow, d)) < 0.85 * mises(cauchy(law, f, past, d))  # the control: no rate


def test_compiled_flow_gives_the_same_numbers():
    @compiled
    def run(law, f, past, dt, a):
        return law_flow((law,), 0, f, past, dt, a)

    from psph.simulation.solid_memory import law_flow

    for d in (2, 3):
        for law in (copper(VERGENT), copper(LinearHardening(0.4e9, 0.1e9)), Lasting(solid().law)):
            _, past = sheared(law, d, np.linspace(0.0, 0.1, 20)[1:])
            f = np.eye(d)
            f[0, 1] = 0.11
            p, now = run(law, rows(f), past, 1e-7, axis(d))
            q, then = law.flow(rows(f), past, 1e-7, axis(d))
            assert np.allclose(p, q, rtol=1e-12, atol=1e-12 * YOUNG)
            assert np.allclose(now.metric, then.metric, rtol=0.0, atol=1e-13)
            assert now.strain == pytest.approx(then.strain, rel=1e-11)


def solid(**keys):
    return solid_of("bar", 8930.0, YOUNG, POISSON, "neo-hookean", 0.0, 0.3, **keys)


def test_keys_give_laws_and_elastic_ones_remember_nothing():
    assert solid(yield_stress=0.4e9, hardening=0.1e9).law == copper(LinearHardening(0.4e9, 0.1e9))
    table = dict(zip(JohnsonCook._fields[:-1], VERGENT[:-1]), heat_capacity=383.0)
    assert solid(johnson_cook=table).law == copper(VERGENT)
    assert solid(johnson_cook=table | {"heat_capacity": None}).law.yielding.heated == 0.0
    law = Lasting(solid().law)
    past = History((0.1, 0.2, 0.3), 0.4, 0.5)
    f = (1.1, 0.2, 0.0, 0.9)
    assert law.flow(f, past, 1e-6, axis(2)) == (solid().law.stress(f, axis(2)), past)
