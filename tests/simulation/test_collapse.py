"""A gas under its own gravity: free fall while it is cold, then heat, a shock and a bounce."""

import math

import numpy as np
import pytest
from drafts import draft
from gauging import start
from mpi4py import MPI

from psph.output.ledger import Ledger
from psph.runs.setup import create_particles
from psph.scene import Scene
from psph.scene.checks import faults
from psph.simulation.gas import Unsized
from psph.simulation.gas_deepening import Deepening
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation

CLOUD = """
scheme = "gas"
space = { dimensions = 3, spacing = 0.15 }
time.end = 4.0
physics.self_gravity = { constant = 1.0, softening = 0.05 }
[ideal_gases.cloud]
density = 0.238732414637843
gamma = 1.6666666666666667
thermal_energy = 0.05
shape.ball = { center = [0.0, 0.0, 0.0], radius = 1.0 }
"""
"""1 kg within 1 m."""


def energies(simulation) -> tuple[float, float, float]:
    """Of motion, of the pull and of heat, J."""
    store = simulation.store
    mass, v2 = store.constants["mass"], (store.shown("velocity") ** 2).sum()
    return tuple(
        mass * np.array([0.5 * v2, *(store.shown(n).sum() for n in ("attraction_energy", "thermal_energy"))])
    )


def test_a_cold_cloud_falls_together_as_by_its_weight_alone(tmp_path):
    """r/r₀ = cos² a, a + ½ sin 2a = t √(2GM/R³)."""
    simulation = start(draft(tmp_path, CLOUD, "ideal_gases.cloud.thermal_energy=1e-4"))
    store = simulation.store
    first = dict(zip(store.shown("id").tolist(), np.linalg.norm(store.shown("position"), axis=1)))
    while simulation.time < 0.8:
        simulation.step(0.8)
    begun = np.array([first[one] for one in store.shown("id").tolist()])
    within = (begun > 0.2) & (begun < 0.7)
    shrunk = (np.linalg.norm(store.shown("position"), axis=1) / begun)[within].mean()
    angles = np.linspace(0.0, 0.5 * math.pi, 100_001)
    told = np.cos(np.interp(0.8 * math.sqrt(2.0), angles + 0.5 * np.sin(2 * angles), angles)) ** 2
    assert shrunk == pytest.approx(told, abs=0.03)
    assert told < 0.7  # the control: without the pull it stays 1


def evrard(folder, *changes) -> Simulation:
    """Evrard's cloud, ρ = M/(2πR²r), u = 0.05 GM/R.  Evrard (1988), Mon. Not. R. Astron. Soc. 235, 911."""
    scene = Scene(draft(folder, CLOUD, *changes))
    plan = make_plan(scene)
    store = create_particles(scene, plan, MPI.COMM_SELF)
    r = np.sqrt(sum(x**2 for x in store["position"]))
    for x in store["position"]:
        x *= np.sqrt(r)
    return Simulation(scene, plan, store, MPI.COMM_SELF, Ledger())


def test_evrards_cloud_keeps_its_energy_through_the_bounce(tmp_path):
    """W = −2GM²/3R at the start; most motion near 0.9, most heat near 1.2."""
    simulation = evrard(tmp_path)
    store = simulation.store
    mass, [begun, *rest] = store.owned * store.constants["mass"], [energies(simulation)]
    assert begun[1] == pytest.approx(-2.0 / 3.0 * mass**2, rel=0.02)
    times = np.arange(0.05, 1.5, 0.05)
    for time in times:
        while simulation.time < time:
            simulation.step(time)
        rest.append(energies(simulation))
    motion, _, heat = np.array(rest).T
    assert times[motion.argmax()] == pytest.approx(0.9, abs=0.12)
    assert times[heat.argmax()] == pytest.approx(1.2, abs=0.12)
    assert heat.max() > 15.0 * begun[2]
    assert np.abs(np.sum(rest, axis=1) / sum(begun) - 1.0).max() < 2e-3


@pytest.mark.parametrize("method", ["direct", "tree"])
def test_softening_that_follows_sizes_keeps_energy(method, tmp_path, monkeypatch):
    """Until 0.6 s sizes in the middle halve; without what follows from that 25 times as much is lost."""
    changes = "physics.self_gravity.softening=h", f"physics.self_gravity.method={method}"
    lost = []
    for _ in range(2):
        simulation = evrard(tmp_path, *changes)
        begun = sum(energies(simulation))
        while simulation.time < 0.6:
            simulation.step(0.6)
        lost.append(abs(sum(energies(simulation)) / begun - 1.0))
        momentum = simulation.store.constants["mass"] * simulation.store.shown("velocity").sum(axis=0)
        assert np.abs(momentum).max() < (1e-15 if method == "direct" else 1e-5)
        monkeypatch.setattr(Deepening, "renew", lambda self: None)
    assert lost[0] < 3e-4 and lost[1] > 5e-3


def lost_by(simulation, times: float) -> float:
    """Part of its energy that a cloud loses to 1 s by steps so many times as long as the limit; infinite where
    the run ends."""
    begun = sum(energies(simulation))

    def longer(end):
        dt, limit = simulation.plan.longest_step(simulation.speed, simulation.acceleration)
        return times * dt, limit, simulation.time + times * dt

    simulation._next_step = longer
    try:
        while simulation.time < 1.0:
            simulation.step()
    except Unsized:
        return math.inf
    return abs(sum(energies(simulation)) / begun - 1.0)


COLD = "physics.self_gravity.softening=0.005", "ideal_gases.cloud.thermal_energy=1e-4"


@pytest.mark.parametrize("changes", [(), ("physics.self_gravity.softening=h",), COLD])
def test_energy_is_kept_at_the_limits_of_the_step_and_not_at_four_times_these(changes, tmp_path):
    """By signals, by sizes, and where it falls cold by the pull: "self-gravity" sets the first steps of that."""
    simulation = evrard(tmp_path, *changes)
    _, first = simulation.plan.longest_step(simulation.speed, simulation.acceleration)
    assert ("self-gravity" in first) == (changes == COLD or not changes)
    assert lost_by(simulation, 1.0) < 1e-3
    assert lost_by(evrard(tmp_path, *changes), 4.0) > 5e-3


def test_sizes_soften_gases_alone(tmp_path):
    water = CLOUD.replace("ideal_gases.cloud", "fluids.water").replace('scheme = "gas"\n', "")
    water = "\n".join(line for line in water.splitlines() if not line.startswith(("gamma", "thermal")))
    case = draft(tmp_path, water, "physics.self_gravity.softening=h")
    assert any("sizes of gases" in line for line in faults(Scene(case)))
