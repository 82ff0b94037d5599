"""Lines with weight on several ranks: the same bits, and resumed on other ranks."""

import numpy as np
import pytest
from gauging import start
from mpi4py import MPI
from parallel.written import written
from runs.resuming import go_on_elsewhere

COMM = MPI.COMM_WORLD
pytestmark = pytest.mark.mpi(min_size=2)

MOORED = """
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
[bodies.raft]
shape.box = { lower = [0.8, 0.5], upper = [1.2, 0.7] }
density = 400.0
velocity = [1.0, 0.0]
[bodies.raft.lines.left]
at = [0.8, 0.5]
anchor = [0.1, 0.0]
length = 0.95
chain = { mass = 2.0, diameter = 0.02, axial_stiffness = 2.0e4, pieces = 10, bed.at = [0.0, 0.0] }
[bodies.raft.lines.right]
at = [1.2, 0.5]
anchor = [1.9, 0.0]
to = "tank"
pretension = 20.0
break_load = 21.0
chain = { mass = 2.0, diameter = 0.02, axial_stiffness = 2.0e4, pieces = 10, water_level = 0.6 }
[gauges.raft.motion]
of = "raft"
"""
"""A raft across two slabs, between a line on the bed and one that parts."""


def test_same_bits_on_any_number_of_ranks(mpi_tmp_path):
    case = written(mpi_tmp_path, MOORED)
    single, together = start(case, MPI.COMM_SELF), start(case, COMM)
    for _ in range(60):
        single.step()
        together.step()
    one, other = (sim.engine.of("bodies") for sim in (single, together))
    assert one.state() == other.state()
    lines = one.lines
    assert np.count_nonzero(np.isfinite(lines.parted)) == 1
    assert lines.tensions.max() > 1.0


@pytest.mark.parametrize("before, after", [(1, 2), (2, 1)])
def test_a_resume_on_other_ranks_goes_on_alike(before, after, mpi_tmp_path):
    go_on_elsewhere(written(mpi_tmp_path, MOORED), before, after, mpi_tmp_path)
