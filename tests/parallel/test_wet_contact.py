"""Solids that meet in a fluid across all slabs, alone and under bodies: the same bits on any number of ranks."""

import numpy as np
import pytest
from mpi4py import MPI
from parallel.test_simulation import start
from runs.resuming import go_on_elsewhere

from psph.case import load

COMM = MPI.COMM_WORLD
pytestmark = pytest.mark.mpi(min_size=2)

SEAT = """
time.end = 1.0
neighbours.skin = 0.1
parallel.axis = "x"
output = { frames = 0.02, probes = 0.01, log = 0.01 }
[space]
dimensions = 2
spacing = 0.1
[physics]
sound_speed = 25.0
gravity = [0.3, -9.8]
contact = { damping = 0.1, friction = 0.3 }
[fluids.water]
shape.difference.from.box = { lower = [0.0, 0.0], upper = [4.0, 1.6] }
shape.difference.minus = [
  { box = { lower = [0.0, 0.0], upper = [4.0, 0.5] } },
  { box = { lower = [0.9, 0.5], upper = [3.1, 0.9] } },
]
density = 1000.0
viscosity = 1e-3
[walls.tank]
shape.difference.from.box = { lower = [-0.4, -0.4], upper = [4.4, 2.0] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [4.0, 2.0] } }]
[solids.mattress]
shape.box = { lower = [0.0, 0.0], upper = [4.0, 0.5] }
clamped.box = { lower = [0.0, 0.0], upper = [4.0, 0.1] }
density = 1100.0
young = 3.0e5
poisson = 0.35
jitter = 0.1
[solids.slab]
shape.box = { lower = [0.9, 0.5], upper = [3.1, 0.9] }
density = 3000.0
young = 4.0e5
poisson = 0.3
velocity = [0.2, -1.0]
"""
"""A slab of rubber slides on a mattress under water, in steps of their own."""

BALL = """
[bodies.ball]
shape.disc = { center = [2.0, 1.2], radius = 0.3 }
density = 2500.0
velocity = [-1.0, -3.0]
spin = 10.0
[walls.roller]
shape.disc = { center = [0.5, 0.75], radius = 0.25 }
motion = { translation = [1.0, -0.5] }
"""
"""A ball that spins falls on the slab, and a wall rolls over the mattress, in the steps of the fluid."""


@pytest.fixture(params=["alone", "pressed"])
def seat(request, mpi_tmp_path):
    if COMM.rank == 0:
        (mpi_tmp_path / "seat.toml").write_text(SEAT + BALL * (request.param == "pressed"), encoding="utf-8")
    COMM.Barrier()
    return load(mpi_tmp_path / "seat.toml")


def rows(simulation):
    """All that particles carry of it, by id, and the stored energy."""
    energy, store = simulation.engine.stored_energy(), simulation.store
    known = "position", "velocity", "acceleration", "met", "load", "couple", "face", "slip", "work"
    names = [name for name in known if name in store]
    parts = [store.owned_rows("id")[:, None], *(store.owned_rows(n).reshape(store.owned, -1) for n in names)]
    every = np.concatenate(simulation.comm.allgather(np.hstack(parts)))
    return every[np.argsort(every[:, 0])], energy


def test_same_bits_through_rebuilds_and_on_any_number_of_ranks(seat):
    single, together = start(seat, MPI.COMM_SELF), start(seat, COMM)
    for step in range(60):
        single.step()
        together.step()
        if step % 10 == 9:  # at the same steps: contacts are summed in the order of the lists
            single.rebuild()
            together.rebuild()
    (one, energy), (many, energy_of_many) = rows(single), rows(together)
    assert np.isfinite(one).all() and np.abs(one[:, 7:9]).max() > 1.0  # they are pressed
    assert np.array_equal(one, many) and energy == energy_of_many > 0.0
    assert single.plan.substeps != single.plan.floats
    if single.plan.floats:
        assert single.engine.poses.state() == together.engine.poses.state()


@pytest.mark.parametrize("before, after", [(1, 2), (2, 1)])
def test_a_resume_on_other_ranks_goes_on_alike(seat, before, after, mpi_tmp_path):
    go_on_elsewhere(seat, before, after, mpi_tmp_path)
