"""What body forces pull, and how the energy that they give is known."""

from typing import NamedTuple

import numpy as np
import pytest
from drafts import draft
from gauging import start
from long import LONG

from psph.acts import SOLIDS
from psph.case import load
from psph.physics.catalogue import Catalogue, Entry
from psph.physics.rigid.pushes import pulled
from psph.runs.guards import Guards
from psph.runs.record import Record
from psph.scene import Scene
from psph.scene.bodies import shares_of
from psph.simulation.rules import Columns

FREQUENCY, CENTER = 2.0, (0.1, -0.2)

ORBIT = f"""
scheme = "sph"
space = {{ dimensions = 2, spacing = 0.05 }}
time.end = 1.0
physics.sound_speed = 20.0
physics.central_force = {{ frequency = {FREQUENCY}, center = {list(CENTER)} }}
fluids.water.shape.box = {{ lower = [-2.0, -2.0], upper = [-1.8, -1.8] }}
[bodies.dumbbell]
shape.box = {{ lower = [1.0, -0.1], upper = [1.4, 0.1] }}
mass = 50.0
centre = [1.08, 0.03]
inertia = 3.0
velocity = [0.0, 0.5]
spin = 1.5
"""
"""A body whose mass is not that of its particles, and water far from it."""


def test_a_central_force_swings_a_body_about_its_centre(tmp_path):
    """X(t) = C + (X₀ − C) cos Bt + V₀/B sin Bt for the centre of mass, and no moment about it."""
    simulation = start(draft(tmp_path, ORBIT))
    while simulation.time < 0.5:
        simulation.step(0.5)
    bodies, turned = simulation.engine.of("bodies").bodies, FREQUENCY * 0.5
    swung = (np.array([1.08, 0.03]) - CENTER) * np.cos(turned)
    found = CENTER + swung + np.array([0.0, 0.5]) / FREQUENCY * np.sin(turned)
    assert bodies.centre[0, :2] == pytest.approx(found, abs=1e-4)
    assert abs(bodies.centre[0, 0] - 1.08) > 0.4  # the control: without it, it would keep its x
    assert bodies.spin[0, 2] == pytest.approx(1.5, rel=1e-9)


def test_the_mass_of_a_body_is_shared_so_that_its_centre_is_that_of_the_case(tmp_path):
    scene = Scene(draft(tmp_path, ORBIT))
    [shares], particles = shares_of(scene), scene.particles(0, scene.layout.planes, 0)
    x = particles.position[particles.material == 1]
    mass = shares[0] + x @ shares[1:]
    assert mass.sum() == pytest.approx(50.0)
    assert mass @ x / 50.0 == pytest.approx(np.array([1.08, 0.03]))
    assert np.ptp(mass) > 0.5
    [even] = shares_of(Scene(draft(tmp_path, ORBIT, "bodies.dumbbell.centre=[1.2,0.0]")))
    assert even[0] + x @ even[1:] == pytest.approx(np.full(len(x), 50.0 / len(x)))


SOLID = """
space = { dimensions = 2, spacing = 0.05, lower = [0.0, 0.0], upper = [6.0, 1.0] }
time.end = 0.1
physics.central_force = { frequency = 10.0, center = [0.0, 0.0] }
[solids.block]
shape.box = { lower = [0.3, 0.2], upper = [0.5, 0.4] }
density = 1000.0
young = 1e5
poisson = 0.3
velocity = [0.0, 1.0]
"""


def watched(case, folder, steps):
    """Energy won in units of the kinetic energy at the start by what the guard counts, and without
    potentials; and what the log calls potential, J."""
    folder.mkdir()
    simulation = start(case)
    scene = Scene(case)
    guards = Guards(scene, simulation, Record(scene, simulation, folder), folder, print)
    before = kinetic(simulation)
    for _ in range(steps):
        simulation.step()
    return guards._gain() * guards._unit / before, kinetic(simulation) / before - 1.0


