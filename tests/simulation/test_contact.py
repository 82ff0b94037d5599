"""Contact of solids in a simulation: what it keeps, what it costs where it is, and that else it is not there."""

import math

import numpy as np
import pytest
from contacts import BARS, BLOCKS, box, energy, motion, on_slope, wrong
from drafts import draft
from gauging import start
from long import LONG

from psph.physics.solid.contact import STEP
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.solid_plan import solid_plan


def bounced(case, steps=360):
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
    assert np.abs(after - momentum).max() < 1e-14 * size and np.abs(turned - spin).max() < 1e-13 * size
    assert energy(simulation) == pytest.approx(whole, rel=2e-3)
    assert gap(simulation) > 1.05


def test_without_contact_they_run_through_each_other_and_nobody_looks_for_neighbours(tmp_path):
    case = draft(tmp_path, BLOCKS, "physics.contact=off")
    plan = make_plan(Scene(case))
    assert not plan.passes and not solid_plan(plan).touching
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


def test_damping_and_friction_take_energy_and_keep_both_momenta(tmp_path):
    keys = ("physics.contact.damping=0.5", "physics.contact.friction=0.5")
    damped, ((momentum, spin, size), whole), _ = bounced(draft(tmp_path, BLOCKS, *keys))
    after, turned, _ = motion(damped)
    assert np.abs(after - momentum).max() < 1e-14 * size and np.abs(turned - spin).max() < 1e-13 * size
    assert energy(damped) < 0.97 * whole


def test_a_short_bar_that_hits_a_long_one_stays_there(tmp_path):
    simulation = start(draft(tmp_path, BARS))
    while simulation.time < 0.012:
        simulation.step()
    v, group = simulation.store.shown("velocity")[:, 0], simulation.store.shown("group")
    assert simulation.store.shown("contact_energy").max() == 0.0  # they have parted
    assert v[group == 0].mean() == pytest.approx(0.0, abs=0.025)
    assert v[group == 1].mean() == pytest.approx(0.25, abs=0.0125)


def test_the_limit_of_the_step_keeps_energy_and_half_more_does_not(tmp_path):
    """Where a step ends within a touch, energy is wrong by a part of (ωΔt)²; at ωΔt = 2 it grows for ever."""
    stiff = BARS, "physics.contact.stiffness=4.0"
    longest, name = start(draft(tmp_path, *stiff)).plan.longest_step(0.0, 0.0)
    assert name == "solid contact"

    def off(times):
        return wrong(start(draft(tmp_path, *stiff, f"time.step={times * longest}")), 0.012)

    assert off(1.0) < 2e-3 < 3e-3 < off(1.5) and off(2.0 / (STEP * math.sqrt(2.0))) > 0.1


SEAM = BARS.replace(
    "spacing = 0.005", 'spacing = 0.005, periodic = ["y"], lower = [-0.2, 0.0], upper = [0.3, 0.02]'
).replace(
    "shape.box = { lower = [-0.101, 0.0], upper = [-0.001, 0.02] }",
    "shape.difference.from.box = { lower = [-0.101, 0.0], upper = [-0.001, 0.02] }\n"
    "shape.difference.minus = [{ box = { lower = [-0.07, 0.0], upper = [-0.05, 0.02] } }]",
)


def test_plates_that_repeat_have_no_edge_at_the_seam(tmp_path):
    """Else their faces part there under a strong pressure, and pass through each other."""
    store = start(draft(tmp_path, SEAM)).store
    x, face = store.shown("reference")[:, 0], store.shown("face")
    inner = np.minimum(np.abs(x + 0.001), np.abs(x)) < 0.01
    assert inner.sum() == 16 and np.abs(face[inner, 0]).min() == 1.0
    assert np.abs(face[:, 1]).max() < 1e-12


