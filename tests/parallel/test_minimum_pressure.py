"""p⁻ on 2 ranks: the smallest pressure lies on the other side of the rank boundary."""

import numpy as np
import pytest
from mpi4py import MPI

from psph.case import Case
from psph.output.ledger import Ledger
from psph.runs.setup import create_particles
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation

COMM = MPI.COMM_WORLD
pytestmark = pytest.mark.mpi(min_size=2)


def simulation(comm):
    corners = {"lower": [0.0, 0.0], "upper": [4.0, 1.0]}
    case = Case.model_validate(
        {
            "space": {"dimensions": 2, "spacing": 0.1, "kernel": "hyperbolic", "smoothing": 1.2},
            "time": {"end": 1.0},
            "physics": {"sound_speed": 10.0, "pressure_gradient": "minimum"},
            "fluids": {"water": {"shape": {"box": corners}, "jitter": 0.1}},
            "parallel": {"axis": "x"},
        }
    )
    scene = Scene(case)
    plan = make_plan(scene)
    return Simulation(scene, plan, create_particles(scene, plan, comm), comm, Ledger())


def accelerations(sim, low_id, ghosts=True):
    """{id: acceleration} when one particle has a far lower pressure than all others."""
    store = sim.store
    ids = store.id[store.inner]
    pressure = store["pressure"]
    pressure[store.inner] = 1000.0 + ids
    pressure[store.inner][ids == low_id] = -5000.0
    if ghosts:
        sim.domain.halo.refresh(("pressure",))
    sim.engine.sum(sim.is_due, 0.0, 0.0, ghosts_are_fresh=True)
    mine = dict(zip(ids.tolist(), store.owned_rows("acceleration").tolist()))
    return {key: value for part in sim.comm.allgather(mine) for key, value in part.items()}


def at_the_boundary(sim):
    """Id of the last particle of rank 0, on every rank."""
    store = sim.store
    return COMM.bcast(int(store.id[store.low + store.owned - 1]))


def test_a_minimum_across_the_boundary_is_seen():
    sim = simulation(COMM)
    low_id = at_the_boundary(sim)
    together = accelerations(sim, low_id)
    alone = accelerations(simulation(MPI.COMM_SELF), low_id)
    assert together == alone
    owner = COMM.allgather({int(i) for i in sim.store.id[sim.store.inner]})
    changed = accelerations(simulation(MPI.COMM_SELF), low_id=-1)
    across = [i for i in alone if i not in owner[0] and not np.allclose(alone[i], changed[i])]
    assert across  # particles of rank 1 feel the minimum that rank 0 owns


def test_without_its_refresh_the_answer_is_another():
    """The control: ghosts that keep an old pressure."""
    sim = simulation(COMM)
    low_id = at_the_boundary(sim)
    stale = accelerations(sim, low_id, ghosts=False)
    assert stale != accelerations(simulation(MPI.COMM_SELF), low_id)
