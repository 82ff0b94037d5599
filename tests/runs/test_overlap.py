"""A rigid body that is forced into another ends the run, in one line."""

import pytest
from mpi4py import MPI
from runs.guarded import boxed, started

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
