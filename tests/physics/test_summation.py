"""Density that returns to what the places of the particles give."""

import types

import pytest

from psph.moments import moments_below_a_surface
from psph.physics.fluid.summation import SummedOnLattice, around_a_surface
from psph.smoothing import KERNELS, kernel


@pytest.mark.parametrize(
    ("fullness", "excess"), [(1.01, 0.01), (0.998, 0.0), (0.98, -0.015), (0.96, 0.0)], ids=str
)
def test_it_acts_outside_what_the_scene_starts_with_and_not_at_a_surface(fullness, excess):
    effect = SummedOnLattice(0.002, -2.0, 0.995, 1.0, 0.97)
    i = types.SimpleNamespace(
        fullness=fullness, is_fluid=1.0, sound_speed=24.0, smoothing_length=0.011, specific_volume=1.25e-3
    )
    j = types.SimpleNamespace(specific_volume=0.98e-3)
    pair = types.SimpleNamespace(m_dw_r=-700.0, r2=1.3e-4)
    share = 0.98e-3 * 700.0 * 1.3e-4 / 2.0
    asked = 0.002 * 24.0 / 0.011 * excess * 800.0 * share
    assert effect.density_rate(i, j, pair) == pytest.approx(asked, rel=1e-9, abs=1e-15)


@pytest.mark.parametrize("name", sorted(KERNELS))
@pytest.mark.parametrize("smoothing", [1.2, 1.4, 2.0])
@pytest.mark.parametrize("dim", [2, 3])
def test_no_row_below_a_plane_surface_is_taken_for_disorder(name, smoothing, dim):
    """At h/dx = 1.2 the second row has 0.985 in 2D: with one threshold for all it would lose its pressure."""
    *rows, full = moments_below_a_surface(kernel(name, smoothing, dim), 1.0, dim)
    fullness = [row / full for row in rows]
    sparse, low = around_a_surface(fullness)
    assert 0.97 <= sparse < low <= 1.0
    assert all(f < sparse or f >= low for f in fullness)
