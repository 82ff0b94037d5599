"""Elastic solids that meet each other, walls and rigid bodies in a fluid."""

import numpy as np
import pytest
import tomli_w
from contacts import ASKEW, BARS, HAMMER, PUDDLE, bodies_of, energy, hardest, motion, until, wrong
from drafts import draft, refusal
from gauging import start
from invariances.scenes import RUBBER, box, scene
from long import LONG
from mpi4py import MPI
from simulation.test_immersion import momentum

from psph.runs.start import run
from psph.scene import Scene
from psph.scene.faces import drawn_faces
from psph.simulation import immersion
from psph.simulation.plan import make_plan
from psph.simulation.solid_plan import solid_plan


def test_beside_a_puddle_out_of_the_way_solids_and_bodies_meet_as_without(tmp_path):
    """Both momenta to rounding, the energy as in the steps of solids alone, and the same bounce."""
    simulation = start(draft(tmp_path, HAMMER, *ASKEW, *PUDDLE, "solids.bar.damping=0.0"))
    dry = start(draft(tmp_path, HAMMER, *ASKEW))
    (before, spin, size), whole = motion(simulation), energy(simulation)
    most = hardest(simulation, 0.02)
    after, turned, _ = motion(until(simulation, 0.02))
    assert most > 0.02 * whole
    assert np.abs(after - before).max() < 1e-14 * size and np.abs(turned - spin).max() < 1e-14 * size
    assert energy(simulation) == pytest.approx(whole, rel=4e-3) == energy(until(dry, 0.02))
    assert bodies_of(simulation).spin[0, 2] == pytest.approx(bodies_of(dry).spin[0, 2], rel=0.02)


def test_their_own_steps_are_as_short_as_contact_asks_and_twice_as_long_is_not_right(tmp_path, monkeypatch):
    keys = "physics.contact.stiffness=4.0", "solids.short.damping=0.0", "solids.long.damping=0.0", *PUDDLE
    longest = solid_plan(make_plan(Scene(draft(tmp_path, BARS, *keys)))).contact_step
    case = draft(tmp_path, BARS, *keys, f"time.step={6.0 * longest}")
    assert wrong(start(case), 0.012) < 2e-3
    monkeypatch.setattr(immersion, "substeps", lambda *told: 3)
    assert wrong(start(case), 0.012) > 4e-3


SEA = """
time.end = 1.0
[space]
dimensions = 2
spacing = 0.01
periodic = ["x", "y"]
lower = [-0.3, -0.15]
upper = [0.3, 0.15]
[physics]
sound_speed = 20.0
contact = {}
[fluids.water]
shape.difference.from.box = { lower = [-0.3, -0.15], upper = [0.3, 0.15] }
shape.difference.minus = [
  { box = { lower = [-0.15, -0.05], upper = [-0.02, 0.05] } },
  { box = { lower = [0.02, -0.05], upper = [0.15, 0.05] } },
]
density = 1000.0
[solids.left]
shape.box = { lower = [-0.15, -0.05], upper = [-0.02, 0.05] }
velocity = [1.5, 0.0]
density = 2000.0
young = 1.0e6
poisson = 0.3
[solids.right]
shape.box = { lower = [0.02, -0.05], upper = [0.15, 0.05] }
velocity = [-1.5, 0.0]
density = 2000.0
young = 1.0e6
poisson = 0.3
"""
"""Two bars that meet in water."""


def gap(simulation):
    """Between two bars, spacings."""
    x, group = simulation.store.shown("position")[:, 0], simulation.store.shown("group")
    return (x[group == 2].min() - x[group == 1].max()) / 0.01


def test_bars_that_meet_in_water_drive_it_out_touch_and_part(tmp_path):
    simulation = start(draft(tmp_path, SEA))
    (before, size), nearest, most = momentum(simulation), 9.0, 0.0
    while simulation.time < 0.06:
        simulation.step()
        nearest, most = (
            min(nearest, gap(simulation)),
            max(most, simulation.store.shown("contact_energy").sum()),
        )
    after, _ = momentum(simulation)
    assert most > 0.05 and 0.93 < nearest < 1.0 < gap(simulation) - 0.1
    assert np.abs(after - before).max() < 1e-15 * size


@LONG
def test_without_contact_they_run_into_each_other(tmp_path):
    """The control: water between them alone does not hold them apart."""
    simulation, nearest = start(draft(tmp_path, SEA, "physics.contact=off")), 9.0
    while simulation.time < 0.05:
        simulation.step()
        nearest = min(nearest, gap(simulation))
    assert nearest < 0.7


