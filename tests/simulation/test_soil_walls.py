"""Soil beside walls: what they bear while it rests, and whether it slides along them."""

import math

import numpy as np
import pytest
from drafts import draft, refusal
from long import LONG
from mpi4py import MPI

from psph.fields import FLUID
from psph.matter import wall
from psph.output.gauges.make import gauges_of
from psph.output.ledger import Ledger
from psph.physics.damping import reconstructed
from psph.physics.stress import deviator, faces
from psph.runs.setup import create_particles
from psph.scene import Scene
from psph.scene.smooth import smooth_faces
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
    return simulation, gauges_of(scene)


def advanced(simulation, time):
    """The same after so many seconds."""
    while simulation.time < time:
        simulation.step()
    return simulation


def pushes(simulation, gauges, depth=1.0):
    """The push on the right wall over K₀ρgH²/2, and that on the floor over ρgH."""
    side, floor = (gauges[f"gauge-{name}.csv"].row(simulation) for name in ("right", "floor"))
    return side[0] / (PUSH * depth), -floor[1] / (WEIGHT * depth)


def fastest(simulation):
    """The largest speed of the soil, m/s."""
    s = simulation.store
    return np.abs(s.shown("velocity")[s.shown("kind") == FLUID]).max()


@pytest.mark.parametrize("at_rest", (0.3 / 0.7, 0.6))
def test_soil_rests_in_a_smooth_box_and_its_walls_bear_its_stress_across_their_faces(at_rest, tmp_path):
    """ν/(1 − ν) lies outside the cone of plane strain: then the push grew by 6 %, and soil in the corners, where
    normals pointed at it aslant, moved at 0.05 m/s."""
    ratio = at_rest / (0.3 / 0.7)
    bed, gauges = begun(draft(tmp_path, BED, f"soils.bed.rest_coefficient={at_rest}"))
    side, floor = pushes(bed, gauges)
    assert side / ratio == pytest.approx(1.0, abs=0.005) and floor == pytest.approx(1.0, abs=0.005)
    side, floor = pushes(advanced(bed, 0.2), gauges)
    assert side / ratio == pytest.approx(1.0, abs=0.01) and floor == pytest.approx(1.0, abs=0.005)
    assert fastest(bed) < 0.003


def test_walls_that_show_their_mean_stress_alone_are_pushed_aside(tmp_path, monkeypatch):
    """The control."""
    monkeypatch.setattr(faces, "faces_of", lambda scene: faces.Sticking())
    monkeypatch.setattr(deviator, "faces_of", faces.faces_of)
    bed, gauges = begun(draft(tmp_path, BED))
    assert pushes(bed, gauges)[0] > 1.15 and pushes(advanced(bed, 0.2), gauges)[0] > 1.3


def test_normals_that_point_at_the_soil_kick_it_out_of_corners(tmp_path, monkeypatch):
    """The control: behind the corner they are aslant to both faces."""

    def aslant(scene, species, position):
        found = smooth_faces(scene, species, position)
        corner = (position[:, 0] > 1.0) & (position[:, 1] < 0.0)
        found.normal[corner], found.edge[corner] = np.sqrt(0.5), 0.0
        return found

    monkeypatch.setattr(wall, "smooth_faces", aslant)
    bed, _ = begun(draft(tmp_path, BED))
    assert fastest(advanced(bed, 0.02)) > 0.02


def test_soil_with_water_in_its_pores_rests_too(tmp_path):
    """Its stress spread as that of a dry one of its weight: the push fell by 4 %."""
    bed, gauges = begun(draft(tmp_path, BED, "soils.bed.water_level=0.5"))
    whole = (0.3 / 0.7 * 0.8 + 1.0) / (0.3 / 0.7 * 1.8)  # of 800 kg/m³ and its water, over that of 1800
    side, floor = pushes(advanced(bed, 0.2), gauges)
    assert side / whole == pytest.approx(1.0, abs=0.01) and floor == pytest.approx(1.0, abs=0.01)


