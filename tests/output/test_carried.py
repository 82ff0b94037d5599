"""Gauges that go with the wall or body that they are fixed to."""

import math

import numpy as np
import pytest
from drafts import TANK, draft, refusal
from gauging import readings, started
from long import LONG

from psph.output.gauges.carried import Carrier
from psph.output.gauges.level import stretches
from psph.scene import Scene, check

ON_THE_TANK = """
[gauges.side.sensor]
position = [1.0, 0.2]
axis = "x"
diameter = 0.2
{with_it}
[gauges.inside.point]
position = [0.3, 0.15]
{with_it}
[gauges.line.level]
foot = [0.23, 0.0]
top = [0.23, 0.7]
{with_it}
"""
WITH_IT = 'moves_with = "tank"'


def ridden(folder, with_it, overrides, steps):
    """The readings of a tank after so many steps, and the time then."""
    simulation, scene = started(draft(folder, TANK + ON_THE_TANK.format(with_it=with_it), *overrides), steps)
    return readings(simulation, scene), simulation.time


@LONG
def test_gauges_on_a_tank_that_goes_by_read_what_they_read_at_rest(tmp_path):
    sound = "physics.sound_speed=30.0"
    rest, time = ridden(tmp_path, "", (sound,), 80)
    going = (sound, "walls.tank.motion={translation=[0.8,0.5]}", "fluids.water.velocity=[0.8,0.5]")
    carried, then = ridden(tmp_path, WITH_IT, (*going, f"time.step={time / 80}"), 80)
    left, _ = ridden(tmp_path, "", (*going, f"time.step={time / 80}"), 80)
    assert then == pytest.approx(time) and 0.8 * time > 0.05
    assert rest["side.pressure"] > 1000.0
    assert carried["line.wetted"] == pytest.approx(rest["line.wetted"], rel=2e-3)
    for column in ("side.pressure", "inside.pressure", "line.level"):
        assert carried[column] == pytest.approx(rest[column], rel=2e-3), column
        assert abs(left[column] / rest[column] - 1.0) > 0.02, column  # the control: it stays in space
    # The velocity is that in space.
    assert carried["inside.velocity_x"] == pytest.approx(rest["inside.velocity_x"] + 0.8, abs=1e-3)


def test_gauges_on_a_tank_that_rolls_read_what_they_read_in_a_frame_that_rolls(tmp_path):
    roll = "motion={sinusoid={angle=0.15,period=0.8,center=[0.5,-0.6]},ramp=0.4}"
    common = ("physics.sound_speed=30.0", "fluids.water.viscosity=1e-3", "time.step=5e-4")
    steps = 600  # 0.3 s: the tank is turned by 0.08 rad
    framed, _ = ridden(tmp_path, "", (*common, f"frame.{roll}"), steps)
    carried, _ = ridden(tmp_path, WITH_IT, (*common, f"walls.tank.{roll}"), steps)
    left, _ = ridden(tmp_path, "", (*common, f"walls.tank.{roll}"), steps)
    for column in ("side.pressure", "inside.pressure", "line.level"):
        assert carried[column] == pytest.approx(framed[column], rel=1e-3), column
        assert abs(left[column] / framed[column] - 1.0) > 0.03, column  # the control


def test_points_on_a_body_are_those_of_the_body(tmp_path):
    text = (
        TANK
        + """
[bodies.brick]
shape.box = { lower = [0.3, 0.9], upper = [0.7, 1.2] }
density = 600.0
spin = 3.0
velocity = [0.4, 0.2]
[gauges.corner.point]
position = [0.3, 0.9]
moves_with = "brick"
"""
    )
    simulation, _ = started(draft(tmp_path, text), 60)
    bodies = simulation.engine.of("bodies").bodies
    [there] = Carrier(2).places(simulation, np.array([[0.3, 0.9]]))
    assert there == pytest.approx(bodies.at(0, np.array([0.3, 0.9, 0.0]))[0][:2], abs=1e-13)
    assert math.dist(there, (0.3, 0.9)) > 0.02


@pytest.mark.parametrize(
    "kind",
    [
        "sensor={position=[1.0,0.2],axis='x',diameter=0.1,",
        "point={position=[0.5,0.2],",
        "level={foot=[0.5,0.0],top=[0.5,0.6],",
    ],
)
def test_what_carries_nothing_is_refused(tmp_path, kind):
    [unknown] = refusal(tmp_path, TANK, f"gauges.a.{kind}moves_with='tnak'}}")
    assert f"gauges.a.{kind.partition('=')[0]}.moves_with: " in unknown and "no wall or body" in unknown
    assert "tank" in unknown
    [still] = refusal(tmp_path, TANK, f"gauges.a.{kind}moves_with='tank'}}")
    assert "this wall stands still; give it a motion, or remove moves_with" in still


def test_a_gauge_within_what_carries_it_is_warned_of(tmp_path):
    sway = "walls.tank.motion={sinusoid={amplitude=[0.01,0.0],period=1.0}}"
    for y, buried in ((-0.15, 1), (0.1, 0)):
        asked = f"gauges.a.point={{position=[0.5,{y}],moves_with='tank'}}"
        found = [line for line in check(Scene(draft(tmp_path, TANK, sway, asked))) if "gauges.a" in line]
        assert len(found) == buried and all("lies in a wall" in line for line in found)


ROUND = """
scheme = "sph"
space = { dimensions = 2, spacing = 0.1, periodic = ["x"], lower = [0.0, 0.0], upper = [2.0, 2.0] }
time.end = 1.0
physics.sound_speed = 30.0
[fluids.part]
shape.box = { lower = [0.0, 0.4], upper = [1.5, 1.2] }
[gauges.long.level]
foot = [0.05, 0.8]
top = [3.95, 0.8]
[gauges.short.level]
foot = [0.05, 0.8]
top = [0.85, 0.8]
"""


def test_a_line_may_be_longer_than_a_period(tmp_path):
    read = readings(*started(draft(tmp_path, ROUND)))
    # Twice around, over the 1.5 m of fluid each time, less the 0.05 m before the foot.
    assert read["long.wetted"] == pytest.approx(2.95, abs=0.005)
    assert read["short.wetted"] == pytest.approx(0.8, rel=1e-9)
    assert list(stretches((0.1, 0.0), 30, 0.29, (2.0, None))) == [(0, 8), (8, 16), (16, 24), (24, 31)]
    assert list(stretches((0.1, 0.0), 30, 0.3, (None, 0.9))) == [(0, 31)]
