"""A solid in a fluid on several ranks: the same bits, through new lists, and resumed on other ranks."""

import numpy as np
import pytest
from gauging import start
from mpi4py import MPI
from runs.resuming import go_on_elsewhere

from psph.case import load

COMM = MPI.COMM_WORLD
pytestmark = pytest.mark.mpi(min_size=2)

FLAP = """
time.end = 1.0
physics.gravity = [0.5, -9.8]
parallel.axis = "x"
output = { frames = 0.02, probes = 0.01, log = 0.01 }
space = { dimensions = 2, spacing = 0.05 }
[fluids.water]
shape.difference.from.box = { lower = [0.0, 0.0], upper = [2.0, 0.4] }
shape.difference.minus = [{ box = { lower = [0.9, 0.0], upper = [1.1, 0.3] } }]
density = 1000.0
viscosity = 0.02
pressure = "hydrostatic"
velocity = [0.3, 0.0]
[walls.tank]
shape.difference.from.box = { lower = [-0.25, -0.25], upper = [2.25, 0.8] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [2.0, 0.8] } }]
[solids.sheet]
shape.box = { lower = [0.0, 0.4], upper = [2.0, 0.6] }
clamps.grip.shape.box = { lower = [0.0, 0.4], upper = [0.3, 0.6] }
clamps.grip.motion.sinusoid = { amplitude = [0.0, 0.02], period = 0.1 }
density = 1300.0
no_slip = true
young = 3.0e6
poisson = 0.35
damping = 5.0
[solids.post]
shape.box = { lower = [0.9, 0.0], upper = [1.1, 0.3] }
clamped.box = { lower = [0.9, 0.0], upper = [1.1, 0.1] }
density = 1100.0
no_slip = true
young = 2.0e6
poisson = 0.45
law = "neo-hookean"
[gauges.push.force]
on = ["sheet"]
"""
"""A sheet on water, shaken at one end, across all slabs, and a post of another law under it."""


def flap(folder):
    if COMM.rank == 0:
        (folder / "flap.toml").write_text(FLAP, encoding="utf-8")
    COMM.Barrier()
    return load(folder / "flap.toml")


def rows(simulation):
    """All particles by id."""
    store = simulation.store
    names = ("position", "velocity", "density", "acceleration", "load", "inertia")
    parts = [store.owned_rows("id")[:, None], *(store.owned_rows(n).reshape(store.owned, -1) for n in names)]
    every = np.concatenate(simulation.comm.allgather(np.hstack(parts)))
    return every[np.argsort(every[:, 0])]


@pytest.mark.core
def test_same_bits_through_rebuilds_and_on_any_number_of_ranks(mpi_tmp_path):
    case = flap(mpi_tmp_path)
    single, together = start(case, MPI.COMM_SELF), start(case, COMM)
    begun = rows(single)
    assert len(together.engine.of("solids").halo.ids) > 0  # the sheet goes on behind the slab's end
    for _ in range(40):
        single.step()
        together.step()
    one, many = rows(single), rows(together)
    assert np.isfinite(one).all()
    for density in (1300.0, 1100.0):
        assert np.abs(one - begun)[one[:, -1] == density * 0.05**2, 1:3].max() > 1e-5
    assert np.array_equal(one, many)


@pytest.mark.parametrize("before, after", [(1, 2), (2, 1)])
def test_a_resume_on_other_ranks_goes_on_alike(before, after, mpi_tmp_path):
    go_on_elsewhere(flap(mpi_tmp_path), before, after, mpi_tmp_path)
