"""Soil beside walls: what they bear while it rests, and whether it slides along them."""

import math

import numpy as np
import pytest
from drafts import draft, refusal
from long import LONG
from mpi4py import MPI

from psph.output.gauges.make import gauges_of
from psph.output.ledger import Ledger
from psph.physics.stress import deviator, faces
from psph.runs.setup import create_particles
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation

pytestmark = pytest.mark.timeout(600)

BED = """
time.end = 1.0
physics.gravity = [0.0, -9.81]
space = { dimensions = 2, spacing = 0.05 }
[soils.bed]
density = 1800.0
young = 2e6
poisson = 0.3
friction_angle = 30.0
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }
[walls]
floor.shape.box = { lower = [-0.2, -0.2], upper = [1.2, 0.0] }
left.shape.box = { lower = [-0.2, 0.0], upper = [0.0, 0.7] }
right.shape.box = { lower = [1.0, 0.0], upper = [1.2, 0.7] }
[gauges]
right.force.on = ["right"]
floor.force.on = ["floor"]
"""
"""Sand in a box without friction."""

EXTRUDED = (
    "space={ dimensions=3, spacing=0.05, periodic=['z'], lower=[-0.2, -0.2, 0.0], upper=[1.2, 0.7, 0.5] }",
    "physics.gravity=[0.0, -9.81, 0.0]",
    "soils.bed.shape.box={ lower=[0.0, 0.0, 0.0], upper=[1.0, 0.5, 0.5] }",
    "walls.floor.shape.box={ lower=[-0.2, -0.2, 0.0], upper=[1.2, 0.0, 0.5] }",
    "walls.left.shape.box={ lower=[-0.2, 0.0, 0.0], upper=[0.0, 0.7, 0.5] }",
    "walls.right.shape.box={ lower=[1.0, 0.0, 0.0], upper=[1.2, 0.7, 0.5] }",
)

PUSH, WEIGHT = 0.3 / 0.7 * 1800.0 * 9.81 * 0.5**2 / 2.0, 1800.0 * 9.81 * 0.5
"""K₀ρgH²/2 on a side and ρgH on the floor, N/m."""


def begun(case):
    """The simulation of a case, and its gauges."""
    scene = Scene(case)
    plan = make_plan(scene)
    simulation = Simulation(
        scene, plan, create_particles(scene, plan, MPI.COMM_SELF), MPI.COMM_SELF, Ledger()
    )
    return simulation, gauges_of(scene, plan.mirrors)


def advanced(simulation, time):
    """The same after so many seconds."""
    while simulation.time < time:
        simulation.step()
    return simulation


def pushes(simulation, gauges, depth=1.0):
    """The push on the right wall over K₀ρgH²/2, and that on the floor over ρgH."""
    side, floor = (gauges[f"gauge-{name}.csv"].row(simulation) for name in ("right", "floor"))
    return side[0] / (PUSH * depth), -floor[1] / (WEIGHT * depth)


def test_smooth_walls_bear_the_stress_of_soil_across_their_face_and_it_rests(tmp_path, monkeypatch):
    """With the mean stress that walls showed before, the push was 1.20 times as large and grew to twice.  With
    ten rows what acts behind the corner counts for 6 %."""
    bed, gauges = begun(draft(tmp_path, BED))
    assert pushes(bed, gauges) == (pytest.approx(1.0, abs=0.08),) * 2
    side, floor = pushes(advanced(bed, 0.3), gauges)
    assert side == pytest.approx(1.0, abs=0.2) and floor == pytest.approx(1.0, abs=0.05)
    monkeypatch.setattr(faces, "faces_of", lambda scene: faces.Sticking())
    monkeypatch.setattr(deviator, "faces_of", faces.faces_of)
    bed, gauges = begun(draft(tmp_path, BED))
    assert pushes(bed, gauges)[0] > 1.15 and pushes(advanced(bed, 0.3), gauges)[0] > 1.6


@LONG
def test_smooth_walls_bear_it_in_3d_as_in_2d(tmp_path):
    bed, gauges = begun(draft(tmp_path, BED, *EXTRUDED))
    assert pushes(bed, gauges, 0.5) == (pytest.approx(1.0, abs=0.08),) * 2
    side, floor = pushes(advanced(bed, 0.3), gauges, 0.5)
    assert side == pytest.approx(1.0, abs=0.2) and floor == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize("condition", ("repulsive", "penalty"))
def test_walls_that_bear_no_pressure_are_refused_beside_soils(condition, tmp_path):
    [line] = refusal(tmp_path, LAYER, f"walls.floor.condition={condition}", "walls.floor.no_slip=off")
    assert f'walls.floor.condition: "{condition}": bears no stress of soil; take "dynamic"' in line


LAYER = """
time.end = 1.0
space = { dimensions = 2, spacing = 0.01, periodic = ["x"], lower = [0.0, -0.04], upper = [0.1, 0.2] }
[soils.layer]
density = 1800.0
young = 1e6
poisson = 0.3
friction_angle = 30.0
shape.box = { lower = [0.0, 0.0], upper = [0.1, 0.08] }
[walls.floor]
condition = "mirror"
no_slip = true
shape.box = { lower = [0.0, -0.04], upper = [0.1, 0.0] }
"""


def test_soil_rests_on_a_mirror_that_sticks_below_its_friction(tmp_path):
    """On one without friction it gains g sin 24° at once; as a stress was turned before, two thirds of it."""
    angle = math.radians(24.0)
    pull = f"physics.gravity=[{9.81 * math.sin(angle)!r}, {-9.81 * math.cos(angle)!r}]"
    layer, _ = begun(draft(tmp_path, LAYER, pull))
    speed = advanced(layer, 0.1).store.shown("velocity")[:, 0]
    assert np.abs(speed).max() < 0.005
    slides, _ = begun(draft(tmp_path, LAYER, pull, "walls.floor.no_slip=false"))
    gained = advanced(slides, 0.02).store.shown("velocity")[:, 0].mean()
    assert gained == pytest.approx(9.81 * math.sin(angle) * slides.time, rel=0.02)
