"""Loops over columns: a particle's bits do not depend on where a slab, or a vector, begins."""

import re
import time

import numba
import pytest
from drafts import TANK, draft
from gauging import start

from psph.particles import records
from psph.simulation import cpu as engine

COLUMNS = 100


@pytest.fixture(params=("double", "mixed"))
def calls(request, tmp_path, monkeypatch):
    """The simulation of a tank after some steps, and the calls of its loops in the next."""
    simulation = start(draft(tmp_path, TANK, f"precision={request.param}"))
    store = simulation.store
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


BODY = "bodies.log={ shape = { box = { lower = [0.4, 0.9], upper = [0.7, 1.1] } }, mass = 20.0 }"


def test_a_body_does_not_slow_down_the_loops_over_columns(tmp_path):
    """A call inside them that hands all arrays on would take a hundred times as long as all the rest."""

    def seconds(*overrides):
        one = start(draft(tmp_path, TANK, *overrides))
        store = one.store
        one.step()
        parts = []
        for _ in range(20):
            begun = time.perf_counter()
            for _ in range(20):
                one.engine.kick(one.then, 0.0, one.previous_speed)
            parts.append(time.perf_counter() - begun)
        return min(parts) / store.owned

    assert seconds(BODY) < 5.0 * seconds()
