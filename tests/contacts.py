"""Scenes in which elastic solids, bodies and walls meet, and what is measured of them."""

import math

import numpy as np
from drafts import draft
from gauging import start

BLOCKS = """
space = { dimensions = 2, spacing = 0.1 }
time.end = 1.0
physics.contact = {}
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

BARS = """
space = { dimensions = 2, spacing = 0.005 }
time.end = 1.0
physics.contact = {}
[solids.short]
shape.box = { lower = [-0.101, 0.0], upper = [-0.001, 0.02] }
velocity = [0.5, 0.0]
density = 1000.0
young = 1.0e6
poisson = 0.0
[solids.long]
shape.box = { lower = [0.0, 0.0], upper = [0.2, 0.02] }
density = 1000.0
young = 1.0e6
poisson = 0.0
"""
"""A short bar hits one twice as long at rest (Saint-Venant 1867)."""

HAMMER = """
space = { dimensions = 2, spacing = 0.005 }
time.end = 1.0
physics.contact = {}
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

PUDDLE = (
    "fluids.puddle={shape={box={lower=[0.6,0.0],upper=[0.65,0.05]}},density=700.0}",
    "physics.sound_speed=20.0",
)
"""Water out of the way of hammers and bars."""

SLOPE = """
[space]
dimensions = 2
spacing = 0.02
[time]
end = 1.0
[physics]
gravity = [0.0, -9.81]
contact = {{ friction = {friction}, damping = 0.3 }}
"""


def drawn(degrees, corners):
    """Corners along and out of a slope, in space, m."""
    a = math.radians(degrees)
    turn = np.array([[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]])
    return np.round(np.array(corners) @ turn, 9).tolist()


def box(degrees, left, low, right, up):
    """The corners of a box on a slope."""
    return drawn(degrees, [(left, low), (right, low), (right, up), (left, up)])


def on_slope(folder, degrees, friction, tables, *sets):
    """A simulation of what some ``tables`` draw on a slope, and the unit vectors down and out of it."""
    simulation = start(draft(folder, SLOPE.format(friction=friction) + tables, *sets))
    return simulation, *np.array(drawn(degrees, [(1.0, 0.0), (0.0, 1.0)]))


def bodies_of(simulation):
    """The state of the rigid bodies."""
    return simulation.engine.of("bodies").bodies


def masses(simulation):
    """True masses of the particles of solids, kg, 0 of all others."""
    store = simulation.store
    return store.shown("inertia" if "inertia" in store else "mass") * (store.shown("kind") == 2)


def motion(simulation):
    """Momentum, kg m/s, and angular momentum, kg m²/s, of solids and bodies (3,), and Σ m|v|."""
    store, m = simulation.store, masses(simulation)[:, None]
    v, x = (np.pad(store.shown(n), ((0, 0), (0, 3 - store.dimensions))) for n in ("velocity", "position"))
    momentum, spin, size = (
        (m * v).sum(axis=0),
        np.cross(x, m * v).sum(axis=0),
        np.linalg.norm(m * v, axis=1).sum(),
    )
    if simulation.plan.of("bodies"):
        bodies = bodies_of(simulation)
        own = bodies.mass * bodies.velocity
        momentum, size = momentum + own.sum(axis=0), size + np.linalg.norm(own, axis=1).sum()
        spin = spin + (bodies.angular_momentum + np.cross(bodies.place, own)).sum(axis=0)
    return momentum, spin, size


def energy_of_solids(simulation):
    """Of their motion and what they and contacts store, J."""
    speed2 = (simulation.store.shown("velocity") ** 2).sum(axis=1)
    return 0.5 * (masses(simulation) * speed2).sum() + simulation.engine.stored_energy()


def energy(simulation):
    """The same with that of bodies, J."""
    whole = energy_of_solids(simulation)
    return whole + (bodies_of(simulation).kinetic_energy().sum() if simulation.plan.of("bodies") else 0.0)


def until(simulation, time):
    """The simulation at ``time``, s."""
    while simulation.time < time:
        simulation.step(time)
    return simulation


def wrong(simulation, end):
    """The largest error of the energy on the way to ``end``, s, over it."""
    whole, most = energy(simulation), 0.0
    while simulation.time < end:
        simulation.step()
        most = max(most, abs(energy(simulation) / whole - 1.0))
    return most


def hardest(simulation, end):
    """The largest energy of contacts on the way to ``end``, s, in J."""
    most = 0.0
    while simulation.time < end:
        simulation.step()
        most = max(most, simulation.store.shown("contact_energy").sum())
    return most
