"""Whether a fluid that is closed in at the start can have a free surface: psph.scene.fluid.opening."""

import pytest
from drafts import draft

from psph.scene import Scene

CASE = """
space = {{ dimensions = 2, spacing = 0.05, lower = [-1.0, -1.0], upper = [3.0, 3.0] }}
time.end = 2.0
physics = {{ gravity = [0.0, -9.81], sound_speed = 60.0 }}
[fluids.water]
shape.{water}
{walls}
"""
POOL = "box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }"
TANK = """
[walls.tank.shape.difference]
from.box = { lower = [-0.2, -0.2], upper = [1.2, 1.4] }
minus = [{ box = { lower = [0.0, 0.0], upper = [1.0, 1.4] } }]
"""
LID = TANK + "[walls.lid]\nshape.box = { lower = [-0.0, 0.5], upper = [1.0, 0.7] }\n"
LONG_LID = """
[walls.tank.shape.difference]
from.box = { lower = [-0.2, -0.2], upper = [1.2, 0.5] }
minus = [{ box = { lower = [0.0, 0.0], upper = [1.0, 0.5] } }]
[walls.lid]
shape.box = { lower = [-0.8, 0.5], upper = [1.2, 0.7] }
"""
DRUM = """
[walls.drum.shape.difference]
from.box = { lower = [-0.2, -0.2], upper = [1.2, 1.2] }
minus = [{ box = { lower = [0.0, 0.0], upper = [1.0, 1.0] } }]
"""
FULL = "box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }"
WHEEL = """
[walls.wheel]
shape.box = { lower = [0.2, 0.45], upper = [0.8, 0.55] }
motion.rotation = { speed = 1.7, center = [0.5, 0.5] }
"""
AROUND = (
    f"difference = {{ from.{FULL}, minus = [{{ box = {{ lower = [0.2, 0.45], upper = [0.8, 0.55] }} }}] }}"
)
SPUN = "[walls.drum.motion.rotation]\nspeed = 1.7\ncenter = [0.5, 0.5]\n"


def opens_in(folder, water, walls):
    """Whether the fluid of a scene has a free surface, or can have one."""
    return Scene(draft(folder, CASE.format(water=water, walls=walls))).has_free_surface


@pytest.mark.parametrize(
    ("water", "walls", "opens"),
    [
        (POOL, LID, False),
        (POOL, LID + "motion = { translation = [0.0, 0.2], ramp = 0.1 }\n", True),
        (POOL, LID + "motion = { translation = [0.0, 0.01] }\n", False),  # 0.02 m: less than half a layer
        (POOL, LID + "motion = { translation = [0.0, -0.02] }\n", False),  # pressed on
        (POOL, LONG_LID + "motion = { translation = [0.3, 0.0] }\n", False),  # along itself
        (POOL, LONG_LID + "motion = { translation = [0.6, 0.0] }\n", True),  # past the rim
        (FULL, DRUM + SPUN, False),
        (FULL, DRUM + SPUN.replace("[0.5, 0.5]", "[0.0, 0.0]"), False),  # about a corner
        (AROUND, DRUM + WHEEL, False),
        (
            AROUND,
            DRUM + WHEEL.replace("walls.wheel", "bodies.wheel").split("motion")[0] + "density = 500.0\n",
            False,
        ),
        (POOL, LID.replace("walls.lid", "bodies.lid") + "density = 500.0\n", True),  # a lid that floats
    ],
    ids=[
        "closed",
        "lifted",
        "hardly",
        "pressed",
        "slides",
        "passes",
        "drum",
        "round",
        "wheel",
        "body",
        "floats",
    ],
)
def test_what_opens_and_what_does_not(tmp_path, water, walls, opens):
    """The first frame alone called all of these closed."""
    assert opens_in(tmp_path, water, walls) == opens


def test_a_gate_that_swings_away_opens(tmp_path):
    """It turns as the drum does, about a point beside the fluid."""
    gate = "[walls.gate]\nshape.box = { lower = [1.0, 0.0], upper = [1.2, 1.0] }\n"
    open_side = DRUM.replace("upper = [1.0, 1.0]", "upper = [1.2, 1.0]")
    assert not opens_in(tmp_path, FULL, open_side + gate)
    assert opens_in(
        tmp_path, FULL, open_side + gate + "motion.rotation = { speed = 0.5, center = [1.2, 1.0] }\n"
    )