def extrapolated(folder, sticks):
    """The bed between extrapolated walls, with friction or without, and its gauges."""
    names = ("floor", "left", "right")
    words = [f"walls.{name}.condition=extrapolated" for name in names]
    words += [f"walls.{name}.no_slip=true" for name in names if sticks]
    return begun(draft(folder, BED, *words))


@LONG
@pytest.mark.parametrize("sticks", (False, True))
def test_extrapolated_walls_begin_with_it_too(sticks, tmp_path):
    assert pushes(*extrapolated(tmp_path, sticks)) == (pytest.approx(1.0, abs=0.005),) * 2


ROUGH = [f"walls.{name}.no_slip=true" for name in ("floor", "left", "right")]


@LONG
def test_soil_stays_at_rest_on_walls_with_friction(tmp_path):
    """Measured: after 2 s the side bears 0.991, the floor 1.003, and nothing is faster than 1.0 mm/s."""
    bed, gauges = begun(draft(tmp_path, BED, *ROUGH))
    side, floor = pushes(advanced(bed, 2.0), gauges)
    assert side == pytest.approx(1.0, abs=0.02) and floor == pytest.approx(1.0, abs=0.005)
    assert fastest(bed) < 0.002


@LONG
def test_walls_that_show_their_stress_by_their_own_pressure_lift_it(tmp_path, monkeypatch):
    """The control: 19 mm/s after 2 s, and a push of 1.16."""
    monkeypatch.setattr(deviator, "column_of", lambda scene: faces.OwnPressure())
    bed, gauges = begun(draft(tmp_path, BED, *ROUGH))
    side, _ = pushes(advanced(bed, 2.0), gauges)
    assert side > 1.1 and fastest(bed) > 0.01


@LONG
@pytest.mark.xfail(strict=True, reason="not so since smooth stress no longer spreads (76b21c80)")
@pytest.mark.parametrize("sticks", (False, True))
def test_extrapolated_walls_bear_it_too(sticks, tmp_path):
    """They continued its mean stress with its whole weight: with friction the push grew by a quarter in 0.5 s.

    Measured on 29 November 2026: after 0.5 s the side bears 1.048 without friction and 0.953 with, the floor
    1.002 and 0.999; after 1 s 1.096 and 1.27, 1.003 and 1.08: with friction the lowest row comes loose.
    """
    bed, gauges = extrapolated(tmp_path, sticks)
    side, floor = pushes(advanced(bed, 0.5), gauges)
    assert side == pytest.approx(1.0, abs=0.025) and floor == pytest.approx(1.0, abs=0.01)
    assert fastest(bed) < 0.01


@LONG
def test_smooth_walls_bear_it_in_3d_as_in_2d(tmp_path):
    bed, gauges = begun(draft(tmp_path, BED, *EXTRUDED))
    assert pushes(bed, gauges, 0.5) == (pytest.approx(1.0, abs=0.005),) * 2
    side, floor = pushes(advanced(bed, 0.2), gauges, 0.5)
    assert side == pytest.approx(1.0, abs=0.015) and floor == pytest.approx(1.0, abs=0.005)
    assert fastest(bed) < 0.003


SLOPED = (
    "soils.bed.shape.polygon={ points=[[0.0,0.0], [1.0,0.0], [1.5,0.5], [0.0,0.5]] }",
    "walls.floor.shape.box={ lower=[-0.2,-0.2], upper=[1.0,0.0] }",
    "walls.right.shape.polygon={ points=[[1.0,0.0], [1.7,0.7], [1.7,-0.2], [1.0,-0.2]] }",
)
"""One side at 45°."""


