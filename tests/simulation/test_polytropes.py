"""Balls of gas in equilibrium, p = K ρ^(1 + 1/n): their own weight, and how they swing."""

import math

import numpy as np
import pytest
from drafts import draft
from mpi4py import MPI
from scipy.integrate import solve_ivp
from scipy.optimize import curve_fit
from simulation.test_collapse import CLOUD, energies

from psph.output.ledger import Ledger
from psph.runs.setup import create_particles
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation

SPACING = 0.1
WITHOUT_FRICTION = (
    f"space.spacing={SPACING}",
    "physics.self_gravity={constant=1.0, softening='h', method='tree'}",
    "physics.shock_viscosity=off",
    "physics.heat_conduction=off",
)


def lane_emden(n: float) -> np.ndarray:
    """ξ, θ and −ξ²θ′ from the middle to the surface (3, points): θ″ + 2θ′/ξ = −θⁿ."""

    def rates(x, y):
        return [-y[1] / x**2, x**2 * max(y[0], 0.0) ** n]

    def surface(x, y):
        return y[0]

    surface.terminal = True
    found = solve_ivp(rates, (1e-6, 20.0), [1.0, 0.0], events=surface, max_step=0.005, rtol=1e-10, atol=1e-12)
    return np.array([found.t, *found.y])


def polytrope(folder, n: float, rate: float) -> tuple[Simulation, float]:
    """A ball of 1 m and about 1 kg that grows by ``rate`` of itself a second, and its mass: a lattice drawn
    together along radii."""
    scene = Scene(draft(folder, CLOUD, *WITHOUT_FRICTION))
    plan = make_plan(scene)
    store = create_particles(scene, plan, MPI.COMM_SELF)
    r, mass = np.sqrt(sum(x**2 for x in store["position"])), store.owned * store.constants["mass"]
    xi, theta, weight = lane_emden(n)
    within = r**3 / (store.owned * SPACING**3 * 0.75 / math.pi)
    place = np.interp(within, weight / weight[-1], xi / xi[-1])
    # α = R/ξ₁, M = 4πα³ρ_c w₁, p/ρ = 4πGα²ρ_c θ/(n + 1)
    heat = mass * xi[-1] / weight[-1] / (n + 1.0) * np.interp(place, xi / xi[-1], theta)
    stretch = place / np.maximum(r, 1e-9)
    for x, v in zip(store["position"], store["velocity"]):
        x *= stretch
        v[:] = rate * x
    for name in ("thermal_energy", "predicted_thermal_energy"):
        store[name][:] = 1.5 * np.maximum(heat, 1e-3 * heat.max())
    return Simulation(scene, plan, store, MPI.COMM_SELF, Ledger()), mass


@pytest.mark.parametrize("n", [1.0, 1.5])
def test_a_polytrope_has_its_weight(n, tmp_path):
    """W = −3/(5 − n) GM²/R, and half of that in heat (γ = 5/3)."""
    simulation, mass = polytrope(tmp_path, n, 0.0)
    _, weight, heat = energies(simulation)
    told = -3.0 / (5.0 - n) * mass**2
    assert weight == pytest.approx(told, rel=0.01)
    assert heat == pytest.approx(-0.5 * told, rel=0.01)


@pytest.mark.long
@pytest.mark.parametrize(("n", "period"), [(1.0, 4.57), (1.5, 3.82)])
def test_a_polytrope_swings_in_its_time(n, period, tmp_path):
    """ω²R³/GM = 1.894 and 2.71 of the slowest radial swing for γ = 5/3: of 1/W, which goes as the radius, half of
    what differs between a ball that is pushed outwards and one that is pushed inwards."""
    times, seen = np.arange(0.0, 1.1 * period, 0.1), []
    for rate in (0.05, -0.05):
        simulation, mass = polytrope(tmp_path, n, rate)
        seen.append([])
        for time in times:
            while simulation.time < time:
                simulation.step(time)
            seen[-1].append(-1.0 / energies(simulation)[1])
    swing = 0.5 * (np.array(seen[0]) - seen[1])

    def told(t, most, fades, frequency, phase, middle):
        return most * np.exp(-fades * t) * np.sin(frequency * t + phase) + middle

    guess = (swing.max(), 0.05, 2.0 * math.pi / period, 0.0, 0.0)
    fitted, _ = curve_fit(told, times, swing, p0=guess)
    assert np.std(swing - told(times, *fitted)) < 0.05 * swing.max()
    assert 2.0 * math.pi / fitted[2] * math.sqrt(mass) == pytest.approx(period, rel=0.02)
