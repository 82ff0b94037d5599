"""A rigid body that is forced into another ends the run, in one line; so do elastic solids."""

import numpy as np
import pytest
from contacts import BLOCKS
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
    assert "the run has a body where it cannot be at step 100" in str(trouble)
    assert "bodies.ram is " in str(trouble) and "m inside walls.frame (guards.overlap = 1)" in str(trouble)


PULLED = (
    "bodies.ram={shape={box={lower=[1.2,1.2],upper=[1.5,1.5]}},density=2000.0,free=['y']}",
    "bodies.hand={shape={box={lower=[1.8,1.2],upper=[2.1,1.5]}},density=2000.0,free=[],"
    "motion={translation=[2.0,0.0]}}",
    "joints.arm={of=['ram','hand'],fixed={}}",
)


def test_a_joint_that_cannot_hold_ends_the_run(tmp_path):
    """What the ram is not free to do pulls it off the hand."""
    trouble, _ = started(boxed(tmp_path, MPI.COMM_WORLD, *PULLED), tmp_path / "run", MPI.COMM_WORLD)
    assert "joints.arm gapes by " in str(trouble) and "(guards.overlap = 1)" in str(trouble)


@pytest.mark.parametrize("key", ["guards.overlap=5.0", "guards.on_trouble=warn"])
def test_one_that_is_meant_to_goes_on(tmp_path, key):
    case = boxed(
        tmp_path, MPI.COMM_WORLD, RAM, key, "time.end=0.26", "guards.density=9.0", "guards.depth=9.0"
    )
    trouble, said = started(case, tmp_path / "run", MPI.COMM_WORLD)
    assert trouble is None and any("guards.overlap was exceeded" in line for line in said) == ("warn" in key)


SHORT = "time.end=0.15", "output={frames=0.15,log=0.05}"
SOFT = "physics.contact.stiffness=1e-3"


def met(folder, text, *sets):
    """How a run of two that meet ends, and what it says."""
    path = folder / "meeting.toml"
    with together(MPI.COMM_WORLD, path):
        path.write_text(text)
    return started(load(path, (*SHORT, *sets)), folder / "run", MPI.COMM_WORLD)


PUDDLE = "fluids.puddle.shape.box={lower=[5.0,0.0],upper=[5.3,0.3]}", "physics.sound_speed=70.0"
"""Water out of the way: solids meet in steps of their own."""


@pytest.mark.parametrize("wet", [(), PUDDLE], ids=["alone", "in a fluid"])
def test_elastic_solids_inside_each_other_end_the_run(tmp_path, wet):
    trouble, _ = met(tmp_path, BLOCKS, SOFT, *wet)
    assert "the run has a body where it cannot be at step 100" in str(trouble)
    assert "is inside another solid, a body or a wall (guards.overlap = 1)" in str(trouble)
    assert "of solids.left" in str(trouble) or "of solids.right" in str(trouble)


def test_those_that_bounce_go_on(tmp_path):
    assert met(tmp_path, BLOCKS)[0] is None


BULLET = (
    "solids.right=off",
    "bodies.bullet.shape.box={lower=[-0.4,0.3],upper=[-0.1,0.6]}",
    "bodies.bullet.density=3000.0",
    "bodies.bullet.velocity=[9.0,0.0]",
)
"""A body three particles wide is shot into a block: it fills no neighbourhood of that, but that its own."""


def test_a_small_body_inside_an_elastic_solid_ends_the_run(tmp_path):
    trouble, _ = met(tmp_path, BLOCKS, SOFT, *BULLET)
    assert "the run has a body where it cannot be at step 100" in str(trouble)
    assert "of bodies.bullet is inside another solid, a body or a wall (guards.overlap = 1)" in str(trouble)
    assert met(tmp_path, BLOCKS, *BULLET)[0] is None


def test_a_lattice_before_a_plane_is_that_part_of_a_whole_one():
    for dimensions in (2, 3):
        axis = np.arange(-4, 5) + 0.3
        sites = np.stack(np.meshgrid(*[axis] * dimensions), axis=-1).reshape(-1, dimensions)
        weight = np.maximum(1.0 - (sites**2).sum(axis=1) / REACH**2, 0.0)
        assert weight.sum() == pytest.approx(whole(dimensions), rel=0.03)
        for depth in (0.2, 1.2):  # the face is half a spacing before a row
            seen = weight[sites[:, 0] > -depth].sum() / weight.sum()
            assert seen == pytest.approx(filled(depth / REACH, dimensions), abs=0.05)
