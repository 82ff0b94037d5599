"""A scene that is turned by a quarter, mirrored, or whose axes are exchanged does the same, to rounding."""

import numpy as np
import pytest
from invariances.running import after, matched
from invariances.scenes import DX, SCENES
from invariances.transforms import TURNS_OF_A_SCENE, Turn
from long import LONG

SHORT = ("dry floor", "tank")
"""The rest is long."""

ROUNDING = 1e-10
"""Of places in spacings, and of what else there is over its largest."""

STEPS = 40


def differences(tables, turn: Turn, folder, steps=STEPS) -> dict[str, float]:
    """By how much a scene that is turned differs from it after some steps, turned."""
    one, other = after(tables, folder, steps), after(turn.of(tables), folder, steps)
    rows = matched(one, other, turn.points(one.start))
    places = turn.points(one.position) - other.position[rows]
    speeds = turn.directions(one.velocity) - other.velocity[rows]
    assert np.abs(one.position - one.start).max() > 0.05 * DX
    return {
        "position": np.abs(places).max() / DX,
        "velocity": np.abs(speeds).max() / np.abs(one.velocity).max(),
        "pressure": np.abs(one.pressure - other.pressure[rows]).max() / max(np.abs(one.pressure).max(), 1e-9),
        "density": np.abs(one.density - other.density[rows]).max() / one.density.max(),
        "time": abs(one.time - other.time) / one.time,
    }


@pytest.mark.parametrize("turn", TURNS_OF_A_SCENE)
@pytest.mark.parametrize("name", [n if n in SHORT else pytest.param(n, marks=LONG) for n in SCENES])
def test_a_scene_that_is_turned_does_the_same(tmp_path, name, turn):
    found = differences(SCENES[name], TURNS_OF_A_SCENE[turn], tmp_path)
    assert {what: size for what, size in found.items() if not size < ROUNDING} == {}


def test_a_gravity_that_is_not_turned_is_seen(tmp_path):
    """The control."""
    turn = TURNS_OF_A_SCENE["a quarter"]
    other = turn.of(SCENES["tank"]) | {"physics": SCENES["tank"]["physics"]}
    one, other = after(SCENES["tank"], tmp_path, STEPS), after(other, tmp_path, STEPS)
    rows = matched(one, other, turn.points(one.start))
    assert np.abs(turn.points(one.position) - other.position[rows]).max() > 0.1 * DX
