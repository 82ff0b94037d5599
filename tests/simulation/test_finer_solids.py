"""Solids in fluids whose particles are a half or a third of the scene's spacing apart."""

import numpy as np
import pytest
from drafts import draft, refusal
from gauging import readings, start, started
from simulation.test_immersion import STIRRED, momentum

from psph.physics.fluid.cells import OneEach
from psph.physics.fluid.correction import GradientCorrection
from psph.runs.explain import explain
from psph.scene import Scene, check
from psph.simulation.plan import make_plan
from psph.simulation.solid_plan import solid_plan

HELD = """
time.end = 1.0
physics.sound_speed = 30.0
space = { dimensions = 2, spacing = 0.05, periodic = ["y"], lower = [-0.3, 0.0], upper = [1.3, 0.6] }
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.6] }
density = 1000.0
pressure = 2000.0
[walls.back]
shape.box = { lower = [-0.2, 0.0], upper = [0.0, 0.6] }
[solids.plate]
shape.box = { lower = [1.0, 0.0], upper = [1.2, 0.6] }
clamped.box = { lower = [1.0, 0.0], upper = [1.2, 0.6] }
density = 2000.0
young = 1.0e7
poisson = 0.3
[gauges.push.force]
on = ["plate"]
"""
"""Water under the same pressure everywhere between a wall and a plate that is held."""

TURNED = (
    'space.periodic=["x"]',
    "space.lower=[0.0, -0.3]",
    "space.upper=[0.6, 1.3]",
    "fluids.water.shape.box={lower=[0.0, 0.0], upper=[0.6, 1.0]}",
    "walls.back.shape.box={lower=[0.0, 1.0], upper=[0.6, 1.2]}",
    "solids.plate.shape.box={lower=[0.0, -0.2], upper=[0.6, 0.0]}",
    "solids.plate.clamped.box={lower=[0.0, -0.2], upper=[0.6, 0.0]}",
)
"""The same along another axis, the plate at the other end."""


def pressed(case, steps=200):
    """The push on the plate over pressure times area: at once, and the mean over some steps, in which sound
    comes and goes; all particles."""
    simulation, scene = started(case)
    found = []
    for _ in range(steps):
        read, store = readings(simulation, scene), simulation.store
        across = np.abs(read["push.force_x"]) + np.abs(read["push.force_y"])
        x, fluid = store.shown("position"), store.shown("kind") == 0
        deep = fluid & (np.abs(x[:, np.ptp(x[fluid], axis=0).argmax()] - 0.5) < 0.2)
        found.append((across, 0.6 * store.shown("pressure")[deep].mean()))
        simulation.step()
    push, pressure = np.transpose(found)
    return push[0] / pressure[0], push.mean() / pressure.mean(), store


@pytest.mark.parametrize("parts, turned", [(1, False), (2, False), (3, True)])
def test_an_even_pressure_presses_a_finer_plate_as_a_coarse_one(parts, turned, tmp_path):
    """To 1 % of p over the area, and to 2 % at once, before the water has found its place."""
    case = draft(tmp_path, HELD, f"solids.plate.spacing={0.05 / parts}", *TURNED * turned)
    begun, settled, store = pressed(case)
    assert begun == pytest.approx(1.0, abs=1e-9 if parts == 1 else 0.02)
    assert settled == pytest.approx(1.0, abs=0.01)
    assert np.count_nonzero(store.shown("group") == 2) == 48 * parts**2
    assert np.unique(store.shown("id")).size == store.owned


def test_in_finer_walls_corrected_gradients_know_how_many_particles_a_cell_has(tmp_path, monkeypatch):
    """The control: with L by the volume of one particle the plate pushes harder at once."""
    case, fit = draft(tmp_path, HELD, "solids.plate.spacing=0.025"), GradientCorrection.in_scene
    monkeypatch.setattr(GradientCorrection, "in_scene", lambda *of: fit(*of)._replace(cells=OneEach()))
    assert pressed(case, 2)[0] > 1.05


@pytest.mark.parametrize("parts", (2, 3))
def test_fluids_and_a_finer_solid_keep_the_momentum_of_both(parts, tmp_path):
    simulation = start(draft(tmp_path, STIRRED, f"solids.block.spacing={0.05 / parts}"))
    before, size = momentum(simulation)
    block = simulation.store.shown("group") == 2
    assert simulation.store.shown("inertia")[block].sum() == pytest.approx(2500.0 * 0.4 * 0.5)
    assert simulation.store.shown("mass")[block].sum() == pytest.approx(1200.0 * 0.4 * 0.5)
    for _ in range(20):
        simulation.step()
    after, _ = momentum(simulation)
    assert np.abs(after - before).max() < 1e-12 * size
    own, block = simulation.store.shown("inertia"), simulation.store.shown("group") == 2
    gained = (own[block, None] * simulation.store.shown("velocity")[block]).sum(axis=0)
    assert np.abs(gained - 500.0 * np.array([0.2, 0.1])).max() > 1e-4 * size  # they do push each other


