"""A rigid body that is forced into another ends the run, in one line; so do elastic solids."""

import numpy as np
import pytest
from mpi4py import MPI
from runs.guarded import boxed, started

from psph.case import load
from psph.output.errors import together
from psph.physics.solid.contact import REACH
from psph.simulation.solid_overlap import filled, whole

RAM = (
    "bodies.ram={shape={box={lower=[1.2,1.2],upper=[1.5,1.5]}},density=2000.0,free=[],"
    "motion={translation=[0.0,-2.0]}}"
)


def test_a_body_forced_into_a_wall_ends_the_run(tmp_path):
    trouble, _ = started(boxed(tmp_path, MPI.COMM_WORLD, RAM), tmp_path / "run", MPI.COMM_WORLD)
    assert "the run has a body inside another at step 100" in str(trouble)
    assert "bodies.ram is " in str(trouble) and "m inside walls.frame (guards.overlap = 1)" in str(trouble)


@pytest.mark.parametrize("key", ["guards.overlap=5.0", "guards.on_trouble=warn"])
def test_one_that_is_meant_to_goes_on(tmp_path, key):
    case = boxed(
        tmp_path, MPI.COMM_WORLD, RAM, key, "time.end=0.26", "guards.density=9.0", "guards.depth=9.0"
    )
    trouble, said = started(case, tmp_path / "run", MPI.COMM_WORLD)
    assert trouble is None and any("guards.overlap was exceeded" in line for line in said) == ("warn" in key)


BLOCKS = """
title = "Two blocks"
time.end = 0.15
output = { frames = 0.15, log = 0.05 }
[space]
dimensions = 2
spacing = 0.1
[physics]
contact = { stiffness = 1e-3 }
[solids.left]
shape.box = { lower = [0.0, 0.0], upper = [0.8, 0.8] }
density = 1200.0
young = 2.0e6
poisson = 0.3
velocity = [5.0, 0.0]
[solids.right]
shape.box = { lower = [0.9, 0.05], upper = [1.7, 0.85] }
density = 900.0
young = 3.0e6
poisson = 0.3
"""


def meeting(folder, *sets):
    path = folder / "blocks.toml"
    with together(MPI.COMM_WORLD, path):
        path.write_text(BLOCKS)
    return started(load(path, sets), folder / "run", MPI.COMM_WORLD)


def test_elastic_solids_inside_each_other_end_the_run(tmp_path):
    trouble, _ = meeting(tmp_path)
    assert "the run has a body inside another at step 100" in str(trouble)
    assert "is inside another solid, a body or a wall (guards.overlap = 1)" in str(trouble)
    assert "of solids.left" in str(trouble) or "of solids.right" in str(trouble)


def test_those_that_bounce_go_on(tmp_path):
    assert meeting(tmp_path, "physics.contact.stiffness=1.0")[0] is None


DROPPED = """
title = "A small body"
time.end = 0.25
output = { frames = 0.25, log = 0.05 }
[space]
dimensions = 2
spacing = 0.1
[physics]
contact = { stiffness = 1e-3 }
[solids.block]
shape.box = { lower = [0.0, 0.0], upper = [0.8, 0.8] }
density = 1200.0
young = 2.0e6
poisson = 0.3
[bodies.bullet]
shape.box = { lower = [-0.4, 0.3], upper = [-0.1, 0.6] }
density = 3000.0
velocity = [3.0, 0.0]
"""
"""A body three particles wide is shot into a block: it fills no neighbourhood of that, but that its own."""


def test_a_small_body_inside_an_elastic_solid_ends_the_run(tmp_path):
    path = tmp_path / "bullet.toml"
    with together(MPI.COMM_WORLD, path):
        path.write_text(DROPPED)
    trouble, _ = started(load(path), tmp_path / "run", MPI.COMM_WORLD)
    assert "the run has a body inside another at step 100" in str(trouble)
    assert "of bodies.bullet is inside another solid, a body or a wall (guards.overlap = 1)" in str(trouble)
    assert started(load(path, ["physics.contact.stiffness=1.0"]), tmp_path / "run", MPI.COMM_WORLD)[0] is None


def test_a_lattice_before_a_plane_is_that_part_of_a_whole_one():
    for dimensions in (2, 3):
        axis = np.arange(-4, 5) + 0.3
        sites = np.stack(np.meshgrid(*[axis] * dimensions), axis=-1).reshape(-1, dimensions)
        weight = np.maximum(1.0 - (sites**2).sum(axis=1) / REACH**2, 0.0)
        assert weight.sum() == pytest.approx(whole(dimensions), rel=0.03)
        for depth in (0.2, 1.2):  # the face is half a spacing before a row
            seen = weight[sites[:, 0] > -depth].sum() / weight.sum()
            assert seen == pytest.approx(filled(depth / REACH, dimensions), abs=0.05)
