"""Rigid bodies, and walls that move, touch elastic solids: what is kept, and how they bounce, rest and slide."""

import math

import numpy as np
import pytest
from contacts import (
    ASKEW,
    HAMMER,
    bodies_of,
    box,
    drawn,
    energy,
    energy_of_solids,
    hardest,
    motion,
    on_slope,
    until,
    wrong,
)
from drafts import draft, refusal
from gauging import start
from long import LONG

from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.solid_plan import solid_plan


def test_a_hammer_and_a_bar_part_as_waves_have_it(tmp_path):
    """While waves run to the far end and back, 2L/c, a push of ρcA v slows the body: v falls to e^(−2m/M), and
    what it has lost has the bar (Saint-Venant)."""
    simulation = start(draft(tmp_path, HAMMER))
    (momentum, spin, size), whole = motion(simulation), energy(simulation)
    until(simulation, 0.0125)
    store, own = simulation.store, simulation.store.shown("kind") == 2
    assert store.shown("contact_energy").max() == 0.0  # they have parted
    kept = math.exp(-2.0)
    assert bodies_of(simulation).velocity[0, 0] == pytest.approx(0.5 * kept, abs=0.0125)
    assert store.shown("velocity")[own, 0].mean() == pytest.approx(0.5 * (1.0 - kept), abs=0.0125)
    after, turned, _ = motion(simulation)
    assert np.abs(after - momentum).max() < 1e-14 * size and np.abs(turned - spin).max() < 1e-15 * size
    assert energy(simulation) == pytest.approx(whole, rel=2e-3)


@LONG
def test_what_is_left_of_the_speed_of_a_hammer_converges(tmp_path):
    """The front of the wave, spread by the lattice, comes back early: by that the body keeps too much.

    A chain of masses and springs, as many as particles along the bar, does so too: 1.2, 0.9, 0.6 % for 20, 40,
    80 of them, where psph has 2.3, 1.7, 0.8 %.
    """
    kept = math.exp(-2.0)
    simulations = (start(draft(tmp_path, HAMMER, f"space.spacing={dx}")) for dx in (0.005, 0.00125))
    coarse, fine = (bodies_of(until(one, 0.0125)).velocity[0, 0] / 0.5 - kept for one in simulations)
    assert 0.0 < fine < 0.01 and 2.0 * fine < coarse < 0.025


def test_a_body_that_turns_and_hits_a_corner_keeps_both_momenta_and_energy(tmp_path):
    simulation = start(draft(tmp_path, HAMMER, *ASKEW))
    (momentum, spin, size), whole = motion(simulation), energy(simulation)
    before, most = bodies_of(simulation).spin[0, 2], hardest(simulation, 0.02)
    after, turned, _ = motion(simulation)
    assert most > 0.02 * whole and abs(bodies_of(simulation).spin[0, 2] - before) > 3.0  # it was hit
    assert np.abs(after - momentum).max() < 1e-14 * size and np.abs(turned - spin).max() < 1e-15 * size
    assert energy(simulation) == pytest.approx(whole, rel=4e-3)
    given = simulation.store.shown("work").sum()
    assert energy_of_solids(simulation) == pytest.approx(given, rel=4e-3) and given > 0.1 * whole


def test_the_step_is_short_enough_for_a_body_that_is_lighter_than_what_it_hits(tmp_path):
    """And half more is not, nor is a step that knows nothing of the body."""
    light = HAMMER, "bodies.hammer.density=30.0"
    heavy, _ = start(draft(tmp_path, HAMMER)).plan.longest_step(0.0, 0.0)
    longest, name = start(draft(tmp_path, *light)).plan.longest_step(0.0, 0.0)
    assert name == "solid contact" and longest < 0.4 * heavy

    def off(step):
        return wrong(start(draft(tmp_path, *light, f"time.step={step}")), 0.004)

    assert off(longest) < 0.01 < 0.025 < off(1.5 * longest) and off(heavy) > 0.08


PISTON = (
    "walls.piston={shape={box={lower=[-0.02,-0.01],upper=[0.0,0.03]}},"
    "motion={sinusoid={amplitude=[0.002,0.0],frequency=20.0}}}",
    "bodies.hammer.shape={box={lower=[0.1,0.0],upper=[0.15,0.02]}}",
    "bodies.hammer.velocity=[0.0,0.0]",
)
"""A wall that moves pushes the bar, and the bar the body at its far end."""


