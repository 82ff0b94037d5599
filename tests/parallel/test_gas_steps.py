"""Gas whose particles take steps of their own, on several ranks: the same bits, and resumed on other ranks."""

import numpy as np
import pytest
from gauging import start
from mpi4py import MPI
from parallel.test_gas_mirrors import rows
from parallel.written import written
from runs.resuming import go_on_elsewhere

pytestmark = pytest.mark.mpi(min_size=2)

BLAST = """
scheme = "gas"
time = { end = 0.3, halvings = 4 }
parallel.axis = "x"
output = { frames = 0.1, log = 0.1 }
[space]
dimensions = 2
spacing = 0.0625
lower = [0.0, 0.0]
upper = [4.0, 1.5]
periodic = ["x"]
symmetry = ["y.lower", "y.upper"]
[ideal_gases.gas]
shape.box = { lower = [0.0, 0.0], upper = [4.0, 1.5] }
density = 1.0
thermal_energy = "0.01 + 20 * exp(-((x - 1.4) ** 2 + y ** 2) / 0.02)"
jitter = 0.2
"""


SWITCHED = BLAST + "[physics]\nshock_viscosity = { alpha = 1.0, beta = 2.0, least = 0.0 }\n"
CUT = SWITCHED.replace("x - 1.4", "x - 2.1")
"""Hot where two ranks meet: what those beside bear counts in the first step."""
EACH = pytest.mark.parametrize("text", [BLAST, SWITCHED], ids=["everywhere", "switched"])
"""The viscosity."""


@pytest.mark.parametrize("text", [BLAST, SWITCHED, CUT], ids=["everywhere", "switched", "cut"])
def test_same_bits_with_steps_of_their_own(text, mpi_tmp_path):
    """A shock wakes gas across the borders of ranks, while lists are made anew."""
    case = written(mpi_tmp_path, text)
    single, together = start(case, MPI.COMM_SELF), start(case, MPI.COMM_WORLD)
    for _ in range(4):
        single.step()
        together.step()
    steps = single.engine.of("ideal_gases").steps
    assert steps._woken > 20 and single.domain.rebuilds > 3
    assert np.array_equal(rows(single), rows(together))


@EACH
@pytest.mark.parametrize("before, after", [(1, 2), (2, 1)])
def test_a_resume_on_other_ranks_goes_on_alike(before, after, text, mpi_tmp_path):
    go_on_elsewhere(written(mpi_tmp_path, text), before, after, mpi_tmp_path, many=3)