@LONG
def test_a_side_at_45_degrees_is_pushed_across_its_face(tmp_path):
    bed = BED.replace("shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }", "").replace(
        "right.shape.box = { lower = [1.0, 0.0], upper = [1.2, 0.7] }", ""
    )
    bed, gauges = begun(draft(tmp_path, bed, *SLOPED))
    advanced(bed, 0.3)
    side, floor = (gauges[f"gauge-{name}.csv"].row(bed) for name in ("right", "floor"))
    assert -(side[1] + floor[1]) == pytest.approx(1.25 * WEIGHT, rel=0.015)
    assert side[0] == pytest.approx(-side[1], rel=0.12)


MOVING = "walls.right.motion={ rotation={ center=[1.0, 0.0], speed=0.5 } }"


def test_the_normals_of_a_wall_turn_with_it(tmp_path):
    bed, _ = begun(draft(tmp_path, BED, MOVING))
    s = advanced(bed, 0.02).store
    began = np.column_stack(s["anchor"])
    before = (s.group == s.group.max()) & (began[:, 0] < 1.1) & (began[:, 1] > 0.2) & (began[:, 1] < 0.5)
    normal, turn = np.column_stack(s["face_normal"])[before], 0.5 * bed.time
    assert np.abs(normal @ [math.cos(turn), math.sin(turn)]) == pytest.approx(1.0, rel=1e-12)
    assert (normal**2).sum(axis=1) == pytest.approx(1.0, rel=1e-12)


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


@pytest.mark.parametrize(
    "images, bound",
    ((reconstructed.images_of, 0.02), pytest.param(lambda scene: reconstructed.Whole(), None, marks=LONG)),
)
def test_soil_slides_on_a_mirror_that_sticks_as_it_does_on_a_wall(images, bound, tmp_path, monkeypatch):
    """g (sin θ − sin φ cos θ), Davis (1968).  The control damps the jump at the plane, and gains a tenth less."""
    monkeypatch.setattr(reconstructed, "images_of", images)
    angle = math.radians(35.0)
    pull = f"physics.gravity=[{9.81 * math.sin(angle)!r}, {-9.81 * math.cos(angle)!r}]"
    layer, _ = begun(draft(tmp_path, LAYER, pull))
    begin = advanced(layer, 0.08).store.shown("velocity")[:, 0].mean(), layer.time
    end = advanced(layer, 0.25).store.shown("velocity")[:, 0].mean(), layer.time
    gain = (end[0] - begin[0]) / (end[1] - begin[1])
    theory = 9.81 * (math.sin(angle) - 0.5 * math.cos(angle))
    assert gain == pytest.approx(theory, rel=bound) if bound else gain < 0.95 * theory


UNDER_A_STREAM = """
space = { dimensions = 2, spacing = 0.04, periodic = ["x"], lower = [0.0, -0.16], upper = [0.32, 0.8] }
time.end = 1.0
physics = { gravity = [0.0, -9.81], sound_speed = 30.0 }
[fluids.water]
shape.box = { lower = [0.0, 0.2], upper = [0.32, 0.4] }
pressure = "hydrostatic"
velocity = [1.0, 0.0]
[soils.bed]
shape.box = { lower = [0.0, 0.0], upper = [0.32, 0.2] }
density = 1900.0
young = 1e6
poisson = 0.3
friction_angle = 32.0
[walls.floor]
shape.box = { lower = [0.0, -0.16], upper = [0.32, 0.0] }
continues = "bed"
no_slip = true
"""


def speed_over_soil(folder):
    """The mean speed of water after 0.2 s on soil at rest, m/s, of 1."""
    stream, _ = begun(draft(folder, UNDER_A_STREAM))
    store = advanced(stream, 0.2).store
    return store.shown("velocity")[store.shown("group") == 0, 0].mean()


def test_water_slides_over_soil_without_friction(tmp_path, monkeypatch):
    """The control takes the jump of the velocity for disorder."""
    assert speed_over_soil(tmp_path) == pytest.approx(1.0, abs=2e-3)
    monkeypatch.setattr(reconstructed, "images_of", lambda scene: reconstructed.Whole())
    assert speed_over_soil(tmp_path) < 0.97
