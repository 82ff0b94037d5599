"""Elastic solids in fluids: momentum of both together, and steps of their own."""

import numpy as np
import pytest
from drafts import draft, refusal
from gauging import readings, start, started
from long import LONG
from mpi4py import MPI

from psph.output.diagnostics import logged
from psph.parallel.reductions import exact_sums
from psph.physics.fluid.continuity import Continuity
from psph.scene import Scene, calming, check
from psph.scene.calming import BREATHING, DEEPEST
from psph.simulation.immersion import substeps
from psph.simulation.plan import make_plan
from psph.simulation.solid_plan import solid_plan

STIRRED = """
[space]
dimensions = 2
spacing = 0.05
periodic = ["x", "y"]
lower = [0.0, 0.0]
upper = [1.2, 1.2]
[time]
end = 1.0
[physics]
sound_speed = 30.0
[fluids.heavy]
shape.difference.from.box = { lower = [0.0, 0.0], upper = [1.2, 0.6] }
shape.difference.minus = [{ box = { lower = [0.3, 0.35], upper = [0.7, 0.85] } }]
density = 1200.0
viscosity = 0.02
velocity = [0.5, -0.4]
jitter = 0.2
[fluids.light]
shape.difference.from.box = { lower = [0.0, 0.6], upper = [1.2, 1.2] }
shape.difference.minus = [{ box = { lower = [0.3, 0.35], upper = [0.7, 0.85] } }]
density = 900.0
viscosity = 0.01
velocity = [-0.8, 0.3]
jitter = 0.1
[solids.block]
shape.box = { lower = [0.3, 0.35], upper = [0.7, 0.85] }
density = 2500.0
young = 3.0e7
poisson = 0.3
law = "neo-hookean"
velocity = [0.2, 0.1]
jitter = 0.05
"""
"""A block of another density among two fluids that flow against each other and it."""


def momentum(simulation):
    """Of all, kg m/s (2,), and Σ m |v|."""
    store = simulation.store
    mass, velocity = store.shown("inertia"), store.shown("velocity")
    return (mass[:, None] * velocity).sum(axis=0), (mass * np.linalg.norm(velocity, axis=1)).sum()


@pytest.mark.parametrize("seen, density", [pytest.param("heavy", 1200.0, marks=LONG), ("light", 900.0)])
def test_fluids_and_a_solid_keep_the_momentum_of_both(seen, density, tmp_path):
    """In whosever density the fluids see it."""
    simulation = start(draft(tmp_path, STIRRED, f"solids.block.continues={seen}"))
    planned = solid_plan(simulation.plan)
    before, size = momentum(simulation)
    block = simulation.store.shown("group") == 2
    own = (simulation.store.shown("inertia") / simulation.store.shown("mass"))[block]
    assert own == pytest.approx(2500.0 / density)
    for _ in range(40):
        simulation.step()
    count = substeps(planned.solids, planned.smoothing_length, simulation.dt, simulation.previous_speed)
    assert count > 3
    after, _ = momentum(simulation)
    store, block = simulation.store, simulation.store.shown("group") == 2
    gained = (store.shown("inertia")[block, None] * store.shown("velocity")[block]).sum(axis=0)
    gained -= 2500.0 * 0.4 * 0.5 * np.array([0.2, 0.1])
    assert np.abs(after - before).max() < 1e-12 * size
    assert np.abs(gained).max() > 1e-4 * size  # they do push each other
    sums = exact_sums(MPI.COMM_SELF, logged(store, (0.0, 0.0)).terms)
    assert sums[2:] == pytest.approx(after, abs=1e-12 * size)


def test_the_number_of_steps_follows_from_the_solid_and_the_step(tmp_path):
    planned = solid_plan(make_plan(Scene(draft(tmp_path, STIRRED))))
    longest = planned.solids[0].longest_step(planned.smoothing_length, 1.0)
    for dt, count in ((0.1 * longest, 1), (longest, 1), (1.01 * longest, 2), (7.5 * longest, 8)):
        assert substeps(planned.solids, planned.smoothing_length, dt, 1.0) == count


def test_a_solid_beside_another_fluid_than_the_one_it_continues_is_said(tmp_path):
    case = draft(tmp_path, STIRRED)
    assert case.solids["block"].continues == "heavy"
    lines = [line for line in check(Scene(case)) if "block" in line]
    [line] = lines
    assert "solids.block.continues" in line and "touches fluids.light of 900 kg/m3 too" in line
    says = " ".join(refusal(tmp_path, STIRRED, "solids.block.continues=hevy"))
    assert 'solids.block.continues: "hevy": no fluid has this name; did you mean' in says


