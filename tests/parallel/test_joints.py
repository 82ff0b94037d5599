"""Joints of bodies on several ranks: the same bits, and resumed on other ranks."""

import numpy as np
import pytest
from gauging import start
from mpi4py import MPI
from parallel.written import written
from runs.resuming import go_on_elsewhere

COMM = MPI.COMM_WORLD
pytestmark = pytest.mark.mpi(min_size=2)

ARM = """
time.end = 1.0
physics.gravity = [0.0, -9.8]
parallel.axis = "x"
output = { frames = 0.02, probes = 0.01, log = 0.01 }
space = { dimensions = 2, spacing = 0.05 }
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [2.0, 0.6] }
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = { lower = [-0.25, -0.25], upper = [2.25, 0.8] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [2.0, 0.8] } }]
[bodies.upper]
shape.box = { lower = [0.5, 0.3], upper = [1.0, 0.5] }
density = 1300.0
[bodies.lower]
shape.box = { lower = [1.0, 0.3], upper = [1.5, 0.5] }
density = 700.0
[joints.shoulder]
of = ["upper", "tank"]
hinge = { at = [0.5, 0.4], limits = [-5.0, 5.0], latch = true }
[joints.elbow]
of = ["lower", "upper"]
hinge = { at = [1.0, 0.4], stiffness = 500.0, damping = 20.0 }
[gauges.elbow.joint]
of = "elbow"
"""
"""Two bodies in water, on a hinge in the wall and one between them, across all slabs."""


def test_same_bits_on_any_number_of_ranks(mpi_tmp_path):
    case = written(mpi_tmp_path, ARM)
    single, together = start(case, MPI.COMM_SELF), start(case, COMM)
    for _ in range(60):
        single.step()
        together.step()
    assert np.array_equal(rows_of(single), rows_of(together))
    joints = single.engine.of("bodies").joints
    assert joints.ways[0] < -1e-3 and joints.widest()[0] < 1e-12
    assert np.array_equal(joints.ways, together.engine.of("bodies").joints.ways)


def rows_of(simulation):
    """All particles by id."""
    store = simulation.store
    names = ("position", "velocity", "density", "acceleration")
    parts = [store.owned_rows("id")[:, None], *(store.owned_rows(n).reshape(store.owned, -1) for n in names)]
    every = np.concatenate(simulation.comm.allgather(np.hstack(parts)))
    return every[np.argsort(every[:, 0])]


@pytest.mark.parametrize("before, after", [(1, 2), (2, 1)])
def test_a_resume_on_other_ranks_goes_on_alike(before, after, mpi_tmp_path):
    go_on_elsewhere(written(mpi_tmp_path, ARM), before, after, mpi_tmp_path)
