"""Self-gravity by the direct sum: known fields, orbits, equilibrium, what all matter gives to each other."""

import math

import numpy as np
import pytest
from drafts import draft, refusal
from gauging import start

from psph.kinds import kinds_in
from psph.physics.self_gravity import softened
from psph.runs.guards import Guards
from psph.runs.record import Record
from psph.scene import Scene
from psph.scene.checks import warnings

BALL = """
space = { dimensions = 3, spacing = 0.1 }
time.end = 1.0
physics.self_gravity = { constant = 1.0, softening = 0.1 }
physics.position_shift = "off"
[fluids.water]
density = 1.0
viscosity = 0.01
shape.ball = { center = [0.0, 0.0, 0.0], radius = 0.5 }
"""


def test_the_sum_is_that_over_all_pairs(tmp_path):
    store = start(draft(tmp_path, BALL, "fluids.water.jitter=0.3")).store
    x, m = store.shown("position"), store.constants["mass"]
    away = x[None] - x[:, None]
    r = np.sqrt((away**2).sum(axis=2))
    g, f = np.vectorize(lambda one: softened(one, 0.3))(r)
    np.fill_diagonal(f, 0.0)
    pull = m * (g[:, :, None] * away).sum(axis=1)
    assert store.shown("attraction") == pytest.approx(pull, abs=1e-13)
    assert store.shown("attraction_energy") == pytest.approx(-0.5 * m * f.sum(axis=1), abs=1e-13)
    assert np.abs(m * store.shown("attraction").sum(axis=0)).max() < 1e-16 * len(x)
    newton = m * (away / np.maximum(r, 0.3)[:, :, None] ** 3).sum(axis=1)
    assert np.abs(newton - pull).max() > 0.05  # the control: with another softening it is another field


def test_within_an_even_ball_the_pull_grows_with_the_distance(tmp_path):
    """a = −(4π/3) Gρ x, and outside a particle of another fluid GM/r²."""
    far = (
        "fluids.dust.density=1e-9",
        "fluids.dust.shape.box.lower=[2.0,0.0,0.0]",
        "fluids.dust.shape.box.upper=[2.1,0.1,0.1]",
    )
    store = start(draft(tmp_path, BALL, *far)).store
    x, a, water = store.shown("position"), store.shown("attraction"), store.shown("group") == 0
    inner = water & ((x**2).sum(axis=1) < 0.3**2)
    slope = (x[inner] * a[inner]).sum() / (x[inner] ** 2).sum()
    assert slope == pytest.approx(-4 * math.pi / 3, rel=0.03)
    [there], mass = np.flatnonzero(~water), store.shown("mass")[water].sum()
    assert np.linalg.norm(a[there]) == pytest.approx(mass / (x[there] ** 2).sum(), rel=1e-3)


def test_a_ball_of_fluid_bears_its_own_weight(tmp_path):
    """p = (2π/3) Gρ² (R² − r²), 7 spacings a radius: at 5 the level is 11 % high, at 10 it is 5 %."""
    told, measured = 2 * math.pi / 3, {}
    finer = (
        "space.spacing=0.0714285714",
        "physics.self_gravity.softening=0.0714",
        "fluids.water.viscosity=0.03",
    )
    alone = "physics.self_gravity.constant=1e-12", "physics.sound_speed=15.0"
    for name, changes, end in (("pulled", finer, 2.0), ("free", (*finer, *alone), 0.5)):
        simulation = start(draft(tmp_path, BALL, *changes))
        while simulation.time < end:
            simulation.step(end)
        simulation.settle_pressure()
        store = simulation.store
        radius2 = (0.75 / math.pi * store.owned * store.constants["mass"]) ** (2 / 3)
        r2 = (store.shown("position") ** 2).sum(axis=1)
        inner = r2 < 0.5 * radius2
        slope, level = np.polyfit(r2[inner], store.shown("pressure")[inner], 1)
        measured[name] = -slope / told, level / told / radius2
    assert measured["pulled"] == (pytest.approx(1.0, abs=0.15), pytest.approx(1.0, abs=0.06))
    assert abs(measured["free"][1]) < 0.01  # the control


ROCKS = """
space = { dimensions = 3, spacing = 0.1, lower = [-1.0, -1.0, -1.0], upper = [2.0, 1.0, 1.0] }
time.end = 0.5
physics.self_gravity = { constant = 1e-3, softening = 0.1 }
[solids.left]
shape.box = { lower = [0.0, 0.0, 0.0], upper = [0.3, 0.3, 0.3] }
density = 1000.0
young = 1e5
poisson = 0.3
[solids.right]
shape.box = { lower = [1.0, 0.0, 0.0], upper = [1.3, 0.3, 0.3] }
density = 1000.0
young = 1e5
poisson = 0.3
"""


def test_energy_of_a_fall_is_in_the_books(tmp_path):
    """Two elastic cubes fall towards each other: Σ mv²/2 comes from their potential, as the guard knows."""
    case = draft(tmp_path, ROCKS)
    simulation, scene = start(case), Scene(case)
    guards = Guards(scene, simulation, Record(scene, simulation, tmp_path), tmp_path, print)
    while simulation.time < 0.5:
        simulation.step(0.5)
    store = simulation.store
    won = 0.5 * store.constants["mass"] * float((store.shown("velocity") ** 2).sum())
    assert won > 4e-3
    assert abs(guards._gain() * guards._unit) < 0.02 * won  # they swing, and swings are damped


