"""Shocks and rarefactions of ideal gases against exact solutions, and a square that should not move."""

import numpy as np
import pytest
from drafts import draft
from gauging import start
from physics.test_gas import SWITCHED, means, of

from psph.theory.riemann import GasState, riemann

GAS = """
scheme = "gas"
[space]
dimensions = {dimensions}
spacing = {spacing}
{space}
[time]
end = 1.0
[ideal_gases.gas]
shape = {{ {shape} }}
density = 1.0
gamma = {gamma}
{start}
"""
TUBE = 'periodic = ["x"]\nlower = [-1.0]\nupper = [1.0]'
LINE = "box = { lower = [-1.0], upper = [1.0] }"


def at_end(tmp_path, end, *sets, spacing=0.002, dimensions=1, shape=LINE, space="", gamma=1.4, start_by):
    """A gas ``end`` seconds on, and the energy that it has gained, as part of what it had."""
    text = GAS.format(
        dimensions=dimensions, spacing=spacing, shape=shape, space=space, gamma=gamma, start=start_by
    )
    simulation = start(draft(tmp_path, text, *sets))
    begun = energy(simulation)
    while simulation.time < end:
        simulation.step(end)
    simulation.settle_pressure()
    return simulation, energy(simulation) / begun - 1.0


def energy(simulation):
    v, u, mass = of(simulation, "velocity", "thermal_energy", "mass")
    return mass @ (0.5 * (v**2).sum(axis=1) + u)


def along(simulation, *names):
    """Of a gas in 1D what it has, in order along x."""
    x, *fields = of(simulation, "position", *names)
    order = np.argsort(x[:, 0])
    return x[order, 0], *(field[order] for field in fields)


@pytest.mark.parametrize("sets", [(), (SWITCHED,), ("time.halvings=4",)])
def test_a_strong_blast_runs_as_the_exact_one(tmp_path, sets):
    """1000 : 0.01 Pa, 1000 particles in 2 m."""
    blast = 'pressure = "1000 if abs(x) < 0.5 else 0.01"'
    simulation, drift = at_end(tmp_path, 0.008, *sets, space=TUBE, start_by=blast)
    exact = riemann(GasState(1.0, 1000.0), GasState(1.0, 0.01), 1.4)
    x, rho, p, v = along(simulation, "density", "pressure", "velocity")
    xi = (x - 0.5) / 0.008
    behind = (xi > 0.0) & (p > 0.5 * exact.pressure)
    assert xi[behind].max() == pytest.approx(23.5175, rel=0.01)
    assert rho.max() == pytest.approx(6.0, rel=0.03)
    assert means(xi, (p, v[:, 0]), -5.0, 17.0) == pytest.approx([exact.pressure, exact.velocity], rel=0.01)
    assert abs(drift) < 1e-4
    assert np.abs(p - exact.at(xi)[1])[x > 0.0].mean() < 4.5


def test_gases_that_part_leave_little_and_none_of_it_cold(tmp_path):
    """1-2-3: p 0.4, v ∓2, 1000 particles; exactly 0.022 kg/m are left in the middle."""
    start_by = 'pressure = 0.4\nvelocity = ["2 if x > 0 else -2"]'
    simulation, drift = at_end(tmp_path, 0.15, start_by=start_by)
    exact = riemann(GasState(1.0, 0.4, -2.0), GasState(1.0, 0.4, 2.0), 1.4)
    x, rho, u = along(simulation, "density", "thermal_energy")
    inner = np.abs(x) < 0.5
    error = rho - exact.at(x / 0.15)[0]
    assert np.abs(error[inner]).mean() < 0.01
    assert rho.min() == pytest.approx(exact.middle_density(exact.left), abs=0.01)
    assert u.min() > 0.3 and abs(drift) < 1e-5


def test_cold_gases_that_meet_are_four_times_as_dense(tmp_path):
    """Noh (1987): ρ = ((γ + 1)/(γ − 1))^d behind shocks that run back at 1/3; the middle is too hot."""
    start_by = 'pressure = 1e-6\nvelocity = ["-1 if x > 0 else 1"]'
    simulation, drift = at_end(tmp_path, 0.6, spacing=0.02, gamma=5.0 / 3.0, start_by=start_by)
    x, rho = along(simulation, "density")
    behind = (np.abs(x) > 0.04) & (np.abs(x) < 0.14)
    assert rho[behind].mean() == pytest.approx(4.0, rel=0.02)
    assert np.abs(x[rho > 2.5]).max() == pytest.approx(0.2, abs=0.01)
    assert abs(drift) < 1e-3


