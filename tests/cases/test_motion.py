"""Walls and frames that move, against exact answers."""

import math

import numpy as np
import pytest
from cases.measures import by_id
from long import LONG
from mpi4py import MPI

from psph.case import load
from psph.case.motion import motion_of
from psph.output.reader import Run
from psph.runs.start import run

TANK = """
space = { dimensions = 2, spacing = 0.02 }
parallel.axis = "x"
physics.gravity = [0.0, -9.81]
physics.sound_speed = 20.0
physics.artificial_viscosity = 0.1
output = { frames = 0.05, log = 0.05 }
fluids.water = { shape.box = { lower = [0.0, 0.0], upper = [0.6, 0.2] }, pressure = "hydrostatic" }
[walls.tank]
condition = "CONDITION"
shape.difference.from.box = { lower = [-0.06, -0.06], upper = [0.66, 0.5] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [0.6, 0.5] } }]
"""
SWAY = "{ sinusoid = { amplitude = [0.01, 0.0], period = 1.0 }, ramp = 0.4 }"
ROLL = "{ sinusoid = { angle = 0.06, center = [0.3, 0.0], period = 1.0 }, ramp = 0.4 }"


@pytest.fixture
def ran(tmp_path):
    """A function: the text of a case → its run, on one rank."""

    def make(text, name="case"):
        path = tmp_path / f"{name}.toml"
        path.write_text(text)
        run(load(path), tmp_path / name, MPI.COMM_SELF, say=lambda *_: None)
        return Run(tmp_path / name)

    return make


def tank(condition, end, way, motion):
    """The text of the tank: ``way`` is walls.tank or frame, which ``motion`` moves."""
    case = f"time.end = {end}\n{TANK}".replace("CONDITION", condition)
    return f"{case}\n[{way}]\nmotion = {motion}" if way == "frame" else f"{case}\nmotion = {motion}"


def heights(position, at):
    """The surface beside the two walls of the tank, m: of particles within four spacings of them."""
    x, y = position.T
    return [y[near].max() for near in (x < 4 * at, x > 0.6 - 4 * at)]


@pytest.mark.parametrize("condition", ["dynamic", pytest.param("extrapolated", marks=LONG)])
@pytest.mark.parametrize("motion", [SWAY, pytest.param(ROLL, marks=LONG)], ids=["sway", "roll"])
def test_a_moving_tank_and_an_accelerated_frame_are_one_flow(motion, condition, ran):
    """Free surface beside the walls and middle of the water, told in the tank, and a control at rest."""
    framed = ran(tank(condition, 1.5, "frame", motion), "framed")
    moved = ran(tank(condition, 1.5, "walls.tank", motion), "moved")
    rigid = motion_of(load(moved.folder / "case.toml").walls["tank"].motion)
    apart, levels = [], []
    for n, time in enumerate(framed.times):
        one, other = by_id(framed.frame(n)), by_id(moved.frame(n))
        water = one["kind"] == 0
        pose = rigid.pose(float(time))
        turn = np.reshape(pose.rotation, (3, 3))[:2, :2]
        told = (other["position"][water][:, :2] - pose.translation[:2]) @ turn + pose.reference[:2]
        here = one["position"][water][:, :2]
        levels.append(heights(here, 0.02))
        apart.append([*np.subtract(heights(told, 0.02), levels[-1]), *(told - here).mean(axis=0)])
    swing = np.ptp(levels, axis=0).min()
    assert swing > 0.02  # it sloshes, two spacings at least
    assert np.abs(apart)[:, :2].max() < 0.25 * 0.02, np.abs(apart).max(axis=0)
    assert np.abs(apart)[:, 2:].max() < 0.02 * 0.02


PULL = "{ acceleration = [1.962, 0.0], ramp = 1.0 }"


@LONG
def asides(run):
    """How far the middle of the water lies beside that of the tank, m, in the frames after two seconds."""
    found = []
    for n in np.flatnonzero(np.asarray(run.times) > 2.01):
        frame = by_id(run.frame(int(n)))
        x, water = frame["position"][:, 0], frame["kind"] == 0
        found.append(x[water].mean() - 0.5 * (x[~water].min() + x[~water].max()))
    return np.array(found)


