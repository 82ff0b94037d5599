"""Paddles that take up waves that come back."""

import numpy as np
import pytest
from drafts import draft
from gauging import start

from psph.fields import FLUID
from psph.matter.wall import measure_levels
from psph.simulation.stages import stages_of

FLUME = """
space = { dimensions = 2, spacing = 0.02 }
time.end = 10.0
physics.gravity = [0.0, -9.81]
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.2] }
pressure = "hydrostatic"
velocity = [0.1, 0.0]
[walls.flume]
shape.union = [
  { box = { lower = [-0.3, -0.06], upper = [1.06, 0.0] } },
  { box = { lower = [1.0, 0.0], upper = [1.06, 0.4] } },
]
[walls.paddle]
shape.box = { lower = [-0.06, 0.0], upper = [0.0, 0.4] }
motion = { piston = { height = 0.02, period = 1.5, depth = 0.2 ABSORB }, start = 9.0, ramp = 0.1 }
"""
"""Water that runs to and fro; its paddle makes no waves before 9 s."""


def begun(folder, absorb):
    """A simulation of the flume."""
    return start(draft(folder, FLUME.replace("ABSORB", absorb)))


def energy(simulation):
    """Of the motion of the water, J."""
    store = simulation.store
    fluid = store.owned_rows("kind") == FLUID
    return 0.5 * float((store.shown("mass")[fluid, None] * store.owned_rows("velocity")[fluid] ** 2).sum())


def gone(simulation, end):
    """The largest energy in the last half second before ``end``, s."""
    found = []
    while simulation.time < end:
        simulation.step(end)
        if simulation.time > end - 0.5:
            found.append(energy(simulation))
    return max(found)


def test_a_paddle_that_absorbs_takes_up_a_wave_that_another_sends_back(tmp_path):
    """Until the wave has come to both ends: 1 m at 1.4 m/s each way."""
    plain, absorbing = (begun(tmp_path, absorb) for absorb in ("", ", absorb = { reach = 0.2 }"))
    assert energy(plain) == energy(absorbing)
    left, rest = (gone(one, 2.5) for one in (plain, absorbing))
    assert rest < 0.1 * left
    moved = absorbing.engine.of("paddles").corrections[0].shift
    assert 0.0 < abs(moved) < 0.2


def test_what_does_not_absorb_measures_and_keeps_nothing(tmp_path):
    plain, absorbing = (begun(tmp_path, absorb) for absorb in ("", ", absorb = {}"))
    runs = [[stage.run for stage in stages_of(one.plan)] for one in (absorbing, plain)]
    assert [measure_levels in each for each in runs] == [True, False]
    assert set(absorbing.state()["poses"]) == {"levels_at_rest", "corrections"}
    assert plain.state()["poses"] == {} and plain.engine.of("paddles") is None
    assert plain.plan.arrays == absorbing.plan.arrays


def test_the_level_at_the_face_is_that_of_the_water(tmp_path):
    paddles = begun(tmp_path, ", absorb = {}").engine.of("paddles")
    assert paddles.state()["levels_at_rest"] == pytest.approx([0.2], abs=0.005)
    [face] = paddles._faces
    gauge = face.gauge(0.05)
    assert gauge.foot == pytest.approx((0.05 + face.ahead, 0.0)) and gauge.top[1] == pytest.approx(0.4)
    assert face.ahead == pytest.approx(2.8 * 0.02)


def test_a_paddle_stands_where_its_stroke_and_its_correction_have_it(tmp_path):
    simulation = begun(tmp_path, ", absorb = {}")
    for _ in range(30):
        simulation.step()
    [own] = simulation.engine.of("paddles").corrections
    store = simulation.store
    paddle = store.shown("group") == 2
    moved = store.shown("position")[paddle] - store.shown("anchor")[paddle]
    assert own.shift != 0.0 and moved == pytest.approx(np.tile([own.shift, 0.0], (len(moved), 1)), abs=1e-15)
    assert store.shown("velocity")[paddle][:, 0] == pytest.approx(own.speed, rel=1e-12)
