"""Streams through finer regions that rest, beside what rests too."""

import math

import pytest
from cases.test_refined import leading
from drafts import draft
from gauging import start

from psph.simulation import levels

CHANNEL = """
time.end = 2.0
[space]
dimensions = 2
spacing = 0.04
periodic = ["x"]
lower = [0.0, -0.2]
upper = [2.4, 1.2]
refine = [{ shape.box = { lower = [0.8, -0.2], upper = [1.6, TOP] } }]
[physics]
gravity = [0.0, -9.81]
sound_speed = 40.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [2.4, 0.8] }
pressure = "hydrostatic"
velocity = [0.3, 0.0]
[walls.floor]
shape.box = { lower = [0.0, -0.2], upper = [2.4, 0.0] }
"""
"""Water that streams over a floor without friction, through a region down from ``TOP``: exactly it goes on."""


def streamed(folder, top):
    """Its speed after 2 s, and across it the root mean square, m/s."""
    simulation = start(draft(folder, CHANNEL.replace("TOP", f"{top:g}")))
    while simulation.time < 2.0:
        simulation.step(2.0)
    _, v, _, m, _ = leading(simulation)
    return (m @ v[:, 0]) / m.sum(), math.sqrt((m @ v[:, 1] ** 2) / m.sum())


@pytest.mark.parametrize("top", [0.4, 2.0])
def test_a_stream_through_a_region_is_neither_stirred_nor_slowed(tmp_path, top):
    speed, across = streamed(tmp_path, top)
    assert speed == pytest.approx(0.3, abs=0.001) and across < 0.002


def test_shifts_as_large_as_the_stream_is_fast_stir_it(tmp_path, monkeypatch):
    """The control: 7 mm/s across, and 1 % slower."""
    monkeypatch.setattr(levels.Resizing, "uneven", lambda self: math.inf)
    speed, across = streamed(tmp_path, 2.0)
    assert across > 0.005 and speed < 0.298


ALONG = """
time.end = 1.2
[space]
dimensions = 2
spacing = 0.04
periodic = ["x", "y"]
lower = [0.0, 0.0]
upper = [1.2, 0.8]
refine = [{ shape.box = { lower = [0.5, BELOW], upper = [0.8, 0.5] } }]
[physics]
sound_speed = 12.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.2, 0.8] }
velocity = [1.0, 0.0]
"""
"""A stream of all water, along borders on rows of coarse particles or between them."""


@pytest.mark.parametrize("below", [0.3, 0.31, 0.32])
def test_mass_that_leads_of_a_stream_along_a_border_is_exact(tmp_path, below):
    """Shifts as large as the stream is fast had the coarse row on a border, or its finer ones, lead twice: 2 %."""
    simulation = start(draft(tmp_path, ALONG.replace("BELOW", f"{below:g}")))
    while simulation.time < 1.2:
        simulation.step(1.2)
        assert leading(simulation)[3].sum() == pytest.approx(960.0, rel=1e-9)


TANK = """
time.end = 1.0
[space]
dimensions = 2
spacing = 0.04
lower = [-0.6, -0.2]
upper = [2.6, 1.0]
refine = [{ shape.box = { lower = [0.6, -0.2], upper = [1.2, 1.0] } }]
[physics]
gravity = [0.0, -9.81]
sound_speed = 40.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.6, 0.6] }
pressure = "hydrostatic"
velocity = [SPEED, 0.0]
[walls.tank]
shape.difference.from.box = { lower = [-0.2, -0.2], upper = [1.8, 0.8] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [1.6, 1.0] } }]
motion = { translation = [SPEED, 0.0] }
"""
"""A tank whose water goes with it, through a region that rests; nobody asks for the push on it."""


def stirred(folder, speed):
    """The root mean square of the velocity beside that of the tank after 1 s, m/s."""
    simulation = start(draft(folder, TANK.replace("SPEED", f"{speed:g}")))
    while simulation.time < 1.0:
        simulation.step(1.0)
    _, v, _, m, _ = leading(simulation)
    return math.sqrt((m @ ((v - [speed, 0.0]) ** 2).sum(axis=1)) / m.sum())


def test_a_tank_that_goes_by_a_region_is_as_still_as_one_at_rest(tmp_path, monkeypatch):
    """The control: shifts as large as the tank is fast stir its water, by 6 mm/s after 1 s."""
    assert stirred(tmp_path, 0.3) < 0.002
    monkeypatch.setattr(levels.Resizing, "uneven", lambda self: math.inf)
    assert stirred(tmp_path, 0.3) > 0.005


DAM = """
time.end = 0.1
[space]
dimensions = 3
spacing = 0.05
SIDES
lower = [-0.2, 0.0, -0.2]
upper = [1.0, 0.55, 0.8]
refine = [{ shape.box = { lower = [0.3, 0.0, -0.2], upper = [0.7, 0.55, 0.3] } }]
[physics]
gravity = [0.0, 0.0, -9.81]
sound_speed = 30.0
[fluids.water]
shape.box = { lower = [0.0, 0.0, 0.0], upper = [0.5, 0.55, 0.4] }
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = { lower = [-0.2, 0.0, -0.2], upper = [1.0, 0.55, 0.6] }
shape.difference.minus = [{ box = { lower = [0.0, -1.0, 0.0], upper = [0.8, 1.55, 1.0] } }]
"""


def test_an_axis_along_which_nothing_flows_changes_no_shift(tmp_path):
    """A dam break that is drawn out along an axis that repeats, and between two mirrors."""
    energies = []
    for sides in ('periodic = ["y"]', 'symmetry = ["y.lower", "y.upper"]'):
        simulation = start(draft(tmp_path, DAM.replace("SIDES", sides)))
        while simulation.time < 0.1:
            simulation.step(0.1)
        _, v, _, m, _ = leading(simulation)
        energies.append(0.5 * (m @ (v**2).sum(axis=1)))
    assert energies[0] == pytest.approx(energies[1], rel=1e-4)
