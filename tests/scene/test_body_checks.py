"""What `check` says of the numbers of bodies."""

import pytest
from drafts import TANK, draft

from psph.scene import Scene, check
from psph.scene.bodies import bodies_of, in_words

AFLOAT = (
    TANK
    + """
[bodies.raft]
shape.box = { lower = [0.3, 0.2], upper = [0.7, 0.6] }
density = 500.0
[bodies.buoy]
shape.box = { lower = [0.8, 0.8], upper = [1.1, 1.1] }
density = 400.0
"""
)
THIN = """
[bodies.board]
shape.box = {{ lower = [0.3, 0.2], upper = [0.7, {:g}] }}
density = 500.0
"""


@pytest.mark.parametrize(
    ("quiet", "override", "says"),
    [
        ("bodies.raft.inertia=0.14", "bodies.raft.inertia=0.13", "inertia: 0.13 kg m2 is less than its mass"),
        (
            "bodies.raft.pivot=[0.5, 5.5]",
            "bodies.raft.pivot=[0.5, 6.5]",
            "pivot: lies 5.9 m from bodies.raft",
        ),
        ("bodies.raft.centre=[0.5, 0.1]", "bodies.raft.centre=[0.5, -0.5]", "centre: lies 0.7 m from"),
    ],
)
def test_points_and_inertia_that_a_body_hardly_has_are_warned_of(tmp_path, quiet, override, says):
    """Below m dx²/6 = 0.133 kg m²; points farther away than the body is long, a pivot than ten times that."""

    def told(key):
        found = check(Scene(draft(tmp_path, AFLOAT, key)))
        return [line for line in found if "bodies." in line]

    assert told(quiet) == []
    [line] = told(override)
    assert says in line


def test_a_thin_body_is_told_both_cures(tmp_path):
    """A body of a given size does not grow thicker."""
    [line] = check(Scene(draft(tmp_path, TANK + THIN.format(0.4))))
    assert "bodies.board.shape: 2 layers of particles" in line
    assert line.endswith("make the body at least 3 spacings (0.3 m) thick, or space.spacing smaller")
    assert check(Scene(draft(tmp_path, TANK + THIN.format(0.5)))) == []


@pytest.mark.parametrize(
    ("shape", "says"),
    [
        (
            "box={lower=[0.2,0.5],upper=[0.53,0.83]}",
            "bodies.brick is 0.33 m wide along x, which is 6.6 spacings",
        ),
        ("disc={center=[0.52,0.52],radius=0.11}", "its particles fill 0.0425 m2 of the 0.038"),
        ("box={lower=[0.2,0.5],upper=[0.5,0.8]}", None),
    ],
)
def test_check_tells_of_bodies_that_the_lattice_makes_larger_or_smaller(tmp_path, shape, says):
    text = """
space = { dimensions = 2, spacing = 0.05 }
time.end = 1.0
physics.sound_speed = 20.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.4] }
"""
    lines = check(Scene(draft(tmp_path, text, f"bodies.brick={{shape={{{shape}}},density=500.0}}")))
    found = [line for line in lines if "bodies.brick" in line and ("wide along x" in line or "fill" in line)]
    assert len(found) == (says is not None) and all(says in line for line in found), lines


BED = """
space = { dimensions = 2, spacing = 0.1 }
time.end = 1.0
physics.gravity = [0.0, -9.81]
[soils.sand]
density = 2000.0
young = 1e6
poisson = 0.3
friction_angle = 30.0
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.4] }
[bodies.block]
density = 500.0
shape.box = { lower = [0.3, 0.4], upper = [0.7, 0.8] }
"""


@pytest.mark.parametrize(
    "text, says", [(AFLOAT, "0.5 of the fluid's density"), (BED, "0.25 of the soil's density")]
)
def test_the_density_of_a_body_is_told_over_that_of_what_it_meets(tmp_path, text, says):
    scene = Scene(draft(tmp_path, text))
    assert says in in_words(scene, next(iter(bodies_of(scene.census))))