def kinetic(simulation):
    store = simulation.store
    mass = store.shown("inertia" if "inertia" in store else "mass")
    return 0.5 * float((mass[:, None] * store.shown("velocity") ** 2).sum())


def test_the_guard_of_the_energy_knows_the_potential_of_a_central_force(tmp_path):
    won, faster = watched(draft(tmp_path, SOLID), tmp_path / "run", 60)
    assert abs(won) < 0.01 < 0.5 < faster


WET = """
scheme = "sph"
space = { dimensions = 2, spacing = 0.05, lower = [-1.0, -1.0], upper = [6.0, 3.0] }
time.end = 0.2
physics.sound_speed = 20.0
[fluids.water]
shape.box = { lower = [0.6, -0.6], upper = [0.8, -0.4] }
velocity = [0.0, 1.0]
[solids.block]
shape.box = { lower = [0.6, 0.2], upper = [0.8, 0.4] }
density = 2500.0
young = 1e6
poisson = 0.3
velocity = [0.0, 1.0]
"""


def test_a_damping_zone_brakes_fluids_and_no_solid(tmp_path):
    simulation = start(draft(tmp_path, WET, "physics.damping_zone={begin=0.0,end=1.0,strength=10.0}"))
    while simulation.time < 0.05:
        simulation.step(0.05)
    store = simulation.store
    upwards, solid = store.shown("velocity")[:, 1], store.shown("group") == 1
    assert upwards[solid].mean() == pytest.approx(1.0, rel=1e-12)
    x = np.array([0.625, 0.675, 0.725, 0.775])  # exp(−β s² t) of each column, if it moved by itself
    assert upwards[~solid].mean() == pytest.approx(np.exp(-0.5 * x**2).mean(), rel=0.01)


class Whirl(NamedTuple):
    """A pull round about the origin that no potential has: a_i = ω² (−y, x)."""

    rate: float

    def body(self, i):
        """ω² (−y, x), m/s²."""
        x, y = i.position
        return -self.rate * self.rate * y, self.rate * self.rate * x


class WhirlOfSolids(Whirl):
    """The same on solids alone."""

    acts = (SOLIDS,)


OWN = Catalogue(effects=(Entry("physics.whirl", Whirl), Entry("physics.whirl_of_solids", WhirlOfSolids)))


def own(folder, text, *sets):
    path = folder / "own.toml"
    path.write_text(text)
    return load(path, sets, given=OWN)


@LONG
@pytest.mark.parametrize("text", [WET, SOLID])
def test_what_a_pull_without_potential_gives_is_booked(text, tmp_path):
    won, faster = watched(own(tmp_path, text, "physics.whirl=6.0"), tmp_path / "run", 40)
    assert abs(won) < 0.1 * abs(faster)


@LONG
def test_a_pull_on_solids_alone_leaves_fluids_alone(tmp_path):
    simulation = start(own(tmp_path, WET, "physics.whirl_of_solids=6.0"))
    for _ in range(5):
        simulation.step()
    store = simulation.store
    sideways, solid = store.shown("velocity")[:, 0], store.shown("group") == 1
    assert (sideways[solid] < -1e-3).all() and abs(sideways[~solid].mean()) < 1e-9


def test_the_force_on_a_particle_of_a_body_is_push_and_pull():
    """m a + (w₀ + w·x₀) b with plain numbers; nothing of b where no effect pulls."""
    arrays = dict.fromkeys(Columns._fields)
    columns = Columns(
        **arrays | {"load": (np.array([2.0]), np.array([-1.0])), "anchor": (np.ones(1), np.ones(1))}
    )
    seen = type("Seen", (), {"mass": 3.0, "position": (0.5, 4.0)})()
    masses = np.array([[7.0, 1.0, -2.0]])
    assert pulled((Whirl(2.0),), masses, 0, seen, 0, columns) == (6.0 - 16.0 * 6.0, -3.0 + 2.0 * 6.0)
    assert pulled((), None, 0, seen, 0, columns) == (6.0, -3.0)
