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
