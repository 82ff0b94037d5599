"""Elastic parts of rigid bodies: momenta of all together, a bar behind a mass against theory, what a clamp bears."""

import numpy as np
import pytest
from drafts import draft, refusal
from gauging import start, started
from runs.test_moving_guards import watched

from psph.output.gauges import gauges_of
from psph.physics.rigid.pose import ACCELERATION

FIN = """
time.end = 1.0
space = { dimensions = 2, spacing = 0.01 }
[bodies.hull]
shape.box = { lower = [0.0, 0.0], upper = [0.2, 0.1] }
density = 800.0
velocity = [0.3, 0.1]
spin = 2.0
[solids.fin]
shape.box = { lower = [0.1, 0.03], upper = [0.4, 0.07] }
density = 1200.0
young = 1.0e6
poisson = 0.3
velocity = [0.3, 0.1]
[solids.fin.clamps.root]
shape.box = { lower = [0.1, 0.03], upper = [0.2, 0.07] }
body = "hull"
[gauges.root.reaction]
of = ["solids.fin.clamps.root"]
about = [0.2, 0.0]
"""
"""A hull that spins, and a fin whose root is in it, which does not spin at first."""

IN_3D = (
    "space.dimensions=3",
    "space.spacing=0.02",
    "bodies.hull.shape.box={lower=[0.0,0.0,0.0],upper=[0.2,0.1,0.12]}",
    "bodies.hull.velocity=[0.3,0.1,-0.2]",
    "bodies.hull.spin=[1.0,0.5,2.0]",
    "solids.fin.shape.box={lower=[0.1,0.02,0.02],upper=[0.4,0.1,0.1]}",
    "solids.fin.velocity=[0.3,0.1,0.0]",
    "solids.fin.clamps.root.shape.box={lower=[0.1,0.02,0.02],upper=[0.2,0.1,0.1]}",
    "gauges=off",
)


def free(simulation):
    """True masses, places and velocities (n, 3) of the particles that forces move one by one."""
    store, species = simulation.store, simulation.plan.materials.species
    moves = [
        n for n, one in enumerate(species) if type(one.motion).__name__ in ("Free", "Elastic", "Immersed")
    ]
    own = np.isin(store.shown("group"), moves)
    mass = store.shown("inertia" if "inertia" in store else "mass")[own]
    return mass, *(
        np.pad(store.shown(n)[own], ((0, 0), (0, 3 - store.dimensions))) for n in ("position", "velocity")
    )


def momenta(simulation):
    """Momentum and angular momentum about the origin of bodies, solids and fluid, (6,)."""
    bodies, (mass, x, v) = simulation.engine.of("bodies").bodies, free(simulation)
    own = bodies.ahead + np.cross(bodies.spin_ahead, bodies.arm)
    momentum = mass @ v + (bodies.mass * own).sum(axis=0)
    turning = mass @ np.cross(x, v) + (bodies.mass * np.cross(bodies.centre, own)).sum(axis=0)
    return np.concatenate([momentum, turning + bodies.angular_momentum.sum(axis=0)])


@pytest.mark.parametrize("keys", ((), IN_3D), ids=("2D", "3D"))
def test_a_hull_and_its_fin_keep_their_momenta(tmp_path, keys):
    simulation = start(draft(tmp_path, FIN, *keys))
    before = momenta(simulation)
    for _ in range(200):
        simulation.step()
    assert momenta(simulation) == pytest.approx(before, abs=1e-12)
    assert simulation.engine.stored_energy() > 0.01
    assert np.abs(simulation.engine.of("bodies").bodies.spin_ahead).max() < 1.95  # the fin has slowed it down


def test_the_guard_of_the_energy_knows_what_the_hull_gives(tmp_path):
    """A force on the tip, which moves the hull too: the fin stores and loses what both give."""
    load = "loads.tip={shape={box={lower=[0.38,0.0],upper=[0.4,0.1]}},force=[0.0,20.0]}\nload_rise=0.05\n"
    text = FIN.replace("spin = 2.0", "").replace("[solids.fin.clamps", load + "[solids.fin.clamps")
    simulation, guards = watched(tmp_path, text)
    gains, hull = [], simulation.engine.of("bodies").bodies
    before = hull.kinetic_energy()[0]
    for _ in range(500):
        simulation.step()
        gains.append(guards._gain() * guards._unit)
    assert abs(hull.kinetic_energy()[0] - before) > 0.05 and simulation.engine.stored_energy() > 0.002
    assert np.abs(gains).max() < 5e-3 * abs(hull.kinetic_energy()[0] - before)


