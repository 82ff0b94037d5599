"""Self-gravity on several ranks: the same bits of fluid, solid and body, and resumed on other ranks."""

import numpy as np
import pytest
from gauging import start
from mpi4py import MPI
from runs.resuming import go_on_elsewhere

from psph.case import load

COMM = MPI.COMM_WORLD
pytestmark = pytest.mark.mpi(min_size=2)

THREE = """
time.end = 1.0
parallel.axis = "x"
output = { frames = 0.02, probes = 0.01, log = 0.01 }
space = { dimensions = 3, spacing = 0.1, lower = [-2.0, -1.0, -1.0], upper = [2.0, 1.0, 1.0] }
physics.self_gravity = { constant = 2e-3, softening = 0.1 }
physics.sound_speed = 20.0
physics.contact = {}
[fluids.water]
density = 1000.0
jitter = 0.2
shape.ball = { center = [0.0, 0.0, 0.0], radius = 0.35 }
velocity = [0.8, 0.3, 0.0]
[bodies.moon]
shape.box = { lower = [0.8, -0.1, -0.1], upper = [1.1, 0.2, 0.2] }
density = 3000.0
velocity = [-0.8, 0.5, 0.0]
[solids.rock]
shape.box = { lower = [-1.1, -0.2, -0.2], upper = [-0.8, 0.1, 0.1] }
density = 2000.0
young = 1e6
poisson = 0.3
velocity = [0.0, 0.0, 0.3]
"""


TREE = THREE.replace("softening = 0.1 }", 'softening = 0.1, method = "tree" }')


CLOUD = """
scheme = "gas"
time.end = 1.0
parallel.axis = "x"
output = { frames = 0.02, probes = 0.01, log = 0.01 }
space = { dimensions = 3, spacing = 0.2 }
physics.self_gravity = { constant = 1.0, softening = "h", method = "tree" }
[ideal_gases.cloud]
shape.box = { lower = [-1.6, -0.6, -0.6], upper = [1.6, 0.6, 0.6] }
density = 1.0
gamma = 1.4
thermal_energy = 0.5
"""


def three(folder, text=THREE):
    if COMM.rank == 0:
        (folder / "three.toml").write_text(text, encoding="utf-8")
    COMM.Barrier()
    return load(folder / "three.toml")


OF_ALL = ("position", "velocity", "density", "attraction", "attraction_energy")


def rows(simulation, *more):
    """All particles by id."""
    store, names = simulation.store, (*OF_ALL, *more)
    parts = [np.atleast_2d(store.owned_rows(name).T).T for name in ("id", *names)]
    every = np.concatenate(simulation.comm.allgather(np.hstack(parts)))
    return every[np.argsort(every[:, 0])]


@pytest.mark.core
@pytest.mark.parametrize(
    "text, more",
    [(THREE, "whole_attraction"), (TREE, "whole_attraction"), (CLOUD, "softening_change")],
    ids=["all pairs", "tree", "by size"],
)
def test_same_bits_through_rebuilds_and_on_any_number_of_ranks(text, more, mpi_tmp_path):
    case = three(mpi_tmp_path, text)
    single, together = start(case, MPI.COMM_SELF), start(case, COMM)
    owned = together.store.owned
    for _ in range(60):
        single.step()
        together.step()
    one, many = rows(single, more), rows(together, more)
    assert np.isfinite(one).all() and (np.ptp(one[:, -5:], axis=0) > 0.0).all()
    assert COMM.allreduce(owned) == len(one) > max(COMM.allgather(owned))  # no rank has all
    assert np.array_equal(one, many)


@pytest.mark.parametrize("before, after, text", [(1, 2, THREE), (2, 1, TREE), (2, 1, CLOUD)])
def test_a_resume_on_other_ranks_goes_on_alike(before, after, text, mpi_tmp_path):
    go_on_elsewhere(three(mpi_tmp_path, text), before, after, mpi_tmp_path)


@pytest.mark.core
def test_the_tree_opens_cells_by_the_pull_of_the_step_before(mpi_tmp_path):
    """That is in the checkpoint and goes with the particle: without it a step has other bits."""
    case = three(mpi_tmp_path, TREE)
    kept, lost = start(case, COMM), start(case, COMM)
    lost.store["attraction"][0][:] *= 1e-3
    for one in (kept, lost):
        one.step()
    assert not np.array_equal(rows(kept), rows(lost))
