"""Density that returns to what the places of the particles give."""

import types

import pytest

from psph.physics.fluid.summation import SummedOnLattice


@pytest.mark.parametrize(
    ("fullness", "excess"), [(1.01, 0.01), (0.998, 0.0), (0.98, -0.015), (0.96, 0.0)], ids=str
)
def test_it_acts_outside_what_the_scene_starts_with_and_not_at_a_surface(fullness, excess):
    effect = SummedOnLattice(0.002, -2.0, 0.995, 1.0)
    i = types.SimpleNamespace(
        fullness=fullness, is_fluid=1.0, sound_speed=24.0, smoothing_length=0.011, specific_volume=1.25e-3
    )
    j = types.SimpleNamespace(specific_volume=0.98e-3)
    pair = types.SimpleNamespace(m_dw_r=-700.0, r2=1.3e-4)
    share = 0.98e-3 * 700.0 * 1.3e-4 / 2.0
    asked = 0.002 * 24.0 / 0.011 * excess * 800.0 * share
    assert effect.density_rate(i, j, pair) == pytest.approx(asked, rel=1e-9, abs=1e-15)
