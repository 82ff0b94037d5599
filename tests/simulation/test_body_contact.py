"""Rigid bodies, and walls that move, touch elastic solids: what is kept, and how they bounce, rest and slide."""

import math

import numpy as np
import pytest
from drafts import draft, refusal
from long import LONG
from simulation.test_immersion import start

from psph.scene import Scene
from psph.simulation.plan import make_plan

HAMMER = """
[space]
dimensions = 2
spacing = 0.005
[time]
end = 1.0
[physics]
contact = {}
[bodies.hammer]
shape.box = { lower = [-0.051, 0.0], upper = [-0.001, 0.02] }
density = 2000.0
velocity = [0.5, 0.0]
[solids.bar]
shape.box = { lower = [0.0, 0.0], upper = [0.1, 0.02] }
density = 1000.0
young = 1.0e6
poisson = 0.0
"""
"""A rigid hammer as heavy as the elastic bar whose end it hits."""

ASKEW = (
    "bodies.hammer.shape={polygon={points=[[-0.051,0.004],[-0.001,0.009],[-0.004,0.039],[-0.054,0.034]]}}",
    "bodies.hammer.spin=9.0",
    "bodies.hammer.velocity=[0.9,-0.3]",
    "bodies.hammer.density=700.0",
)
"""It turns, and hits a corner of the bar with one of its own."""


def bodies_of(simulation):
    return simulation.engine.poses.floating.bodies


def motion(simulation):
    """Momentum, kg m/s, and angular momentum, kg m²/s, of solids and bodies (3,), and Σ m|v|."""
    store, bodies = simulation.store, bodies_of(simulation)
    own = store.shown("kind") == 2
    m, v, x = (store.shown(name)[own] for name in ("mass", "velocity", "position"))
    v, x = (np.pad(of, ((0, 0), (0, 3 - store.dimensions))) for of in (v, x))
    solid, rigid = m[:, None] * v, bodies.mass * bodies.velocity
    spin = np.cross(x, solid).sum(axis=0) + (bodies.angular_momentum + np.cross(bodies.place, rigid)).sum(
        axis=0
    )
    size = sum(np.linalg.norm(of, axis=1).sum() for of in (solid, rigid))
    return solid.sum(axis=0) + rigid.sum(axis=0), spin, size


def energy_of_solids(simulation):
    store = simulation.store
    own = store.shown("kind") == 2
    kinetic = 0.5 * (store.shown("mass")[own] * (store.shown("velocity")[own] ** 2).sum(axis=1)).sum()
    return kinetic + simulation.engine.stored_energy()


def energy(simulation):
    return energy_of_solids(simulation) + bodies_of(simulation).kinetic_energy().sum()


def until(simulation, time):
    while simulation.time < time:
        simulation.step(time)
    return simulation


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


def test_a_body_that_turns_and_hits_a_corner_keeps_both_momenta_and_energy(tmp_path):
    simulation = start(draft(tmp_path, HAMMER, *ASKEW))
    (momentum, spin, size), whole, most = motion(simulation), energy(simulation), 0.0
    before = bodies_of(simulation).spin[0, 2]
    while simulation.time < 0.02:
        simulation.step()
        most = max(most, simulation.store.shown("contact_energy").sum())
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

    def wrong(step):
        simulation = start(draft(tmp_path, *light, f"time.step={step}"))
        whole, most = energy(simulation), 0.0
        while simulation.time < 0.004:
            simulation.step()
            most = max(most, abs(energy(simulation) / whole - 1.0))
        return most

    assert wrong(longest) < 0.01 < 0.025 < wrong(1.5 * longest) and wrong(heavy) > 0.08


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
    assert plan.pressed and plan.floats and {"load", "couple", "anchor", "work"} <= {*plan.arrays}
    others = "bodies=off", "walls.end={shape={box={lower=[-0.02,-0.01],upper=[0.0,0.03]}}}"
    alone = make_plan(Scene(draft(tmp_path, HAMMER, *others)))
    assert alone.touching and not alone.pressed and alone.loaded is None
    assert {"load", "couple", "anchor", "work", "is_fluid"}.isdisjoint(alone.arrays)


