"""A kind of matter from a user's file beside kinds of psph that keep a table of the groups."""

import shutil
from pathlib import Path

import pytest
from guests.test_guests import begin

TANK = """
use = ["markers.py"]
space = { dimensions = 2, spacing = 0.05, periodic = ["x"], lower = [0.0, -0.2], upper = [1.0, 0.8] }
time.end = 1.0
physics.gravity = [0.0, -9.81]
physics.sound_speed = 40.0
fluids.water = { pressure = "hydrostatic", shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.6] } }
walls.floor.shape.box = { lower = [0.0, -0.2], upper = [1.0, 0.0] }
solids.block = { shape.box = { lower = [0.3, 0.2], upper = [0.7, 0.4] }, density = 1100.0, young = 1e6, poisson = 0.3 }
markers.dye.shape.box = { lower = [0.1, 0.1], upper = [0.25, 0.2] }
"""


@pytest.fixture
def beside_a_block(tmp_path):
    """Markers in water around an elastic block, begun."""
    shutil.copy(Path(__file__).parent / "markers.py", tmp_path)
    (tmp_path / "markers.toml").write_text(TANK)
    return begin(tmp_path / "markers.toml")


def test_tables_of_groups_count_those_that_kinds_add(beside_a_block):
    """A loop reads them by the group of a particle, whoever brought it."""
    materials = beside_a_block.plan.materials
    assert [one.name for one in materials.species] == ["water", "block", "floor", "dye"]
    groups = beside_a_block.store.shown("group")
    tables = {
        f"{type(work).__name__}.{name}": table
        for work in beside_a_block.engine.kinds
        for name, table in vars(work).items()
        if name in ("_moves", "_own", "_solid_of", "body_of") and len(table)
    }
    assert {"Immersion._moves", "Solids._solid_of"} <= tables.keys()
    assert {name: len(table) for name, table in tables.items()} == dict.fromkeys(tables, groups.max() + 1)