ORBIT = """
space = { dimensions = 3, spacing = 0.2, lower = [-2.0, -2.0, -1.0], upper = [2.0, 2.0, 1.0] }
time.end = 20.0
physics.self_gravity = { constant = 1.0, softening = 0.1 }
physics.sound_speed = 4.0
[fluids.dust]
density = 1e-12
shape.box = { lower = [-2.0, -2.0, -1.0], upper = [-1.4, -1.4, -0.4] }
[bodies.left]
shape.box = { lower = [-1.2, -0.2, -0.2], upper = [-0.8, 0.2, 0.2] }
mass = 1.0
velocity = [0.0, -0.5, 0.0]
[bodies.right]
shape.box = { lower = [0.8, -0.2, -0.2], upper = [1.2, 0.2, 0.2] }
mass = 1.0
velocity = [0.0, 0.5, 0.0]
"""
"""Two cubes of 1 kg at 2 m on a circle of 1 m, v² = GM/4a: a period of 4π s."""


def run(case, end):
    simulation = start(case)
    while simulation.time < end:
        simulation.step(end)
    return simulation, simulation.engine.of("bodies").bodies


def test_two_bodies_go_round_each_other(tmp_path):
    period = 4 * math.pi
    _, bodies = run(draft(tmp_path, ORBIT), period)
    late = math.atan2(-bodies.centre[0, 1], -bodies.centre[0, 0])
    assert abs(late) < 0.01 * 2 * math.pi
    assert np.hypot(*bodies.centre[:, :2].T) == pytest.approx([1.0, 1.0], abs=2e-3)
    assert np.abs(bodies.velocity.sum(axis=0)).max() < 1e-11
    apart = np.linalg.norm(bodies.centre[0] - bodies.centre[1])
    assert 0.5 * (bodies.velocity**2).sum() - 1.0 / apart == pytest.approx(-0.25, abs=1e-3)
    _, free = run(draft(tmp_path, ORBIT, "physics.self_gravity=off"), 1.0)
    assert free.centre[1, 1] == pytest.approx(0.5)  # the control: straight on


THREE = """
space = { dimensions = 3, spacing = 0.1, lower = [-2.0, -2.0, -2.0], upper = [2.0, 2.0, 2.0] }
time.end = 2.0
physics.self_gravity = { constant = 1e-3, softening = 0.1 }
physics.sound_speed = 20.0
physics.contact = {}
[fluids.water]
density = 1000.0
shape.ball = { center = [0.0, 0.0, 0.0], radius = 0.25 }
[bodies.moon]
shape.box = { lower = [0.8, -0.1, -0.1], upper = [1.1, 0.2, 0.2] }
density = 3000.0
velocity = [0.0, 0.5, 0.0]
[solids.rock]
shape.box = { lower = [-1.1, -0.2, -0.2], upper = [-0.8, 0.1, 0.1] }
density = 2000.0
young = 1e6
poisson = 0.3
velocity = [0.0, 0.0, 0.3]
[walls.pole]
shape.box = { lower = [-0.2, -0.2, 1.5], upper = [0.2, 0.2, 1.9] }
"""


def momenta(simulation) -> np.ndarray:
    """Of fluid, solid and body, kg m/s (3, 3)."""
    store, bodies = simulation.store, simulation.engine.of("bodies").bodies
    groups, mass, v = store.shown("group"), store.shown("inertia"), store.shown("velocity")
    names = [one.name for one in simulation.plan.materials.species]
    own = [groups == names.index(name) for name in ("water", "rock")]
    found = [(mass[one, None] * v[one]).sum(axis=0) for one in own]
    return np.array([*found, bodies.bodies[0].mass * bodies.velocity[0]])


def test_fluid_solid_and_body_give_each_other_the_same(tmp_path):
    simulation = start(draft(tmp_path, THREE))
    before = momenta(simulation)
    while simulation.time < 0.1:
        simulation.step(0.1)
    given = momenta(simulation) - before
    assert np.abs(given[:, 0]).min() > 0.01  # each is pulled
    assert np.abs(given.sum(axis=0)).max() < 1e-12 * np.abs(before).max()
    names = [one.name for one in simulation.plan.materials.species]
    pole = simulation.store.shown("group") == names.index("pole")
    assert not simulation.store.shown("attraction")[pole].any()  # walls neither pull nor are pulled


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        (("space.dimensions=2",), "needs three dimensions"),
        (("space.periodic=['x']",), "images of a period"),
        (
            ("space.symmetry=['x.lower']", "space.lower=[0.0,-1.0,-1.0]", "space.upper=[1.0,1.0,1.0]"),
            "mass beyond this plane",
        ),
    ],
)
def test_what_it_does_not_know_is_refused_in_a_line(tmp_path, changes, says):
    found = [line for line in refusal(tmp_path, BALL, *changes) if says in line]
    assert found and len(found) == len(set(found))


def told(case) -> str:
    """What the run says of the sum."""
    scene = Scene(case)
    [kind] = [one for one in kinds_in(scene) if one.name == "attraction"]
    return " ".join(line for _, line in kind.lines(None, 0.0))


def test_many_particles_have_a_tree_or_are_warned_of_with_the_cost(tmp_path):
    many = "fluids.water.shape.ball.radius=1.75"
    assert "by a tree" in told(draft(tmp_path, BALL, many))
    assert "by the direct sum" in told(draft(tmp_path, BALL))
    assert not [one for one in warnings(Scene(draft(tmp_path, BALL, many))) if "self_gravity" in one]
    case = draft(tmp_path, BALL, many, "physics.self_gravity.method=direct")
    [line] = [one for one in warnings(Scene(case)) if "self_gravity" in one]
    assert "about 1.2 s on one core" in line and 'take "tree"' in line and "by the direct sum" in told(case)
