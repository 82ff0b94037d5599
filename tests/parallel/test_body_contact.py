"""Solids that meet solids, bodies and a wall across all slabs, in a fluid too: the same bits on any number of ranks,
resumed or not."""

import numpy as np
import pytest
from gauging import start
from mpi4py import MPI
from runs.resuming import go_on_elsewhere

from psph.case import load
from psph.simulation.solid_plan import solid_plan

COMM = MPI.COMM_WORLD
pytestmark = pytest.mark.mpi(min_size=2)

MATTRESS = """
time.end = 1.0
neighbours.skin = 0.1
parallel.axis = "x"
output = { frames = 0.02, probes = 0.01, log = 0.01 }
space = { dimensions = 2, spacing = 0.1 }
physics.gravity = [0.3, -9.8]
physics.contact = { damping = 0.1, friction = 0.3 }
[solids.mattress]
shape.box = { lower = [0.0, 0.0], upper = [4.0, 0.5] }
clamped.box = { lower = [0.0, 0.0], upper = [4.0, 0.1] }
density = 1000.0
young = 3.0e5
poisson = 0.35
damping = 40.0
jitter = 0.1
[bodies.beam]
shape.polygon.points = [[0.5, 0.55], [3.0, 0.75], [3.0, 1.15], [0.5, 0.95]]
density = 800.0
velocity = [-0.5, -3.0]
[bodies.ball]
shape.disc = { center = [3.5, 0.85], radius = 0.3 }
density = 1500.0
velocity = [-2.0, -3.0]
spin = 20.0
[walls.roller]
shape.disc = { center = [0.3, 0.7], radius = 0.25 }
motion = { translation = [1.5, -0.8] }
"""
"""A beam across slabs and a ball that spins fall on rubber, and a wall rolls over it."""


SEAT = """
time.end = 1.0
neighbours.skin = 0.1
parallel.axis = "x"
output = { frames = 0.02, probes = 0.01, log = 0.01 }
space = { dimensions = 2, spacing = 0.1 }
physics.sound_speed = 25.0
physics.gravity = [0.3, -9.8]
physics.contact = { damping = 0.1, friction = 0.3 }
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


SCENES = {"mattress": MATTRESS, "seat": SEAT, "seat under a ball": SEAT + BALL}


@pytest.fixture(params=["mattress", pytest.param("seat", marks=pytest.mark.core), "seat under a ball"])
def case(request, mpi_tmp_path):
    if COMM.rank == 0:
        (mpi_tmp_path / "meeting.toml").write_text(SCENES[request.param], encoding="utf-8")
    COMM.Barrier()
    return load(mpi_tmp_path / "meeting.toml")


KNOWN = (
    *("position", "velocity", "acceleration", "load", "couple", "face", "face_rate", "slip", "met", "work"),
    "contact_energy",
)


def rows(simulation):
    """All that particles carry of it, by id, and the stored energy."""
    energy, store = simulation.engine.stored_energy(), simulation.store
    names = [name for name in KNOWN if name in store]
    parts = [store.owned_rows("id")[:, None], *(store.owned_rows(n).reshape(store.owned, -1) for n in names)]
    every = np.concatenate(simulation.comm.allgather(np.hstack(parts)))
    return every[np.argsort(every[:, 0])], energy


def test_same_bits_through_rebuilds_and_on_any_number_of_ranks(case):
    single, together = start(case, MPI.COMM_SELF), start(case, COMM)
    plan, begun = single.plan, single.engine.state()
    for step in range(60 if solid_plan(plan).immersed else 120):
        single.step()
        together.step()
        if step % 10 == 9:  # at the same steps: contacts are summed in the order of the lists
            single.rebuild()
            together.rebuild()
    (one, energy), (many, energy_of_many) = rows(single), rows(together)
    state = single.engine.state()
    assert np.isfinite(one).all() and np.abs(one[:, -1]).max() > 0.0  # something is pressed
    assert solid_plan(plan).substeps != bool(plan.of("bodies"))
    if solid_plan(plan).alone:
        turned = np.subtract(state["angular_momentum"], begun["angular_momentum"])
        assert (np.abs(turned).max(axis=1) > 0.1).all()  # both bodies are
        assert np.abs(one[:, -2]).max() > 0.0  # and so is the wall
    assert np.array_equal(one, many) and energy == energy_of_many > 0.0
    assert state == together.engine.state()
    assert together.domain.rebuilds == single.domain.rebuilds > (5 if solid_plan(plan).immersed else 8)


@pytest.mark.parametrize("before, after", [(1, 2), (2, 1)])
def test_a_resume_on_other_ranks_goes_on_alike(case, before, after, mpi_tmp_path):
    go_on_elsewhere(case, before, after, mpi_tmp_path)