def test_the_work_of_a_wall_that_moves_is_the_energy_of_what_it_pushes(tmp_path):
    simulation = until(start(draft(tmp_path, HAMMER, *PISTON)), 0.025)
    store = simulation.store
    of_wall = store.shown("work")[store.shown("group") == 1].sum()
    assert of_wall > 1e-3 and energy(simulation) == pytest.approx(of_wall, rel=5e-3)
    assert bodies_of(simulation).velocity[0, 0] > 0.1


SPINS = (
    "bodies.hammer.shape={disc={center=[-0.031,0.004],radius=0.03}}",
    "bodies.hammer.spin=300.0",
    "solids.bar.clamped={box={lower=[0.09,0.0],upper=[0.1,0.02]}}",
)
"""A disc that spins fast hits the bar below its middle, so that the edge of the bar's face cuts its contact."""

GRINDS = (
    "bodies=off",
    "walls.roller={shape={disc={center=[-0.031,0.004],radius=0.03}},motion=["
    "{rotation={speed=300.0,center=[-0.031,0.004]}},{sinusoid={amplitude=[0.003,0.0],frequency=25.0}}]}",
)
"""So does a wall, as it is told."""


@pytest.mark.parametrize(
    ("turns", "part", "alike"), [((), 0.1, 8e-3), (GRINDS, 0.5, 0.015)], ids=["body", "wall"]
)
def test_the_work_by_normals_that_turn_is_in_the_books(tmp_path, turns, part, alike):
    """The energy of contacts depends on the normals N too: T·Ṅ, T = −∂U/∂N, is a part of what a body or a wall
    gives, here a large one."""
    simulation = start(draft(tmp_path, HAMMER, *SPINS, *turns))
    store, by_normals = simulation.store, 0.0
    while simulation.time < 0.012:
        simulation.step()
        own = store.shown("kind") == 1
        (n_x, n_y), (t_x, t_y) = (store.shown(name)[own].T for name in ("face", "turning"))
        by_normals -= 300.0 * (n_x * t_y - n_y * t_x).sum() * simulation.dt
    given, stored = store.shown("work").sum(), energy_of_solids(simulation)
    assert given == pytest.approx(stored, rel=alike) and abs(by_normals) > part * stored


def test_without_bodies_nothing_is_stored_summed_or_asked_of_the_step_for_them(tmp_path):
    plan = make_plan(Scene(draft(tmp_path, HAMMER)))
    assert (
        solid_plan(plan).pressed
        and plan.of("bodies")
        and {"load", "couple", "anchor", "work"} <= {*plan.arrays}
    )
    others = "bodies=off", "walls.end={shape={box={lower=[-0.02,-0.01],upper=[0.0,0.03]}}}"
    alone = make_plan(Scene(draft(tmp_path, HAMMER, *others)))
    assert solid_plan(alone).touching and not solid_plan(alone).pressed and alone.materials.loaded is None
    assert {"load", "couple", "anchor", "work", "is_fluid"}.isdisjoint(alone.arrays)


TUMBLING = """
space = { dimensions = 3, spacing = 0.01 }
time.end = 1.0
physics.contact = {}
[bodies.brick]
shape.box = { lower = [0.02, 0.03, 0.061], upper = [0.07, 0.07, 0.101] }
density = 700.0
velocity = [0.3, -0.2, -1.5]
spin = [8.0, -6.0, 4.0]
[solids.cushion]
shape.box = { lower = [0.0, 0.0, 0.0], upper = [0.08, 0.08, 0.06] }
density = 1000.0
young = 1.0e5
poisson = 0.3
velocity = [0.0, 0.1, 0.2]
"""
"""A brick that tumbles hits a cushion of rubber; both fly freely."""


@LONG
def test_in_three_dimensions_too_both_momenta_and_energy_are_kept(tmp_path):
    simulation = start(draft(tmp_path, TUMBLING))
    (momentum, spin, size), whole = motion(simulation), energy(simulation)
    most = hardest(simulation, 0.03)
    after, turned, _ = motion(simulation)
    assert most > 0.05 * whole and bodies_of(simulation).velocity[0, 2] > 0.0  # it bounced
    assert np.abs(after - momentum).max() < 1e-14 * size
    assert np.abs(turned - spin).max() < 1e-15 * size
    assert energy(simulation) == pytest.approx(whole, rel=5e-3)


RUBBER = """
[solids.floor]
shape.polygon.points = {floor}
clamped.polygon.points = {foot}
density = 1000.0
young = 2.0e5
poisson = 0.3
damping = 300.0
[bodies.block]
shape.{block}
density = 1000.0
"""
"""A body on a drawn slope of rubber that is clamped below."""


