"""Gas that comes in and leaves, on several ranks: the same bits, and resumed on other ranks."""

import numpy as np
import pytest
from gauging import start
from mpi4py import MPI
from parallel.test_gas_mirrors import rows
from parallel.written import written
from runs.resuming import go_on_elsewhere

pytestmark = pytest.mark.mpi(min_size=2)

WIND = """
scheme = "gas"
time.end = 1.0
parallel.axis = "x"
output = { frames = 0.5, log = 0.5 }
space = { dimensions = 2, spacing = 0.0625, lower = [0.0, 0.0], upper = [4.0, 1.5], symmetry = ["y.lower"] }
[ideal_gases.wind]
shape.box = { lower = [0.0, 0.0], upper = [1.5, 1.5] }
density = 1.0
pressure = 2.0
velocity = [4.0, 0.0]
inflow = "x.lower"
outflow = "x.upper"
[ideal_gases.thin]
shape.box = { lower = [1.5, 0.0], upper = [4.0, 1.5] }
density = "1 + 0.3 * sin(3 * y)"
pressure = 1.0
velocity = [3.0, "0.2 - 0.3 * y"]
jitter = 0.2
outflow = "x.upper"
"""


def test_same_bits_in_a_stream(mpi_tmp_path):
    """Layers come in and particles go out meanwhile."""
    case = written(mpi_tmp_path, WIND)
    single, together = start(case, MPI.COMM_SELF), start(case, MPI.COMM_WORLD)
    for _ in range(30):
        single.step()
        together.step()
    streams = single.engine.of("ideal_gases").streams
    assert streams.came[0] > 0 and streams.went[1] + streams.went[2] > 0
    assert np.array_equal(rows(single), rows(together))


@pytest.mark.parametrize("before, after", [(1, 2), (2, 1)])
def test_a_resume_on_other_ranks_goes_on_alike(before, after, mpi_tmp_path):
    go_on_elsewhere(written(mpi_tmp_path, WIND), before, after, mpi_tmp_path)
