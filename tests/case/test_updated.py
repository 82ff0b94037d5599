"""What updated Lagrangian solids can have beside them, and what not."""

import pytest
from drafts import draft, refusal

from psph.scene import Scene

BLOCK = """
scheme = "solid"
time.end = 1.0
space = { dimensions = 2, spacing = 0.1 }
[solids.block]
description = "updated"
shape.box = { lower = [0.0, 0.0], upper = [1.0, 1.0] }
clamped.box = { lower = [0.0, 0.0], upper = [0.3, 1.0] }
velocity = [1.0, 0.0]
density = 1000.0
young = 1e6
poisson = 0.25
"""


def test_the_parts_of_such_a_solid(tmp_path):
    scene = Scene(draft(tmp_path, BLOCK))
    moving, held = scene.species
    assert (
        scene.layout.names == ("block", "block (clamped)")
        and scene.layout.parts[1].key == "solids.block.clamped"
    )
    assert moving.mobile and not held.mobile and moving.shear_modulus == held.shear_modulus == 4e5
    assert scene.census.counts.sum() == 100 and scene.speeds.velocities[1] == (0.0, 0.0)
    assert scene.sound_speed == pytest.approx((1.2e6 / 1000.0) ** 0.5)
    assert not scene.starts.materials and moving.bonded is held.bonded is None


@pytest.mark.parametrize(
    ("more", "says"),
    [
        ("solids.block.hourglass=0.1", "solids.block.hourglass"),
        ('solids.block.law="neo-hookean"', "solids.block.law"),
        ("scheme=stable", 'scheme: "stable": brings physics.local_potential, physics.tension_floor, '),
        ("physics.pressure_gradient=difference", "physics.pressure_gradient"),
        ("physics.contact={}", "physics.contact"),
        ("anvils.floor={at=[0.0, 0.0], normal=[0.0, 1.0]}", "solids.block.description"),
        (
            "fluids.water={shape={box={lower=[2.0, 0.0], upper=[3.0, 1.0]}}, density=1000.0}",
            "fluids: nothing is known of updated Lagrangian solids beside fluids",
        ),
    ],
)
def test_what_is_refused(more, says, tmp_path):
    assert any(says in line for line in refusal(tmp_path, BLOCK, more))


def test_beside_water_its_scheme_says_nothing_more(tmp_path):
    water = "fluids.water={shape={box={lower=[2.0, 0.0], upper=[3.0, 1.0]}}}"
    [line] = refusal(tmp_path, BLOCK, water, "scheme=stable")
    assert "fluids: nothing is known" in line
    lines = refusal(
        tmp_path, BLOCK, water, "scheme=stable", "physics.pair_damping=0.3", "physics.position_shift=0.2"
    )
    assert len(lines) == 2 and "physics.position_shift" in lines[1]


def test_both_descriptions_in_one_case_are_refused(tmp_path):
    both = BLOCK + BLOCK[BLOCK.index("[solids.block]") :].replace("solids.block", "solids.other").replace(
        "updated", "total"
    ).replace("0.0, 0.0], upper = [1", "2.0, 0.0], upper = [3").replace("clamped.box", "#")
    assert any("beside solids that are total" in line for line in refusal(tmp_path, both))


def test_a_gradient_of_another_dimension_is_told_once_of_the_table_that_has_it(tmp_path):
    """Not as one of a fluid, which the case has not."""
    [line] = refusal(tmp_path, BLOCK, "solids.block.velocity_gradient=[[0.0, 1.0]]")
    assert "solids.block.velocity_gradient: [[0.0, 1.0]]: 1 row in a case with" in line
