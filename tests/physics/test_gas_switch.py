"""Viscosity of ideal gases with a switch: full in shocks, little where a gas turns or is smooth."""

from pathlib import Path

import numpy as np
import pytest
from cases.measures import CASES
from drafts import draft
from gauging import start
from parallel.written import written
from physics.test_gas import CLOUD, SWITCHED, of
from runs.resuming import go_on_elsewhere

from psph.case import load

VORTEX = Path(CASES) / "gas/gresho.toml"
EVERYWHERE = "physics.shock_viscosity={ alpha = 1.0, beta = 2.0, least = 1.0 }"


def swirl(r):
    """v_φ of the vortex of Gresho & Chan (1990), which stays as it is."""
    return np.where(r < 0.2, 5.0 * r, np.maximum(2.0 - 5.0 * r, 0.0))


def turned(*sets):
    """The vortex after a turn of its fastest ring: mean error of v_φ within it, m/s, and the part of the energy
    of motion that is left."""
    simulation = start(load(VORTEX, sets))
    begun = (of(simulation, "velocity")[0] ** 2).sum()
    while simulation.time < 1.3:
        simulation.step(1.3)
    x, u = of(simulation, "position", "velocity")
    r = np.hypot(*x.T)
    along = (x[:, 0] * u[:, 1] - x[:, 1] * u[:, 0]) / r
    return np.abs(along - swirl(r))[r < 0.4].mean(), (u**2).sum() / begun


def test_a_vortex_keeps_turning_as_it_does_not_with_the_same_viscosity_everywhere():
    error, kept = turned()
    even_error, even_kept = turned(EVERYWHERE)
    assert kept > 0.7 and even_kept < 0.2
    assert error < 0.11 and even_error > 0.3


def test_a_gas_knows_how_it_is_compressed_and_turns(tmp_path):
    """In a linear flow exactly: ∇·v and |∇×v| of its gradient, whatever the disorder."""
    simulation = start(draft(tmp_path, CLOUD, SWITCHED))
    x, h, flow, turn = of(simulation, "position", "smoothing_length", "velocity_divergence", "vorticity_size")
    deep = x[:, 0] < 1.0 - 2.0 * h.max()
    assert deep.sum() > 30
    assert flow[deep] == pytest.approx(-0.3, abs=1e-12) and turn[deep] == pytest.approx(0.7, abs=1e-12)
    [share] = of(simulation, "viscosity_share")
    assert share[deep].max() < 0.31 and share.max() > 0.7


def test_a_gas_at_rest_begins_as_without_the_switch(tmp_path):
    """Nothing rubs where nothing moves.  The first sums are done twice for the switch, and the pressure of a
    prediction is that of the density alone: with it a blast lost 2 % of its energy in its first step."""
    rest = [f"ideal_gases.{name}" for name in ("light", "heavy")]
    calm = (
        "ideal_gases.light.velocity_gradient=[[0.0, 0.0], [0.0, 0.0]]",
        "ideal_gases.heavy.velocity=[0.0, 0.0]",
    )
    hot = (f"{rest[0]}.pressure=50.0", f"{rest[1]}.pressure=0.2")
    found = []
    for sets in ((SWITCHED,), ("time.halvings=2", SWITCHED), ()):
        found.append(
            of(start(draft(tmp_path, CLOUD, *calm, *hot, *sets)), "acceleration", "thermal_energy_rate")
        )
    for ours in found[:2]:
        assert all(np.abs(a - b).max() < 1e-12 * np.abs(b).max() for a, b in zip(ours, found[2]))
    assert np.abs(found[2][0]).max() > 100.0


@pytest.mark.mpi(min_size=2)
@pytest.mark.parametrize("before, after", [(1, 2), (2, 1)])
def test_shares_are_the_same_on_any_ranks_and_after_a_checkpoint(mpi_tmp_path, before, after):
    moving = "velocity_gradient = [[-3.0, 2.0], [0.0, -2.0]]\njitter = 0.3\n"
    case = written(mpi_tmp_path, VORTEX.read_text() + moving)
    go_on_elsewhere(case, before, after, mpi_tmp_path)
