"""A hull with a fin in water on several ranks: the same bits, and resumed on other ranks."""

import numpy as np
import pytest
from gauging import start
from mpi4py import MPI
from parallel.test_joints import rows_of
from parallel.written import written
from runs.resuming import go_on_elsewhere

COMM = MPI.COMM_WORLD
pytestmark = pytest.mark.mpi(min_size=2)

SWIMMER = """
time.end = 1.0
physics.gravity = [0.0, -9.8]
parallel.axis = "x"
output = { frames = 0.02, probes = 0.01, log = 0.01 }
space = { dimensions = 2, spacing = 0.05 }
[fluids.water.shape.difference]
from.box = { lower = [0.0, 0.0], upper = [2.5, 0.7] }
minus = [{ box = { lower = [0.7, 0.3], upper = [2.0, 0.5] } }]
[walls.tank]
shape.difference.from.box = { lower = [-0.25, -0.25], upper = [2.75, 0.8] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [2.5, 0.8] } }]
[bodies.hull]
shape.box = { lower = [0.5, 0.2], upper = [1.1, 0.6] }
density = 700.0
velocity = [0.5, 0.0]
[solids.fin]
shape.box = { lower = [0.7, 0.3], upper = [2.0, 0.5] }
density = 1200.0
young = 1.0e6
poisson = 0.3
clamps.root = { shape.box = { lower = [0.7, 0.3], upper = [1.1, 0.5] }, body = "hull" }
"""
"""Across all slabs."""


def test_same_bits_on_any_number_of_ranks(mpi_tmp_path):
    case = written(mpi_tmp_path, SWIMMER)
    single, together = start(case, MPI.COMM_SELF), start(case, COMM)
    for _ in range(60):
        single.step()
        together.step()
    assert np.array_equal(rows_of(single), rows_of(together))
    hulls = [one.engine.of("bodies").bodies for one in (single, together)]
    assert np.array_equal(hulls[0].place, hulls[1].place) and abs(hulls[0].spin[0, 2]) > 1e-3
    assert single.engine.stored_energy() > 0.1


@pytest.mark.parametrize("before, after", [(1, 2), (2, 1)])
def test_a_resume_on_other_ranks_goes_on_alike(before, after, mpi_tmp_path):
    go_on_elsewhere(written(mpi_tmp_path, SWIMMER), before, after, mpi_tmp_path)
