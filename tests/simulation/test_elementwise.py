"""Loops over columns: a particle's bits do not depend on where a slab, or a vector, begins."""

import re

import numba
import pytest
from drafts import TANK, draft
from mpi4py import MPI

from psph.output.ledger import Ledger
from psph.particles import records
from psph.run.setup import create_particles
from psph.scene import Scene
from psph.simulation import cpu as engine
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation

COLUMNS = 100


@pytest.fixture(params=("double", "mixed"))
def calls(request, tmp_path, monkeypatch):
    """The simulation of a tank after some steps, and the calls of its loops in the next."""
    scene = Scene(draft(tmp_path, TANK, f"precision={request.param}"))
    plan = make_plan(scene)
    store = create_particles(scene, plan, MPI.COMM_SELF)
    simulation = Simulation(scene, plan, store, MPI.COMM_SELF, Ledger())
    for _ in range(3):
        simulation.step()
    found = {}

    def in_threads(loop, *call):
        if loop.__name__ != "sum_over_neighbours":
            found[getattr(loop, "loop", loop)] = call
        return [loop(*call)]

    monkeypatch.setattr(engine, "in_threads", in_threads)
    monkeypatch.setattr(records, "in_threads", in_threads)
    simulation.step()
    assert len(found) == 3 and store.low == 0 and store.owned >= COLUMNS
    return simulation, found


def test_every_boundary_gives_the_same_bits(calls):
    simulation, found = calls
    data, table = simulation.store.data, simulation.engine.records[-1].table
    before = data.copy(), table.copy()

    def after(loop, call, cut):
        data[:], table[:] = before
        loop(0, cut, *call[2:])
        loop(cut, COLUMNS, *call[2:])
        return data.tobytes(), table.tobytes()

    for loop, call in found.items():
        whole = after(loop, call, 0)
        assert whole != (before[0].tobytes(), before[1].tobytes()) or "fill" in loop.__name__
        assert all(after(loop, call, cut) == whole for cut in range(1, 17)), loop.__name__


def test_no_operation_is_contracted(calls):
    for loop, call in calls[1].items():
        fresh = numba.jit(**loop.targetoptions)(loop.py_func)  # what comes from a cache shows no code
        fresh.compile(tuple(map(numba.typeof, call)))
        [code] = fresh.inspect_asm().values()
        assert "vmov" in code and not re.search(r"vfn?m(add|sub)", code), loop.__name__