def on_rubber(folder, degrees, friction, shape, *sets):
    """A simulation of a body on a slope, and the unit vector down it."""
    floor, foot = box(degrees, -0.1, -0.12, 0.6, 0.0), box(degrees, -0.1, -0.12, 0.6, -0.06)
    return on_slope(folder, degrees, friction, RUBBER.format(floor=floor, foot=foot, block=shape), *sets)[:2]


def block(degrees):
    return f"polygon.points = {box(degrees, 0.0, 0.0, 0.2, 0.1)}"


def pull_down(simulation, down, times=(0.1, 0.2, 0.3)):
    """Acceleration down a slope by the ways between three times, m/s²: of what swings in between the mean."""
    ways = [bodies_of(until(simulation, time)).place[0, :2] @ down for time in times]
    return (ways[2] - 2.0 * ways[1] + ways[0]) / (times[1] - times[0]) ** 2


@pytest.mark.parametrize("degrees", [25, pytest.param(38, marks=LONG)])
def test_a_body_slides_down_a_solid_as_theory_has_it(tmp_path, degrees):
    a = math.radians(degrees)
    found = pull_down(*on_rubber(tmp_path, degrees, 0.3, block(degrees)))
    assert found == pytest.approx(9.81 * (math.sin(a) - 0.3 * math.cos(a)), rel=0.01)


def test_below_its_angle_of_friction_a_body_stays(tmp_path):
    simulation, down = on_rubber(tmp_path, 20.0, 0.5, block(20.0))
    ways = [bodies_of(until(simulation, time)).place[0, :2] @ down for time in (0.15, 0.3)]
    assert abs(ways[1] - ways[0]) < 1e-4


def test_a_disc_rolls_down_a_solid(tmp_path):
    """Friction is by the velocity of the point that touches, v + ω × r."""
    disc = f"disc = {{ center = {drawn(20.0, (0.05, 0.1))}, radius = 0.1 }}"
    simulation, down = on_rubber(tmp_path, 20.0, 0.5, disc, "solids.floor.young=1e6")
    found, bodies = pull_down(simulation, down), bodies_of(simulation)
    own = bodies.about[0] / (bodies.mass[0, 0] * 0.1**2)
    assert found == pytest.approx(9.81 * math.sin(math.radians(20.0)) / (1.0 + own), rel=0.03)
    assert -0.1 * bodies.spin[0, 2] == pytest.approx(bodies.velocity[0, :2] @ down, rel=0.05)


def test_a_body_at_rest_presses_a_solid_by_its_weight(tmp_path):
    simulation, _ = on_rubber(tmp_path, 0.0, 0.3, block(0.0))
    bodies = bodies_of(until(simulation, 0.35))
    given = np.zeros(3)
    while simulation.time < 0.4:
        simulation.step(0.4)
        given += (bodies.force[0] - bodies.weight[0]) * simulation.dt
    weight = -bodies.weight[0, 1] * 0.05
    assert given[1] == pytest.approx(weight, rel=0.01) and abs(given[0]) < 0.01 * weight
    assert np.linalg.norm(bodies.velocity[0]) < 2e-3 and abs(bodies.turned(0)[2]) < 1e-3


@pytest.mark.parametrize(
    ("keys", "says"),
    [
        (["physics.contact=off"], "bodies.hammer: solids do not feel bodies without contact; give"),
        (["anvils.floor={at=[0.0,-1.0],normal=[0.0,1.0]}"], "anvils: rigid bodies do not feel them; take a wall"),
        (["solids.hammer={shape={box={lower=[1.0,0.0],upper=[1.1,0.1]}},density=1.0,young=1.0,poisson=0.0}"],
         "bodies.hammer: a solid has this name too; give the body another"),
        (["bodies.hammer.condition=extrapolated"], "bodies.hammer.condition: says what a fluid meets, and there is"),
        (["walls.bent={shape={box={lower=[1.0,0.0],upper=[1.1,0.1]}},"
          "motion={piston={height=0.01,period=1.0,depth=0.3}}}"],
         "walls.bent.motion: a paddle makes waves, and there is no fluid; take another"),
    ],
)  # fmt: skip
def test_what_solids_and_bodies_cannot_do_is_said(tmp_path, keys, says):
    assert any(says in line for line in refusal(tmp_path, HAMMER, *keys))
