"""Contact of solids in a simulation: what it keeps, what it costs where it is, and that else it is not there."""

import numpy as np
import pytest
from drafts import draft
from simulation.test_immersion import start

from psph.scene import Scene
from psph.simulation.plan import make_plan

BLOCKS = """
[space]
dimensions = 2
spacing = 0.1
[time]
end = 1.0
[physics]
contact = {}
[solids.left]
shape.box = { lower = [0.0, 0.0], upper = [0.8, 1.0] }
density = 1200.0
young = 2.0e6
poisson = 0.4
velocity = [4.0, 0.5]
jitter = 0.1
[solids.right]
shape.box = { lower = [1.1, 0.3], upper = [1.8, 1.0] }
density = 700.0
young = 5.0e6
poisson = 0.2
law = "neo-hookean"
velocity = [-3.0, -1.0]
jitter = 0.1
"""
"""Two blocks of two densities and laws that meet askew."""


def motion(simulation):
    """Momentum, kg m/s, angular momentum, kg m²/s, and Σ m|v|."""
    store = simulation.store
    m, v, x = store.shown("mass"), store.shown("velocity"), store.shown("position")
    spin = (m * (x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0])).sum()
    return (m[:, None] * v).sum(axis=0), spin, (m * np.linalg.norm(v, axis=1)).sum()


def energy(simulation):
    store = simulation.store
    kinetic = 0.5 * (store.shown("mass") * (store.shown("velocity") ** 2).sum(axis=1)).sum()
    return kinetic + simulation.engine.stored_energy()


def bounced(case, steps=160):
    simulation = start(case)
    begun, most = (motion(simulation), energy(simulation)), 0.0
    for _ in range(steps):
        simulation.step()
        most = max(most, simulation.store.shown("contact_energy").sum())
    return simulation, begun, most


def gap(simulation):
    """Of the middles of the two blocks, m."""
    x, group = simulation.store.shown("position")[:, 0], simulation.store.shown("group")
    return x[group == 1].mean() - x[group == 0].mean()


def test_a_bounce_keeps_energy_and_both_momenta(tmp_path):
    simulation, ((momentum, spin, size), whole), most = bounced(draft(tmp_path, BLOCKS))
    after, turned, _ = motion(simulation)
    assert most > 0.02 * whole and simulation.store.shown("contact_energy").max() == 0.0  # met, and parted
    assert np.abs(after - momentum).max() < 1e-14 * size and abs(turned - spin) < 1e-13 * size
    assert energy(simulation) == pytest.approx(whole, rel=2e-3)
    assert gap(simulation) > 1.05


def test_without_contact_they_run_through_each_other_and_nobody_looks_for_neighbours(tmp_path):
    case = draft(tmp_path, BLOCKS, "physics.contact=off")
    plan = make_plan(Scene(case))
    assert not plan.passes and not plan.touching
    assert {"solid", "contact_energy", "wave_modulus"}.isdisjoint(plan.arrays)
    assert "wave_modulus" not in plan.constants
    simulation = start(case)
    for _ in range(80):
        simulation.step()
    assert gap(simulation) < 0.6


def test_one_solid_alone_has_no_contact(tmp_path):
    case = draft(tmp_path, BLOCKS, "solids.right=off")
    plan = make_plan(Scene(case))
    assert not plan.passes and "nothing meets" in plan.dropped["SolidContact"]


def test_damping_and_friction_take_energy_and_keep_the_momentum(tmp_path):
    keys = ("physics.contact.damping=0.5", "physics.contact.friction=0.5")
    damped, ((momentum, _, size), whole), _ = bounced(draft(tmp_path, BLOCKS, *keys))
    assert np.abs(motion(damped)[0] - momentum).max() < 1e-14 * size
    assert energy(damped) < 0.97 * whole