BAR = """
time = {{ end = 1.0, step = 2e-5 }}
physics.gravity = [{gravity}]
space = {{ dimensions = {d}, spacing = {spacing} }}
[solids.bar]
shape.box = {{ lower = [{low}], upper = [{high}] }}
clamped.box = {{ lower = [{low}], upper = [{held}] }}
density = 1100.0
young = 2.0e6
poisson = 0.3
damping = 0.0
velocity_gradient = [{sheared}]
loads.end = {{ shape = {{ box = {{ lower = [{end}], upper = [{high}] }} }}, force = [{force}] }}
"""

SEA = """
[fluids.water]
shape.box = {{ lower = [{far}], upper = [{beyond}] }}
density = 1000.0
"""
"""Too far away to be felt."""


def swung(folder, d, spacing, parts):
    """Velocities and places of the particles of a bar after 40 steps, by their places at the start."""
    zeros = [0.0] * (d - 1)
    numbers = {
        "gravity": [0.0, -3.0, 1.0][:d],
        "low": [-0.3, *zeros],
        "high": [0.6] + [0.2] * (d - 1),
        "held": [0.0] + [0.2] * (d - 1),
        "sheared": [[0.5 * (i - j) + 0.3 for j in range(d)] for i in range(d)],
        "end": [0.5, *zeros],
        "force": [3.0, -20.0, 5.0][:d],
        "far": [3.0, *zeros],
        "beyond": [3.6] + [0.6] * (d - 1),
    }
    words = {name: str(of)[1:-1] for name, of in numbers.items()}
    text = (BAR + SEA * (parts > 1)).format(d=d, spacing=spacing, **words)
    case = draft(folder, text, *[f"solids.bar.spacing={spacing / parts}"] * (parts > 1))
    simulation = start(case)
    store = simulation.store
    for _ in range(40):
        simulation.step()
    bar = store.shown("kind") != 0
    order = np.lexsort(np.round(store.shown("reference")[bar], 6).T)
    return store.shown("velocity")[bar][order], store.shown("position")[bar][order]


@pytest.mark.parametrize("d, parts", [(2, 2), (2, 3), (3, 2)])
def test_a_finer_solid_moves_as_one_in_a_scene_of_its_spacing(d, parts, tmp_path):
    """Out of reach of the water, under its weight, a load and inner forces: in 3D with its shares."""
    (tmp_path / "alone").mkdir()
    v, x = swung(tmp_path, d, 0.1, parts)
    v_0, x_0 = swung(tmp_path / "alone", d, 0.1 / parts, 1)
    assert len(v) == len(v_0) and np.abs(v_0).max() > 0.01
    assert np.abs(v - v_0).max() < 1e-9 * np.abs(v_0).max()
    assert np.abs(x - x_0).max() < 1e-9


def test_steps_and_lines_are_those_of_the_finer_spacing(tmp_path):
    scene = Scene(draft(tmp_path, STIRRED, "solids.block.spacing=0.025"))
    plan = make_plan(scene)
    [fine] = solid_plan(plan).solids
    h = solid_plan(plan).smoothing_length
    assert fine.longest_step(h, 1.0) == fine._replace(finer=1).longest_step(0.5 * h, 1.0)
    assert fine.longest_step(h, 1.0) == pytest.approx(
        0.5 * fine._replace(finer=1).longest_step(h, 1.0), rel=1e-6
    )
    said = "\n".join(explain(scene, 1))
    assert "320 particles, 0 of them clamped, 16 across x" in said
    assert "its spacing is 0.025 m, 1/2 of space.spacing" in said


@pytest.mark.parametrize(
    "overrides, says",
    [
        (["solids.block.spacing=0.02"], "is no half or third of space.spacing; give 0.025 or 0.0166667"),
        (["solids.block.spacing=0.1"], "is no half or third of space.spacing"),
        (["solids.block.spacing=0.0125"], "is no half or third of space.spacing"),
        (["solids.block.spacing=0.025", "physics.contact={}"], "contact knows of one spacing"),
        (["solids.block.spacing=0.025", "fluids=off"], "there is no fluid of another spacing"),
    ],
)
def test_other_spacings_are_refused(overrides, says, tmp_path):
    assert says in " ".join(refusal(tmp_path, STIRRED, *overrides))


def test_a_plate_two_cells_thick_is_told_what_spacing_it_needs(tmp_path):
    thin = "solids.block.shape.box={lower=[0.3, 0.35], upper=[0.4, 0.85]}"
    said = "\n".join(check(Scene(draft(tmp_path, STIRRED, thin))))
    assert "2 particles thick along x" in said and "or solids.block.spacing = 0.025" in said
    finer = "\n".join(check(Scene(draft(tmp_path, STIRRED, thin, "solids.block.spacing=0.025"))))
    assert "particles thick along x: it will bend" not in finer