def test_in_water_that_slips_and_sticks_their_momentum_is_kept(tmp_path):
    water = (
        "space={dimensions=2,spacing=0.02,periodic=['x','y'],lower=[-0.4,-0.4],upper=[0.8,0.6]}",
        "physics.sound_speed=20.0",
        "fluids.water={viscosity=0.01,shape={difference={from={box={lower=[-0.4,-0.4],upper=[0.8,0.6]}},"
        "minus=[{box={lower=[0.1,0.02],upper=[0.4,0.08]}}]}}}",
        "bodies.hull.no_slip=true",
        "solids.fin.shape.box={lower=[0.1,0.02],upper=[0.4,0.08]}",
        "solids.fin.clamps.root.shape.box={lower=[0.1,0.02],upper=[0.2,0.08]}",
        "gauges=off",
    )
    simulation = start(draft(tmp_path, FIN, *water))
    before = momenta(simulation)[:2]
    for _ in range(60):
        simulation.step()
    after = momenta(simulation)[:2]
    hull = simulation.engine.of("bodies").bodies
    assert after == pytest.approx(before, abs=1e-11) and hull.ahead[0, 0] < 0.25


BAR = """
time.end = 10.0
space = { dimensions = 2, spacing = 0.0125 }
[bodies.block]
shape.box = { lower = [0.0, 0.0], upper = [0.2, 0.1] }
density = 2000.0
[solids.bar]
shape.box = { lower = [0.1, 0.0], upper = [1.2, 0.1] }
density = 1000.0
young = 1.0e6
poisson = 0.0
clamps.root = { shape.box = { lower = [0.1, 0.0], upper = [0.2, 0.1] }, body = "block" }
"""


def test_a_bar_behind_a_mass_swings_along_as_theory_has_it(tmp_path):
    """tan kL = −(M/m) kL, ω = k √(E/ρ), the mode cos k(L − x) of the bar and cos kL of the mass M."""
    simulation = start(draft(tmp_path, BAR))
    bodies, store, length = simulation.engine.of("bodies").bodies, simulation.store, 1.0
    ratio = bodies.mass[0, 0] / (1000.0 * 0.1 * length)
    low, high = 0.5 * np.pi + 1e-9, np.pi
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if np.tan(middle) + ratio * middle < 0.0 else (low, middle)
    x = store.shown("reference")[:, 0]
    for name in ("velocity", "predicted_velocity"):
        store[name][0][store.inner] = 0.01 * np.cos(low * (1.2 - np.maximum(x, 0.2)) / length)
    bodies.velocity[0, 0] = bodies.ahead[0, 0] = 0.01 * np.cos(low)
    told = []
    while simulation.time < 0.8 * 2.0 * np.pi / (low * np.sqrt(1000.0)):
        simulation.step()
        told.append((simulation.time, bodies.ahead[0, 0]))
    time, speed = np.transpose(told)
    (turns,) = np.nonzero(speed[1:] * speed[:-1] < 0.0)
    zeros = [time[n] - speed[n] * (time[n + 1] - time[n]) / (speed[n + 1] - speed[n]) for n in turns]
    assert 2.0 * (zeros[1] - zeros[0]) == pytest.approx(2.0 * np.pi / (low * np.sqrt(1000.0)), rel=0.02)


def test_the_reaction_of_the_clamp_is_what_the_hull_gets(tmp_path):
    """R = M(A − g) − m(A_r − g) with M of all that is rigid, m of the root of it, and A_r of the root's middle."""
    simulation, scene = started(draft(tmp_path, FIN, "physics.gravity=[0.0,-9.81]"), 20)
    [gauge] = (one for one in gauges_of(scene).values() if one.name == "root")
    bodies, root = simulation.engine.of("bodies").bodies, 1200.0 * 0.1 * 0.04
    place = simulation.engine.poses.maps[0, ACCELERATION]
    of_root = place[:, 0] + place[:, 1:] @ [0.15, 0.05]
    gravity = np.array([0.0, -9.81])
    expected = bodies.mass[0, 0] * (bodies.acceleration[0, :2] - gravity) - root * (of_root - gravity)
    assert (
        np.array(gauge.row(simulation))[:2] == pytest.approx(expected, rel=1e-9)
        and np.abs(expected).max() > 1.0
    )


@pytest.mark.parametrize(
    ("keys", "says"),
    (
        (["solids.fin.clamps.root.body=keel"], "no rigid body has this name"),
        (
            ["solids.fin.clamps.root.motion={translation=[0.1,0.0]}"],
            "goes as its body does; remove it, or motion",
        ),
        (
            ["bodies.other={shape={box={lower=[1.0,0.0],upper=[1.2,0.2]}}}"],
            "solids do not feel bodies without contact",
        ),
    ),
)
def test_what_is_refused(tmp_path, keys, says):
    assert any(says in line for line in refusal(tmp_path, FIN, *keys))
