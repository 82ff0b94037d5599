"""A scene that drifts, or that is far from the origin, does the same."""

import copy

import numpy as np
import pytest
from invariances.running import after, begun, matched
from invariances.scenes import DX, SCENES
from invariances.transforms import Shift
from long import long_but_for

SHORT = ("plain",)
"""The rest is long."""

MOVED = (
    "plain",
    "placed shapes",
    "solid",
    "rubber",
    "metal",
    "updated",
    "solids that meet",
    "soil",
    "body on soil",
    "smooth body on soil",
    "body and solid",
    "mud by bingham",
    "extrapolated",
    "layers under tension",
    "water that sticks",
)
"""A scene of each kind of matter, and walls that show a pressure of their own, and tensions."""

HELD = (
    "body in a surface",
    "jointed bodies",
    "moored bodies",
    "chained bodies",
    "moored bodies on wet soils",
)
"""Scenes with mirrors, hinges, joints and lines to places in space: what drifts would leave them."""

NO_SHIFT = {"position_shift": "off"}
"""Its size is bounded by the largest speed, which drifts: docs/limits.md says by how much that tells."""

DRIFT, FAR = Shift(drift=(5.0, -3.0)), Shift(way=(1e5, -1e5))
STEPS = 30


def with_step(tables, folder, drifts):
    """The scene with a fixed step, half of its longest at the start: speeds have no part in it then."""
    found = copy.deepcopy(tables)
    if drifts and "scheme" not in tables and "solids" not in tables:
        found["physics"] = {**found.get("physics", {}), **NO_SHIFT}
    simulation = begun(found, folder)
    step, _ = simulation.plan.longest_step(simulation.speed, simulation.acceleration)
    found["time"]["step"] = 0.5 * step
    return found


def differences(name, shift: Shift, folder) -> dict[str, float]:
    """By how much a scene that is moved differs from it after some steps."""
    tables = with_step(SCENES[name], folder, any(shift.drift))
    one, other = after(tables, folder, STEPS), after(shift.of(tables), folder, STEPS)
    rows = matched(one, other, one.start + shift.way)
    speed, pressure = np.abs(one.velocity).max(), max(np.abs(one.pressure).max(), 1e-9)
    return {
        "position": np.abs(shift.points(one.position, one.time) - other.position[rows]).max() / DX,
        "velocity": np.abs(one.velocity + shift.drift - other.velocity[rows]).max() / speed,
        "pressure": np.abs(one.pressure - other.pressure[rows]).max() / pressure,
    }


@pytest.mark.parametrize("name", long_but_for(SHORT, MOVED))
def test_a_scene_that_drifts_does_the_same(tmp_path, name):
    """Places after some steps are rounded a hundred times as coarsely as their changes."""
    found = differences(name, DRIFT, tmp_path)
    assert {what: size for what, size in found.items() if not size < 1e-9} == {}


@pytest.mark.parametrize("name", long_but_for(SHORT, (*MOVED, *HELD)))
def test_a_scene_far_from_the_origin_does_the_same(tmp_path, name):
    """At 1e5 m, 800,000 spacings, a place is rounded to 1e-10 of a spacing, a hundredth of a pascal."""
    found = differences(name, FAR, tmp_path)
    assert {what: size for what, size in found.items() if not size < 1e-5} == {}
