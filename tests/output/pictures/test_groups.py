"""Pictures count groups as scenes do: psph.output.pictures.groups."""

import tomllib
from pathlib import Path

import pytest
from drafts import draft

from psph.case import load
from psph.output.pictures.groups import first_wall, first_whole
from psph.output.pictures.mirrors import mirrors_of
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
    assert first_whole(told) == (parts.bodies.start or len(parts))


def test_a_mirror_before_soil_alone_is_drawn(tmp_path):
    """As one before a fluid is; below the ground there is the wall that mirrors it."""
    sand = "[soils.sand]\nshape.box = { lower = [0.0, 0.0], upper = [1.0, 0.5] }\ndensity = 1600.0\n"
    sand += "young = 1e6\npoisson = 0.3\nfriction_angle = 30.0\n"
    floor = '[walls.floor]\nshape.box = { lower = [-0.3, -0.3], upper = [1.3, 0.0] }\ncondition = "mirror"\n'
    space = "[space]\ndimensions = 2\nspacing = 0.1\n[time]\nend = 1.0\n[physics]\ngravity = [0.0, -9.8]\n"
    told = tomllib.loads(draft(tmp_path, space + sand + floor).to_toml())
    assert mirrors_of(told) == [(1, 0.0)]