LAYERS = """
time.end = 1.0
physics.gravity = [0.0, -9.81]
physics.sound_speed = 40.0
space = { dimensions = 2, spacing = 0.025, periodic = ["x"], lower = [0.0, -0.2], upper = [1.0, 1.0] }
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.3] }
density = 1000.0
pressure = "hydrostatic"
[fluids.oil]
shape.difference.from.box = { lower = [0.0, 0.3], upper = [1.0, 0.8] }
shape.difference.minus = [{ box = { lower = [0.4, 0.45], upper = [0.6, 0.65] } }]
density = 700.0
pressure = "hydrostatic"
[walls.floor]
shape.box = { lower = [0.0, -0.15], upper = [1.0, 0.0] }
[solids.block]
shape.box = { lower = [0.4, 0.45], upper = [0.6, 0.65] }
clamped.box = { lower = [0.45, 0.5], upper = [0.55, 0.6] }
density = 2000.0
young = 2.0e6
poisson = 0.3
"""
"""A block that is held in oil above water, all at rest."""


@LONG
def test_a_block_in_oil_floats_as_archimedes_says_if_it_continues_the_oil(tmp_path):
    found = {}
    for seen in ("oil", "water"):
        simulation = start(draft(tmp_path, LAYERS, f"solids.block.continues={seen}"))
        store, lift, fastest = simulation.store, [], []
        while simulation.time < 0.4:
            simulation.step()
            if simulation.time > 0.2:
                block = np.isin(store.shown("group"), (2, 3))
                fluid = (store.shown("group") < 2) & (np.abs(store.shown("position")[:, 1] - 0.55) < 0.2)
                lift.append((store.shown("mass") * store.shown("load")[:, 1])[block].sum())
                fastest.append(np.linalg.norm(store.shown("velocity")[fluid], axis=1).max())
        found[seen] = np.mean(lift) / (700.0 * 9.81 * 0.2**2), np.mean(fastest)
    assert found["oil"][0] == pytest.approx(1.0, abs=0.01) and found["oil"][1] < 0.005
    assert abs(found["water"][0] - 1.0) > 0.02 and found["water"][1] > 0.05  # the control


PLATE = """
time.end = 1.0
physics.gravity = [0.0, -9.81]
physics.sound_speed = 64.0
space = { dimensions = 2, spacing = 0.0125 }
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.1] }
density = 1000.0
pressure = "hydrostatic"
[walls.sides]
shape.union = [
  { box = { lower = [-0.1, 0.0], upper = [0.0, 0.2] } },
  { box = { lower = [1.0, 0.0], upper = [1.1, 0.2] } },
]
[solids.plate]
shape.box = { lower = [-0.1125, -0.05], upper = [1.1125, 0.0] }
clamped.union = [
  { box = { lower = [-0.1125, -0.05], upper = [0.0, 0.0] } },
  { box = { lower = [1.0, -0.05], upper = [1.1125, 0.0] } },
]
density = 2700.0
young = 67.5e9
poisson = 0.34
"""
"""A shallow pool on a plate of aluminium."""


def swing(case, end):
    """The energy of motion of the solid in J after ``end`` s."""
    simulation = start(case)
    while simulation.time < end:
        simulation.step()
    store = simulation.store
    speed2 = (store.shown("velocity") ** 2).sum(axis=1)
    return 0.5 * (store.shown("inertia") * speed2)[store.shown("group") == 1].sum()


def test_a_stiff_plate_under_water_is_calm_and_without_viscosity_it_is_not(tmp_path):
    calm, control = (draft(tmp_path, PLATE, *more) for more in ((), ("solids.plate.damping=1.0",)))
    viscosity = solid_plan(make_plan(Scene(calm))).solids[0].viscosity
    assert 5e4 < viscosity < 2e5 and solid_plan(make_plan(Scene(control))).solids[0].viscosity == 1.0
    assert swing(calm, 0.06) < 1e-3  # it swings under the weight of the water, 7e-4 J at most
    assert swing(control, 0.06) > 1e-2


def test_what_lets_waves_of_a_solid_grow_is_said(tmp_path):
    assert not any("plate" in one for one in check(Scene(draft(tmp_path, PLATE))))
    few = draft(tmp_path, PLATE, "solids.plate.damping=1e4")
    assert "solids.plate.damping: 10000 Pa s lets waves grow" in " ".join(check(Scene(few)))
    light = draft(tmp_path, PLATE, "solids.plate.density=400.0")
    assert "the fluid takes 44 % of its speed in a step" in " ".join(check(Scene(light)))


