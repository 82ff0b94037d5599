"""Pictures count groups as scenes do: psph.output.pictures.groups."""

import tomllib
from pathlib import Path

import pytest

from psph.case import load
from psph.output.pictures.groups import first_body, first_wall
from psph.scene import Scene

CASES = Path("run/cases")
OF_ALL_MATTER = (
    *("dam_break", "floating_box", "soils/round_column", "soils/submerged_slide", "solids/gate"),
    *("solids/ball_through_plate", "solids/rings", "solids/cantilever", "solids/shaken_plate"),
)


@pytest.mark.parametrize("name", OF_ALL_MATTER)
def test_walls_and_bodies_come_after_all_that_forces_move_and_its_clamps(name):
    case = load(CASES / f"{name}.toml")
    parts, told = Scene(case).layout.parts, tomllib.loads(case.to_toml())
    assert first_wall(told) == (parts.boundaries.start or len(parts)) > 0
    assert first_body(told) == (parts.bodies.start or len(parts))