TANK = """
time.end = 1.0
space = { dimensions = 2, spacing = 0.02 }
physics.sound_speed = 25.0
physics.gravity = [0.0, -9.81]
physics.contact = {}
[fluids.water]
shape.difference.from.box = { lower = [0.0, 0.0], upper = [1.0, 0.6] }
shape.difference.minus = [
  { box = { lower = [0.0, 0.0], upper = [1.0, 0.1] } },
  { box = { lower = [0.4, 0.14], upper = [0.6, 0.34] } },
]
density = 1000.0
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = { lower = [-0.08, -0.08], upper = [1.08, 0.8] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [1.0, 0.8] } }]
[solids.mat]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.1] }
clamped.box = { lower = [0.0, 0.0], upper = [1.0, 0.04] }
density = 1200.0
young = 5.0e5
poisson = 0.3
"""
"""A mat of rubber on the floor of a tank."""

ON_WALL = (
    "solids.mat=off",
    "walls.tank.shape.difference.minus=[{box={lower=[0.0,0.1],upper=[1.0,0.8]}}]",
)
BLOCK = ("bodies.block={shape={box={lower=[0.4,0.14],upper=[0.6,0.34]}},density=3000.0,velocity=[0.0,-0.8]}",)
BAR = (
    "solids.bar={shape={box={lower=[0.4,0.14],upper=[0.6,0.34]}},density=3000.0,velocity=[0.0,-0.8],"
    "young=5e5,poisson=0.3}",
)


@pytest.mark.parametrize("what", [BLOCK, pytest.param(BAR, marks=LONG)], ids=["body", "solid"])
def test_what_lands_on_rubber_under_water_stays_on_it(what, tmp_path):
    case = draft(tmp_path, TANK, *what)
    simulation, names, lowest, touched = start(case), Scene(case).layout.names, 9.0, False
    store, block, mat = simulation.store, names.index("bar" if what is BAR else "block"), names.index("mat")
    while simulation.time < 0.15:
        simulation.step()
        group, y = store.shown("group"), store.shown("position")[:, 1]
        lowest = min(lowest, (y[group == block].min() - y[group == mat].max()) / 0.02)
        touched |= store.shown("contact_energy").sum() > 0.0
    assert touched and lowest > 0.8


@LONG
def test_a_bar_that_lands_on_a_wall_under_water_stays_on_it(tmp_path):
    case = draft(tmp_path, TANK, *ON_WALL, *BAR)
    simulation, bar, lowest, touched = start(case), Scene(case).layout.names.index("bar"), 9.0, False
    store = simulation.store
    while simulation.time < 0.15:
        simulation.step()
        lowest = min(lowest, store.shown("position")[store.shown("group") == bar, 1].min() - 0.1)
        touched |= store.shown("contact_energy").sum() > 0.0
    assert touched and lowest > 0.3 * 0.02  # particles are half a spacing above the face of the bar


def test_a_run_with_bodies_and_solids_ends_well(tmp_path):
    """At its end the guards ask what each kind of matter moves, and whether that encloses the fluid."""
    case = draft(tmp_path, TANK, *BLOCK, "time.end=0.0005")
    said = []
    run(case, tmp_path / "done", MPI.COMM_SELF, say=lambda line, stream=None: said.append(line))
    assert [line for line in said if "steps in" in line]


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("periodic", [[], ["x"]])
def test_both_sides_of_a_plate_of_two_particles_are_faces(tmp_path, mirrored, periodic):
    """From half a spacing within its rows rounding said which face is nearer: one side of it had no normal."""
    way = -1.0 if mirrored else 1.0
    ends = [sorted((way * a, way * b)) for a, b in ((0.0, 1.5), (0.625, 0.875))]
    (lower, upper), (left, right) = ends
    tables = scene(
        solids={"plate": {"shape": box((left, -0.5), (right, 0.75)), **RUBBER}},
        space={"periodic": periodic, "lower": [lower, -1.0], "upper": [upper, 2.0]},
        physics={"contact": {}},
    )
    layout = Scene(draft(tmp_path, tomli_w.dumps(tables))).layout
    sides = np.array([[left + 0.0625, 0.0625], [right - 0.0625, 0.0625]])
    normal, depth = drawn_faces(layout, np.zeros(2, int), sides)
    assert normal.tolist() == [[-1.0, 0.0], [1.0, 0.0]] and depth == pytest.approx(0.5)


STICKS = ("fluids.water.viscosity=0.01", "walls.tank.no_slip=true")


def test_solids_rub_beside_a_wall_that_the_fluid_sticks_to(tmp_path):
    """What shears a contact, and what a wall shows the fluid, are two fields."""
    plan = make_plan(Scene(draft(tmp_path, TANK, *BLOCK, *STICKS, "physics.contact.friction=0.3")))
    assert {"slip", "contact_slip"} <= {*plan.arrays}


def test_what_contact_in_a_fluid_does_not_know_is_refused(tmp_path):
    for sets, says in (
        (("physics.contact=off", *BLOCK), "bodies.block: solids do not feel bodies without contact; give"),
        (("anvils.floor={at=[0.0,0.0],normal=[0.0,1.0]}",), "nothing is known of contact between solids and"),
    ):
        assert says in " ".join(refusal(tmp_path, TANK, *sets))
