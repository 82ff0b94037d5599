"""Mie and Grüneisen's pressure: the Hugoniot curve, small strains, and energy around a cycle."""

import numpy as np
import pytest

from psph.physics.solid.compression import EvenBulk, Heat, MieGruneisen

COPPER = MieGruneisen(8930.0, 3940.0, 1.489, 2.02, 0.0)
COLD = Heat(0.0, 0.0)


@pytest.mark.parametrize("behind", (50.0, 500.0, 2000.0))
def test_behind_a_shock_the_pressure_is_on_the_hugoniot_curve(behind):
    """ρ₀U_s = ρ(U_s − u_p), p = ρ₀U_s u_p, e = u_p²/2."""
    shock = 3940.0 + 1.489 * behind
    volume = 1.0 - behind / shock
    state = Heat(8930.0 * 0.5 * behind**2, volume - 1.0)
    assert -COPPER.mean(volume, state) / volume == pytest.approx(8930.0 * shock * behind, rel=1e-12)
    colder = -COPPER.mean(volume, state._replace(energy=0.0)) / volume
    assert colder < 8930.0 * shock * behind - 1.9 * state.energy  # the control: Γρe is missing


def test_small_strains_have_the_bulk_modulus_and_heat_alone_a_pressure():
    bulk = 8930.0 * 3940.0**2
    for strain in (1e-7, -1e-7):
        assert COPPER.mean(1.0 + strain, COLD) == pytest.approx(bulk * strain, rel=1e-6)
        assert EvenBulk(bulk).mean(1.0 + strain, None) == pytest.approx(bulk * strain, rel=1e-6)
    assert COPPER.mean(1.0, Heat(1e6, 0.0)) == pytest.approx(-2.02e6)


def test_slow_compression_gives_back_what_it_took_and_work_stays_as_heat():
    state, work, before = COLD, 0.0, 0.0
    volumes = 1.0 - 0.15 * np.sin(np.linspace(0.0, np.pi, 4001))
    for old, new in zip(volumes, volumes[1:]):
        tau, state = COPPER.pressed(new, state, 0.0, 1e9)
        work += 0.5 * (tau / new + before) * (new - old)
        before = tau / new
        assert state.energy == pytest.approx(work, rel=1e-6, abs=1.0)
    assert abs(state.energy) < 1e-4 * 8930.0 * 0.5 * 500.0**2
    _, heated = COPPER.pressed(1.0, state, 5e6, 1e9)
    assert heated.energy == pytest.approx(state.energy + 5e6)


def test_fast_compression_makes_heat_and_fast_expansion_none():
    law = COPPER._replace(length=1e-4)
    fast, slow = (law.pressed(0.98, COLD, 0.0, dt) for dt in (2e-9, 1.0))
    assert fast[0] < slow[0] < 0.0 and fast[1].energy > slow[1].energy > 0.0
    rate = 0.02 / 0.98 / 2e-9 * 1e-4
    q = 8930.0 / 0.98 * rate * (0.5 * 3940.0 + 1.44 * rate)
    assert fast[1].energy - slow[1].energy == pytest.approx(0.02 * q, rel=0.03)
    assert law.pressed(1.02, COLD, 0.0, 2e-9) == law.pressed(1.02, COLD, 0.0, 1.0)