CUBES = """
[space]
dimensions = 3
spacing = {spacing}
[time]
end = 1.0
[physics]
contact = {{}}
[solids.left]
shape.box = {{ lower = [-0.101, 0.0, 0.0], upper = [-0.001, 0.1, 0.1] }}
density = 7850.0
young = 2.0e11
poisson = 0.3
law = "neo-hookean"
velocity = [585.0, 0.0, 0.0]
[solids.right]
shape.box = {{ lower = [0.001, 0.0, 0.0], upper = [0.101, 0.1, 0.1] }}
density = 7850.0
young = 2.0e11
poisson = 0.3
law = "neo-hookean"
velocity = [-585.0, 0.0, 0.0]
"""
"""Cubes of steel at ±0.1 of the speed of its waves."""


@LONG
def test_cubes_of_steel_bounce_alike_at_every_spacing(tmp_path):
    """With 10 and 16 particles an edge they part at 0.757 and 0.743 of their speed, the rest in swings.

    At half the longest step, since at that itself the energy swings by 0.9 %, and by a quarter at its half.
    """
    speeds = []
    for count in (4, 6):
        case = CUBES.format(spacing=0.1 / count)
        longest, _ = start(draft(tmp_path, case)).plan.longest_step(0.0, 0.0)
        simulation = start(draft(tmp_path, case, f"time.step={0.5 * longest}"))
        whole = energy(simulation)
        while simulation.time < 8e-5:
            simulation.step()
        v, group = simulation.store.shown("velocity")[:, 0], simulation.store.shown("group")
        assert simulation.store.shown("contact_energy").max() == 0.0  # they have parted
        assert v[group == 0].mean() == pytest.approx(-v[group == 1].mean(), rel=1e-9)
        assert energy(simulation) == pytest.approx(whole, rel=3e-3)
        speeds.append(v[group == 1].mean() / 585.0)
    assert speeds[0] == pytest.approx(speeds[1], rel=0.03)
    assert speeds == pytest.approx([0.75, 0.75], rel=0.06)


ON_WALL = """
[walls.floor]
shape.polygon.points = {floor}
[solids.block]
shape.polygon.points = {block}
density = 1000.0
young = 2.0e5
poisson = 0.3
"""


def on_wall(folder, degrees, friction, gap=0.0, damping=0.0):
    """A simulation of a block a ``gap`` in m above a slope; unit vectors down and out of the slope."""
    floor, block = box(degrees, -0.1, -0.07, 0.7, 0.0), box(degrees, 0.0, gap, 0.2, 0.1 + gap)
    tables = ON_WALL.format(floor=floor, block=block)
    return on_slope(folder, degrees, friction, tables, f"solids.block.damping={damping}")


def middle(simulation, name="position"):
    """Of the block, m; or its mean velocity, m/s."""
    return simulation.store.shown(name)[simulation.store.shown("group") == 0].mean(axis=0)


@pytest.mark.parametrize(("degrees", "friction"), [(25.0, 0.0), (38.0, 0.3)])
def test_a_block_slides_down_a_drawn_slope(tmp_path, degrees, friction):
    """Whatever its angle to the lattice: the faces are plane, and the lattice makes no steps of them."""
    simulation, down, up = on_wall(tmp_path, degrees, friction)
    begun = middle(simulation)
    while simulation.time < 0.2:
        simulation.step()
    way = middle(simulation) - begun
    pull = 9.81 * (math.sin(math.radians(degrees)) - friction * math.cos(math.radians(degrees)))
    assert way @ down == pytest.approx(0.5 * pull * simulation.time**2, rel=0.03)
    assert abs(way @ up) < 0.1 * 0.02


@pytest.mark.parametrize("gap", [0.0, 0.01])
def test_a_block_below_its_angle_of_friction_comes_to_rest(tmp_path, gap):
    """Sticking, drawn touching or above: by friction in proportion to the speed it crept for ever."""
    simulation, down, _ = on_wall(tmp_path, 25.0, 0.6, gap, damping=500.0)
    while simulation.time < 0.5:
        simulation.step()
    begun = middle(simulation)
    while simulation.time < 0.6:
        simulation.step()
    free = 0.5 * 9.81 * math.sin(math.radians(25.0)) * 0.1**2
    assert abs((middle(simulation) - begun) @ down) < 1e-3 * free
    assert np.linalg.norm(middle(simulation, "velocity")) < 1e-4