def test_errors_behind_meeting_gases_are_as_small_as_others_have_them(tmp_path):
    """Noh by 100 particles a side: means, over space, of the errors of ρ, p, v and u; a Riemann scheme has 0.054,
    0.018, 0.024 and 0.011."""
    start_by = 'pressure = 1e-6\nvelocity = ["-1 if x > 0 else 1"]'
    simulation, _ = at_end(tmp_path, 0.6, spacing=0.01, gamma=5.0 / 3.0, start_by=start_by)
    x, rho, p, v, u = along(simulation, "density", "pressure", "velocity", "thermal_energy")
    behind, space = np.abs(x) < 0.2, 1.0 / rho
    found = [
        np.average(np.abs(value - np.where(behind, inside, before)), weights=space)
        for value, inside, before in (
            (rho, 4.0, 1.0),
            (p, 4.0 / 3.0, 1e-6),
            (np.abs(v[:, 0]), 0.0, 1.0),
            (u, 0.5, 1.5e-6),
        )
    ]
    assert np.all(np.array(found) < [0.1, 0.022, 0.02, 0.013])  # 0.089, 0.020, 0.018, 0.012


EIGHTH = "lower = [0.0, 0.0, 0.0]\nupper = [1.0, 1.0, 1.0]\nsymmetry = ['x.lower', 'y.lower', 'z.lower']"


def implosion(tmp_path, dimensions, spacing):
    """Noh's of a disc or an eighth of a ball of 1 m after 0.6 s: distances from the middle, densities, and drift
    of energy."""
    shape = f"{'disc' if dimensions == 2 else 'ball'} = {{ center = {[0.0] * dimensions}, radius = 1.0 }}"
    inward = ", ".join(f'"-{axis} / r"' for axis in "xyz"[:dimensions])
    start_by = f"pressure = 1e-6\nvelocity = [{inward}]"
    whole = {"spacing": spacing, "dimensions": dimensions, "shape": shape, "gamma": 5.0 / 3.0}
    space = EIGHTH if dimensions == 3 else ""
    simulation, drift = at_end(tmp_path, 0.6, start_by=start_by, space=space, **whole)
    x, rho = of(simulation, "position", "density")
    return np.linalg.norm(x, axis=1), rho, drift


def test_a_disc_that_falls_together_is_sixteen_times_as_dense(tmp_path):
    """Noh in 2D, 25 particles in a radius: 13.7 of 16 behind a shock at 0.2 m, (1 + t/r) before it."""
    r, rho, drift = implosion(tmp_path, 2, 0.04)
    assert 13.0 < rho[(r > 0.14) & (r < 0.2)].mean() < 16.0
    assert r[rho > 8.0].max() == pytest.approx(0.2, abs=0.05)
    before = (r > 0.28) & (r < 0.36)
    assert (rho[before] / (1.0 + 0.6 / r[before])).mean() == pytest.approx(1.0, abs=0.03)
    assert abs(drift) < 2e-4


@pytest.mark.long
def test_a_ball_that_falls_together_is_denser_the_finer_it_is(tmp_path):
    """Noh in 3D, 20 particles in a radius: 30 of 64 behind a shock that is ahead of 0.2 m."""
    r, rho, drift = implosion(tmp_path, 3, 0.05)
    assert 29.0 < rho[(r > 0.2) & (r < 0.24)].mean() < 64.0
    assert np.quantile(r[rho > 20.0], 0.9) == pytest.approx(0.26, abs=0.03)
    assert abs(drift) < 2e-4


def test_a_blast_in_space_runs_as_sedov_has_it(tmp_path):
    """1 J in a ball of 0.06 m, 25 particles along an edge: 1.0328 (E t²/ρ)^(1/5) for γ 1.4, Sedov (1959)."""
    low, high = [-0.5] * 3, [0.5] * 3
    space = f'periodic = ["x", "y", "z"]\nlower = {low}\nupper = {high}'
    hot = f'thermal_energy = "1e-6 + {1.0 / (np.pi**1.5 * 0.06**3)} * exp(-(r / 0.06)**2)"'
    box = f"box = {{ lower = {low}, upper = {high} }}"
    whole = {"spacing": 0.04, "dimensions": 3, "shape": box, "space": space}
    simulation, drift = at_end(tmp_path, 0.05, start_by=hot, **whole)
    x, rho = of(simulation, "position", "density")
    edges = np.arange(0.2, 0.5, 0.02)
    shell = np.digitize(np.linalg.norm(x, axis=1), edges)
    mean = [rho[shell == k].mean() for k in range(1, len(edges))]
    place = edges[np.argmax(mean)] + 0.01
    assert place == pytest.approx(1.0328 * (0.05**2) ** 0.2, rel=0.05) and max(mean) > 1.4
    assert energy(simulation) == pytest.approx(1.0, rel=5e-3) and abs(drift) < 3e-3
