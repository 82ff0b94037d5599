"""Updated Lagrangian solids on several ranks: the same bits, and resumed on other ranks."""

import numpy as np
import pytest
from gauging import start
from mpi4py import MPI
from runs.resuming import go_on_elsewhere

from psph.case import load

COMM = MPI.COMM_WORLD
pytestmark = pytest.mark.mpi(min_size=2)

BLOCKS = """
scheme = "solid"
time.end = 1.0
physics.gravity = [0.3, -9.8]
parallel.axis = "x"
output = { frames = 0.02, probes = 0.01, log = 0.01 }
space = { dimensions = 2, spacing = 0.1 }
[solids.beam]
description = "updated"
shape.box = { lower = [-0.8, 0.0], upper = [3.0, 0.4] }
clamped.box = { lower = [-0.8, 0.0], upper = [0.0, 0.4] }
density = 1100.0
young = 3.0e5
poisson = 0.35
[solids.block]
description = "updated"
shape.box = { lower = [1.5, 0.6], upper = [2.2, 1.2] }
density = 900.0
young = 8.0e5
poisson = 0.45
velocity = [-1.0, -6.0]
jitter = 0.1
[gauges.tip.displacement]
of = "beam"
at = [3.0, 0.2]
"""
"""A beam across all slabs, on which a block of other matter falls."""


def blocks(folder):
    if COMM.rank == 0:
        (folder / "blocks.toml").write_text(BLOCKS, encoding="utf-8")
    COMM.Barrier()
    return load(folder / "blocks.toml")


def rows(simulation):
    """All that moves, by id."""
    store = simulation.store
    names = ("position", "velocity", "acceleration", "density", "deviator", "repulsion")
    parts = [store.owned_rows("id")[:, None], *(store.owned_rows(n).reshape(store.owned, -1) for n in names)]
    every = np.concatenate(simulation.comm.allgather(np.hstack(parts)))
    return every[np.argsort(every[:, 0])]


@pytest.mark.core
def test_same_bits_through_rebuilds_and_on_any_number_of_ranks(mpi_tmp_path):
    case = blocks(mpi_tmp_path)
    single, together = start(case, MPI.COMM_SELF), start(case, COMM)
    begun = rows(single)
    for step in range(80):
        single.step()
        together.step()
        if step % 10 == 9:
            single.rebuild()
            together.rebuild()
    one, many = rows(single), rows(together)
    assert np.isfinite(one).all() and np.abs(one - begun).max() > 0.1
    held = single.store.owned_rows("kind") == 2
    assert held.sum() == 32 and not single.store.owned_rows("velocity")[held].any()
    assert np.abs(single.store.owned_rows("deviator")[held]).max() > 1.0  # the clamp bears a stress too
    assert np.array_equal(one, many)


@pytest.mark.parametrize("before, after", [(1, 2), (2, 1)])
def test_a_resume_on_other_ranks_goes_on_alike(before, after, mpi_tmp_path):
    go_on_elsewhere(blocks(mpi_tmp_path), before, after, mpi_tmp_path)
