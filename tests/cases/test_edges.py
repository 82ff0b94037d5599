"""A jet leaves a wall at a sharp edge: how much flows out of a slot in the floor of a tank."""

import math

import pytest
from drafts import draft
from gauging import start
from long import LONG

from psph.physics.fluid import correction, pressure
from psph.physics.fluid.parting import Holding

SLOT = """
space = {{ dimensions = 2, spacing = {dx} }}
time.end = 1.0
physics = {{ gravity = [0.0, -9.81], sound_speed = {c} }}
[fluids.water]
shape.box = {{ lower = [-0.5, 0.0], upper = [0.5, 0.6] }}
pressure = "hydrostatic"
[walls.tank.shape.difference]
from.box = {{ lower = [-0.56, -0.06], upper = [0.56, 0.9] }}
minus = [
    {{ box = {{ lower = [-0.5, 0.0], upper = [0.5, 0.9] }} }},
    {{ box = {{ lower = [-0.08, -0.06], upper = [0.08, 0.0] }} }},
]
[walls.catch.shape.difference]
from.box = {{ lower = [-0.56, -1.26], upper = [0.56, -0.06] }}
minus = [{{ box = {{ lower = [-0.5, -1.2], upper = [0.5, -0.06] }} }}]
"""
G, WIDE, LIP = 9.81, 0.16, 0.06


def discharge(folder, dx, c, begin, end):
    """Q/(w √(2gh)) between two times; h is the mean head over the outer edge of the slot."""
    simulation = start(draft(folder, SLOT.format(dx=dx, c=c)))
    left = []
    for until in (begin, end):
        while simulation.time < until:
            simulation.step(until)
        y, fluid = simulation.store.shown("position")[:, 1], simulation.store.shown("kind") == 0
        left.append(dx * dx * (fluid & (y > -LIP)).sum())
    head = sum(left) / 2.0 / 1.0 + LIP  # the tank is 1 m wide
    return (left[0] - left[1]) / (end - begin) / (WIDE * math.sqrt(2.0 * G * head))


def test_a_jet_parts_from_the_edge_of_a_slot(tmp_path, monkeypatch):
    """Eight spacings wide; theory 0.61 to 0.65.  The control, whose walls pull, misses the bound: by how much
    differs from processor to processor, since the jet sheds drops."""
    found = discharge(tmp_path, 0.02, 36.0, 0.25, 0.4)
    for room in (pressure, correction):
        monkeypatch.setattr(room, "hold_of", lambda scene: Holding())
    control = discharge(tmp_path, 0.02, 36.0, 0.25, 0.4)
    assert 0.60 < found < 0.75 < control, (found, control)


@LONG
@pytest.mark.parametrize("c", [36.0, 72.0])
def test_with_sixteen_spacings_it_is_that_of_theory_at_any_speed_of_sound(tmp_path, c):
    assert 0.60 < discharge(tmp_path, 0.01, c, 0.25, 0.35) < 0.68
