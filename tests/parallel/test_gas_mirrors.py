"""Ideal gas between mirrors on several ranks: the same bits, and resumed on other ranks."""

import numpy as np
import pytest
from gauging import start
from mpi4py import MPI
from parallel.written import written
from runs.resuming import go_on_elsewhere

pytestmark = pytest.mark.mpi(min_size=2)

ROOM = """
scheme = "gas"
time.end = 0.03
parallel.axis = "x"
output = { frames = 0.03, probes = 0.01, log = 0.01 }
space = { dimensions = 2, spacing = 0.0625, lower = [0.0, 0.0], upper = [3.0, 1.0], symmetry = ["x.lower"] }
physics.shock_viscosity.least = 0.0
[walls.room]
condition = "mirror"
shape.difference.from.box = { lower = [0.0, -0.1], upper = [3.1, 1.1] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [3.0, 1.0] } }]
[ideal_gases.gas]
shape.box = { lower = [0.0, 0.0], upper = [3.0, 1.0] }
density = "1 + x * y"
pressure = 1.0
velocity = ["1 - x", "0.5 - y"]
jitter = 0.3
"""

PISTON = (
    ROOM.replace(', symmetry = ["x.lower"]', "")
    + """
[walls.piston]
condition = "mirror"
shape.box = { lower = [-0.1, -0.1], upper = [0.0, 1.1] }
motion = { sinusoid = { amplitude = [0.2, 0.0], frequency = 8.0 } }
[probes.face]
position = [0.1, 0.5]
"""
)
"""The same before a piston that shakes."""


def rows(simulation):
    """All particles by id."""
    names = ("id", "position", "velocity", "density", "thermal_energy", "smoothing_length")
    parts = [np.atleast_2d(simulation.store.owned_rows(name).T).T for name in names]
    every = np.concatenate(simulation.comm.allgather(np.hstack(parts)))
    return every[np.argsort(every[:, 0])]


@pytest.mark.core
@pytest.mark.parametrize("text", [ROOM, PISTON])
def test_same_bits_in_a_room(text, mpi_tmp_path):
    case = written(mpi_tmp_path, text)
    single, together = start(case, MPI.COMM_SELF), start(case, MPI.COMM_WORLD)
    for _ in range(40):
        single.step()
        together.step()
    assert np.array_equal(rows(single), rows(together))


@pytest.mark.parametrize("text, before, after", [(ROOM, 1, 2), (PISTON, 1, 2), (PISTON, 2, 1)])
def test_a_resume_on_other_ranks_goes_on_alike(text, before, after, mpi_tmp_path):
    go_on_elsewhere(written(mpi_tmp_path, text), before, after, mpi_tmp_path)