SOFT = """
time.end = 1.0
physics.gravity = [0.0, -9.81]
space = { dimensions = 2, spacing = 0.05 }
[fluids.water]
shape.difference.from.box = { lower = [0.0, 0.0], upper = [1.5, 0.8] }
shape.difference.minus = [{ box = { lower = [0.6, 0.3], upper = [0.9, 0.6] } }]
density = 1000.0
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = { lower = [-0.2, -0.2], upper = [1.7, 1.2] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [1.5, 1.2] } }]
[solids.block]
shape.box = { lower = [0.6, 0.3], upper = [0.9, 0.6] }
density = 1000.0
young = 1.0e5
poisson = 0.3
"""
"""A block as heavy as water in a tank of it, under 3.4 kPa, and ten times as soft as the water is for its sound."""


DISC = """
space = { dimensions = 2, spacing = 0.025 }
time.end = 1.5
physics.sound_speed = 6.0
[fluids.oil]
viscosity = 0.02
velocity_gradient = [[0.0, -1.0], [1.0, 0.0]]
shape.difference.from.disc = { center = [0.0, 0.0], radius = 0.5 }
shape.difference.minus = [{ disc = { center = [0.1, 0.0], radius = 0.15 } }]
[walls.drum]
no_slip = true
motion = { rotation = { speed = 1.0, center = [0.0, 0.0] } }
shape.difference.from.disc = { center = [0.0, 0.0], radius = 0.6 }
shape.difference.minus = [{ disc = { center = [0.0, 0.0], radius = 0.5 } }]
[solids.disc]
shape.disc = { center = [0.1, 0.0], radius = 0.15 }
density = 1000.0
young = 1e5
poisson = 0.3
velocity_gradient = [[0.0, -1.0], [1.0, 0.0]]
[gauges.disc]
force = { on = ["disc"] }
"""
"""A thick disc that turns with the drum and the oil around it."""


@LONG
@pytest.mark.parametrize(
    ("young", "breathing", "deepest"),
    [(1e5, BREATHING, DEEPEST), (1e6, BREATHING, DEEPEST), (1e5, 1.0, DEEPEST), (1e5, 1.0, np.inf)],
)
def test_a_thick_solid_turns_with_its_fluid_and_does_not_shake(
    young, breathing, deepest, monkeypatch, tmp_path
):
    """It is calmed as one that swells and shrinks, but need not be.  The control: were waves along its face to
    take all of its thickness along, it would."""
    monkeypatch.setattr(calming, "BREATHING", breathing)
    monkeypatch.setattr(calming, "DEEPEST", deepest)
    simulation, scene = started(draft(tmp_path, DISC, f"solids.disc.young={young}"))
    while simulation.time < 1.2:
        simulation.step()
    borne = 0.0
    while simulation.time < 1.3:
        simulation.step()
        found = readings(simulation, scene)
        borne = max(borne, np.hypot(found["disc.force_x"], found["disc.force_y"]))
    centripetal = 1000.0 * np.pi * 0.15**2 * 0.1
    assert borne < 1.5 * centripetal if deepest == DEEPEST else borne > 20.0 * centripetal


@LONG
@pytest.mark.timeout(900)
def test_a_block_softer_than_the_water_is_pressed_together_and_does_not_shake(tmp_path, monkeypatch):
    """By p/(2(λ + μ)) = 1.8 %, most of it within 0.2 s.  The control: with the strain of the block in the density
    that it shows."""
    found = []
    for chosen in (Continuity.in_scene, lambda self, scene: self):
        monkeypatch.setattr(Continuity, "in_scene", chosen)
        simulation = start(draft(tmp_path, SOFT))
        while simulation.time < 0.2:
            simulation.step()
        store = simulation.store
        block = store.shown("group") == 1
        speed = np.linalg.norm(store.shown("velocity")[block], axis=1).max()
        found.append((speed, np.ptp(store.shown("position")[block], axis=0) / 0.25))
    (calm, size), (shaken, _) = found
    assert calm < 0.2 and shaken > 2.0
    assert size == pytest.approx([0.985, 0.985], abs=0.007)


@pytest.mark.parametrize(
    "override, says",
    [
        (
            "bodies.one={density=500.0,shape={disc={center=[1.0,1.0],radius=0.1}}}",
            "bodies.one: solids do not feel bodies without contact; give physics.contact = {}",
        ),
        ("physics.pressure_gradient=minimum", "does not push back"),
    ],
)
def test_what_a_solid_in_a_fluid_cannot_have_is_refused(override, says, tmp_path):
    assert says in " ".join(refusal(tmp_path, STIRRED, override))
