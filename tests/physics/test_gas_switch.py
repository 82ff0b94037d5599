"""Viscosity of ideal gases with a switch: full in shocks, little where a gas turns or is smooth."""

import numpy as np
import pytest
from drafts import draft
from gauging import start
from parallel.written import written
from physics.test_gas import CLOUD, SWITCHED, of
from runs.resuming import go_on_elsewhere

from psph.simulation.gas import find_sizes

VORTEX = """
scheme = "gas"
[space]
dimensions = 2
spacing = 0.03125
kernel = "wendland-c4"
smoothing = 1.8
periodic = ["x", "y"]
lower = [-0.5, -0.5]
upper = [0.5, 0.5]
[time]
end = 1.3
[ideal_gases.gas]
shape.box = { lower = [-0.5, -0.5], upper = [0.5, 0.5] }
density = 1.0
pressure = 5.0
gamma = 1.6666666666666667
"""


def swirl(r):
    """v_φ and p of the vortex of Gresho & Chan (1990), which stays as it is."""
    rim = np.maximum(r, 0.2)
    v = np.where(r < 0.2, 5.0 * r, np.maximum(2.0 - 5.0 * r, 0.0))
    ring = 9.0 + 12.5 * r**2 - 20.0 * r + 4.0 * np.log(5.0 * rim)
    return v, np.where(r < 0.2, 5.0 + 12.5 * r**2, np.where(r < 0.4, ring, 3.0 + 4.0 * np.log(2.0)))


def turned(tmp_path, *sets):
    """The vortex after a turn of its fastest ring: mean error of v_φ within it, m/s, and the part of the energy
    of motion that is left."""
    simulation = start(draft(tmp_path, VORTEX, *sets))
    store = simulation.store
    x, y = np.array(store["position"])
    r = np.maximum(np.hypot(x, y), 1e-12)
    v, p = swirl(r)
    for name in ("velocity", "predicted_velocity"):
        store[name][0][:], store[name][1][:] = -v * y / r, v * x / r
    for name in ("thermal_energy", "predicted_thermal_energy"):
        store[name][store.inner] = 1.5 * p[store.inner] / store["density"][store.inner]
    simulation.listed = False
    find_sizes(simulation)
    simulation.engine.sum(0, 0.0, 0.0, ghosts_are_fresh=False)
    simulation.engine.begin_rates()
    begun = (of(simulation, "velocity")[0] ** 2).sum()
    while simulation.time < 1.3:
        simulation.step(1.3)
    x, u = of(simulation, "position", "velocity")
    r = np.hypot(*x.T)
    along = (x[:, 0] * u[:, 1] - x[:, 1] * u[:, 0]) / r
    return np.abs(along - swirl(r)[0])[r < 0.4].mean(), (u**2).sum() / begun


def test_a_vortex_keeps_turning_as_it_does_not_with_the_same_viscosity_everywhere(tmp_path):
    error, kept = turned(tmp_path, SWITCHED)
    even_error, even_kept = turned(tmp_path)
    assert kept > 0.6 and even_kept < 0.2
    assert error < 0.17 and even_error > 0.3


def test_a_gas_knows_how_it_is_compressed_and_turns(tmp_path):
    """In a linear flow exactly: ∇·v and |∇×v| of its gradient, whatever the disorder."""
    simulation = start(draft(tmp_path, CLOUD, SWITCHED))
    x, h, flow, turn = of(simulation, "position", "smoothing_length", "velocity_divergence", "vorticity_size")
    deep = x[:, 0] < 1.0 - 2.0 * h.max()
    assert deep.sum() > 30
    assert flow[deep] == pytest.approx(-0.3, abs=1e-12) and turn[deep] == pytest.approx(0.7, abs=1e-12)
    [share] = of(simulation, "viscosity_share")
    assert share[deep].max() < 0.31 and share.max() > 0.7


@pytest.mark.mpi(min_size=2)
@pytest.mark.parametrize("before, after", [(1, 2), (2, 1)])
def test_shares_are_the_same_on_any_ranks_and_after_a_checkpoint(mpi_tmp_path, before, after):
    moving = "velocity_gradient = [[-3.0, 2.0], [0.0, -2.0]]\njitter = 0.3\n"
    case = written(mpi_tmp_path, f"{SWITCHED}\n{VORTEX}{moving}")
    go_on_elsewhere(case, before, after, mpi_tmp_path)