TUMBLING = """
[space]
dimensions = 3
spacing = 0.01
[time]
end = 1.0
[physics]
contact = {}
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
    (momentum, spin, size), whole, most = motion(simulation), energy(simulation), 0.0
    while simulation.time < 0.03:
        simulation.step()
        most = max(most, simulation.store.shown("contact_energy").sum())
    after, turned, _ = motion(simulation)
    assert most > 0.05 * whole and bodies_of(simulation).velocity[0, 2] > 0.0  # it bounced
    assert np.abs(after - momentum).max() < 1e-14 * size
    assert np.abs(turned - spin).max() < 1e-15 * size
    assert energy(simulation) == pytest.approx(whole, rel=5e-3)


SLOPE = """
[space]
dimensions = 2
spacing = 0.02
[time]
end = 1.0
[physics]
gravity = [0.0, -9.81]
contact = {{ friction = {friction}, damping = 0.3 }}
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


def drawn(degrees, corners):
    """Corners along and out of a slope, in space, m."""
    a = math.radians(degrees)
    turn = np.array([[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]])
    return np.round(np.array(corners) @ turn, 9).tolist()


def box(degrees, left, low, right, up):
    return drawn(degrees, [(left, low), (right, low), (right, up), (left, up)])


def on_slope(folder, degrees, friction, shape, *sets):
    """A simulation of a body on a slope, and the unit vector down it."""
    floor, foot = box(degrees, -0.1, -0.12, 0.6, 0.0), box(degrees, -0.1, -0.12, 0.6, -0.06)
    text = SLOPE.format(friction=friction, floor=floor, foot=foot, block=shape)
    return start(draft(folder, text, *sets)), np.array(drawn(degrees, (1.0, 0.0)))


def block(degrees):
    return f"polygon.points = {box(degrees, 0.0, 0.0, 0.2, 0.1)}"


def pull_down(simulation, down, times=(0.1, 0.2, 0.3)):
    """Acceleration down a slope by the ways between three times, m/s²: of what swings in between the mean."""
    ways = [bodies_of(until(simulation, time)).place[0, :2] @ down for time in times]
    return (ways[2] - 2.0 * ways[1] + ways[0]) / (times[1] - times[0]) ** 2


@pytest.mark.parametrize("degrees", [25, pytest.param(38, marks=LONG)])
def test_a_body_slides_down_a_solid_as_theory_has_it(tmp_path, degrees):
    a = math.radians(degrees)
    found = pull_down(*on_slope(tmp_path, degrees, 0.3, block(degrees)))
    assert found == pytest.approx(9.81 * (math.sin(a) - 0.3 * math.cos(a)), rel=0.01)


def test_below_its_angle_of_friction_a_body_stays(tmp_path):
    simulation, down = on_slope(tmp_path, 20.0, 0.5, block(20.0))
    ways = [bodies_of(until(simulation, time)).place[0, :2] @ down for time in (0.15, 0.3)]
    assert abs(ways[1] - ways[0]) < 1e-4


def test_a_disc_rolls_down_a_solid(tmp_path):
    """Friction is by the velocity of the point that touches, v + ω × r."""
    disc = f"disc = {{ center = {drawn(20.0, (0.05, 0.1))}, radius = 0.1 }}"
    simulation, down = on_slope(tmp_path, 20.0, 0.5, disc, "solids.floor.young=1e6")
    found, bodies = pull_down(simulation, down), bodies_of(simulation)
    own = bodies.about[0] / (bodies.mass[0, 0] * 0.1**2)
    assert found == pytest.approx(9.81 * math.sin(math.radians(20.0)) / (1.0 + own), rel=0.03)
    assert -0.1 * bodies.spin[0, 2] == pytest.approx(bodies.velocity[0, :2] @ down, rel=0.05)


def test_a_body_at_rest_presses_a_solid_by_its_weight(tmp_path):
    simulation, _ = on_slope(tmp_path, 0.0, 0.3, block(0.0))
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
        (["fluids.water={shape={box={lower=[1.0,0.0],upper=[1.1,0.1]}}}"],
         "bodies: in a fluid nothing is known of contact between solids and these; remove one of the three"),
        (["walls.bent={shape={box={lower=[1.0,0.0],upper=[1.1,0.1]}},"
          "motion={piston={height=0.01,period=1.0,depth=0.3}}}"],
         "walls.bent.motion: a paddle makes waves, and there is no fluid; take another"),
    ],
)  # fmt: skip
def test_what_solids_and_bodies_cannot_do_is_said(tmp_path, keys, says):
    assert any(says in line for line in refusal(tmp_path, HAMMER, *keys))
