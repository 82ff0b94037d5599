"""The waves of a spectrum are those of their seed, on any number of ranks."""

import numpy as np
import pytest
from drafts import draft
from mpi4py import MPI
from parallel.alike import begun

COMM = MPI.COMM_WORLD
pytestmark = pytest.mark.mpi(min_size=2)

FLUME = """
space = { dimensions = 2, spacing = 0.05 }
time.end = 1.0
physics.gravity = [0.0, -9.81]
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [2.0, 0.3] }
pressure = "hydrostatic"
[walls.flume]
shape.union = [
  { box = { lower = [-0.3, -0.15], upper = [2.15, 0.0] } },
  { box = { lower = [2.0, 0.0], upper = [2.15, 0.5] } },
]
[walls.paddle]
shape.box = { lower = [-0.15, 0.0], upper = [0.0, 0.5] }
motion = { irregular = { height = 0.05, period = 1.4, depth = 0.3, seed = SEED } }
"""


def places(folder, seed, comm):
    """Of all particles after 40 steps, m, by their id, on every rank."""
    simulation = begun(draft(folder, FLUME.replace("SEED", str(seed))), comm)
    for _ in range(40):
        simulation.step()
    rows = [np.concatenate(comm.allgather(simulation.store.owned_rows(name))) for name in ("id", "position")]
    return rows[1][np.argsort(rows[0])]


def test_a_seed_gives_its_waves_on_any_number_of_ranks(tmp_path):
    together = places(tmp_path, 7, COMM)
    for _ in range(2):
        assert np.array_equal(together, places(tmp_path, 7, MPI.COMM_SELF))
    assert np.abs(together - places(tmp_path, 8, MPI.COMM_SELF)).max() > 1e-4