def test_the_surface_of_a_tank_that_is_accelerated_tilts_by_a_over_g_as_in_a_frame(ran):
    """Under a surface that tilts by tan θ = a/g, the middle of the water lies L² tan θ/12h to the side.

    On the average over two periods of the sloshing, 0.99 s each.  Without the shift of the default scheme,
    which knows how fast the tank goes by: at 7 m/s in the end.
    """
    still = "physics.artificial_viscosity = 0.5\nphysics.position_shift = 'off'"
    framed, moved = (
        asides(ran(tank("dynamic", 4.0, way, PULL).replace("physics.artificial_viscosity = 0.1", still), way))
        for way in ("frame", "walls.tank")
    )
    tilts = [-12.0 * 0.2 * found.mean() / 0.6**2 for found in (framed, moved)]
    assert tilts == pytest.approx([1.962 / 9.81] * 2, rel=0.02)
    assert moved == pytest.approx(framed, abs=1e-2 * np.abs(framed).max())


def test_what_moves_with_its_walls_is_at_rest_with_them(ran):
    """A channel that is carried along its period: the same as one that stands still, to rounding."""
    found = ran("""
space = { dimensions = 2, spacing = 0.1, periodic = ["x"], lower = [0.0, -0.4], upper = [2.0, 1.4] }
time.end = 0.5
physics.sound_speed = 20.0
fluids.water = { shape.box = { lower = [0.0, 0.0], upper = [2.0, 1.0] }, velocity = [1.7, 0.0], viscosity = 0.01 }
[walls.plates]
no_slip = true
motion.translation = [1.7, 0.0]
shape.union = [
  { box = { lower = [0.0, -0.3], upper = [2.0, 0.0] } },
  { box = { lower = [0.0, 1.0], upper = [2.0, 1.3] } },
]
""")
    first, last = by_id(found.frame(0)), by_id(found.frame(-1))
    assert last["velocity"] == pytest.approx(first["velocity"], abs=1e-10)
    way = last["position"] - first["position"] - [1.7 * 0.5, 0.0, 0.0][: first["position"].shape[1]]
    way[:, 0] -= 2.0 * np.rint(way[:, 0] / 2.0)
    assert np.abs(way).max() < 1e-10


COUETTE = """
space = { dimensions = 2, spacing = 0.05 }
parallel.axis = "x"
time.end = 3.0
physics.sound_speed = 10.0
output = { frames = 0.5 }
[fluids.oil]
viscosity = 0.2
shape.difference.from.disc = { center = [0.0, 0.0], radius = 1.0 }
shape.difference.minus = [{ disc = { center = [0.0, 0.0], radius = 0.5 } }]
[walls.outer]
no_slip = true
shape.difference.from.disc = { center = [0.0, 0.0], radius = 1.15 }
shape.difference.minus = [{ disc = { center = [0.0, 0.0], radius = 1.0 } }]
[walls.inner]
no_slip = true
motion.rotation = { speed = 2.0, center = [0.0, 0.0] }
shape.difference.from.disc = { center = [0.0, 0.0], radius = 0.5 }
shape.difference.minus = [{ disc = { center = [0.0, 0.0], radius = 0.3 } }]
"""


def test_flow_between_a_cylinder_that_turns_and_one_that_stands(ran):
    """u = (ω a²/(b² − a²)) (b²/r − r): Couette; the moment is that of its slope."""
    frame = ran(COUETTE).frame(-1)
    oil = frame["kind"] == 0
    x, v = frame["position"][oil][:, :2], frame["velocity"][oil][:, :2]
    r = np.hypot(*x.T)
    along = (x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0]) / r
    exact = 2.0 * 0.25 / 0.75 * (1.0 / r - r)
    assert np.sqrt(np.mean((along - exact) ** 2)) < 0.03 * exact.max()
    # Moment per length 2π μ r³ d(u/r)/dr = 4π μ ω a² b²/(b² − a²): from the slope of u/r by 1/r².
    slope, _ = np.polyfit(1.0 / r**2, along / r, 1)
    moment = 4.0 * math.pi * 1000.0 * 0.2 * slope
    assert moment == pytest.approx(4.0 * math.pi * 1000.0 * 0.2 * 2.0 * 0.25 / 0.75, rel=0.05)
