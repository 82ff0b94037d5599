"""A solid on a chain of fluid cells, in psph's steps: which waves grow, and what calms them."""

import numpy as np
import pytest
from scipy.linalg import expm

from psph.physics.solid.material import CALM, calming_viscosity

CELLS, PACE, FRICTION = 6, 0.25, 0.02
"""Cells of the fluid, up to its surface; the part of a cell that sound passes in a step; friction between cells."""

WAVES = np.concatenate([np.arange(0.05, 1.0, 0.1), np.arange(1.0, 4.0, 0.1), np.arange(4.0, 9.0, 0.5)])
"""ωΔt of the solid by itself."""

SHARES = (0.03, 0.15, 0.3)
"""ρ_f c Δt/(ρ_s H)."""


def half_way(mean, end):
    """What psph.simulation.immersion lets the fluid see."""
    return 0.5 * (mean + end)


def step(state, free, wave, share, seen):
    """One step of Δt = 1 with cells of width 1: the solid in closed form under the push that it had, then the
    fluid as psph.simulation.integrator has it."""
    x, v, push = state[:3]
    w, rho, rate, rate_1, rate_2, a = state[3:].reshape(6, CELLS)
    rest = push / wave**2
    x_1, v_1 = free @ (x - rest, v)
    shown = seen(x_1 + rest - x, v_1)
    rho_hat = rho + 1.75 * rate - rate_1 + 0.25 * rate_2
    w_hat = w + a
    speeds = np.append(shown, w_hat)
    pressures = np.append(PACE**2 * rho_hat, 0.0)
    new_rate, new_push = speeds[:-1] - speeds[1:], -share / PACE * pressures[0]
    drag = FRICTION * np.diff(np.concatenate([w_hat[:1], w_hat, w_hat[-1:]]), 2)
    new_a = pressures[:-1] - pressures[1:] + drag
    fluid = (w + 0.5 * (a + new_a), rho + 0.5 * (rate + new_rate), new_rate, rate, rate_1, new_a)
    return np.concatenate([[x_1 + rest, v_1 + 0.5 * (new_push - push), new_push], *fluid])


def growth(share, calm, seen=half_way):
    """The largest growth of any wave in a step, where Kelvin and Voigt damp it by ``calm`` z (ωΔt)²."""
    found = 0.0
    for wave in WAVES:
        free = expm(np.array([[0.0, 1.0], [-(wave**2), -2.0 * calm * share * wave**2]]))
        matrix = np.array([step(e, free, wave, share, seen) for e in np.eye(3 + 6 * CELLS)]).T
        found = max(found, np.abs(np.linalg.eigvals(matrix)).max())
    return found - 1.0


@pytest.mark.parametrize("share", SHARES)
def test_the_viscosity_of_solids_in_fluids_calms_every_wave(share):
    assert growth(share, CALM) < 0.0
    assert growth(share, 0.5 * CALM) > 0.01 * share  # half of it does not


@pytest.mark.parametrize("share", SHARES)
def test_the_mean_velocity_alone_would_need_more(share):
    assert growth(share, CALM, lambda mean, end: mean) > 0.01 * share


def test_without_viscosity_waves_grow_by_a_part_of_the_share():
    for share in SHARES:
        assert 0.2 * share < growth(share, 0.0) < 0.4 * share


def test_the_viscosity_damps_by_its_part_of_the_share():
    """η ω²/2E′ a second is C z (ωΔt)² a step."""
    young, poisson, share, dt, wave = 7e10, 0.3, 0.07, 2e-4, 1.3
    eta = calming_viscosity(young, poisson, share, dt)
    assert eta * (wave / dt) ** 2 * dt * (1.0 - poisson**2) / (2.0 * young) == pytest.approx(
        CALM * share * wave**2, rel=1e-12
    )
