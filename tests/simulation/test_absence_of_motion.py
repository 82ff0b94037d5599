"""What moves, floats or is measured costs a scene without such things nothing: instructions, arrays, passes."""

import inspect
import re
from collections import Counter

import numba
import pytest
from drafts import TANK, draft
from gauging import start

from psph.matter.body import push_bodies
from psph.simulation.integrator import kick, kick_drift_predict
from psph.simulation.midway import drift_to_end, kick_to_middle

LOG = "bodies.log={shape={box={lower=[0.4,0.9],upper=[0.7,1.1]}},mass=20.0}"
PADDLE = "walls.paddle={shape={box={lower=[0.4,0.9],upper=[0.7,1.1]}},motion={translation=[0.1,0.0]}}"
GAUGES = ("gauges.level.level={foot=[0.5,0.0],top=[0.5,0.6]}", "gauges.push.force.on=['tank']")
"""Overrides of still water in a tank."""

WITHOUT = {
    kick: (
        ("        book_work(rules, i, group, k, dt, c.work, c.load, at(c.velocity, k))\n", ""),
        ("prescribed_squares(rules, group, k, time, dt, at(c.velocity, k), c.anchor)", "0.0, 0.0"),
    ),
    kick_drift_predict: (
        ("            carry(rules, group, k, time, c)\n", "            pass\n"),
        ("        store_apparent_force(rules, group, k, time, dt, c)\n", ""),
    ),
    kick_to_middle: (("        else:\n            carry(rules, group, k, time, c)\n", ""),),
    drift_to_end: (
        ("            carry(rules, group, k, time, c)\n", "            pass\n"),
        ("        store_apparent_force(rules, group, k, time, dt, c)\n", ""),
    ),
}
"""What motion has brought into the loops over columns, and what stands there without it."""


@pytest.fixture
def begun(tmp_path):
    """A function: overrides → the simulation of a tank with them."""

    def make(*overrides):
        return start(draft(tmp_path, TANK, *overrides))

    return make


def instructions(loop, simulation) -> Counter:
    """How many of each a loop over the columns of a simulation has, compiled afresh; but for moves between
    registers and jumps, which the order of names may change."""
    engine = simulation.engine
    fresh = numba.njit(error_model="numpy", nogil=True)(loop)
    times = len(inspect.signature(loop).parameters) - 5
    call = (0, 1, *[0.0] * times, engine._rules, engine.view(0.0), engine.columns())
    fresh.compile(tuple(map(numba.typeof, call)))
    [code] = fresh.inspect_asm().values()
    found = re.findall(r"^\s+([a-z][a-z0-9]+)\s", code, re.MULTILINE)
    return Counter(one for one in found if not one.startswith(("mov", "lea", "j", "push", "pop")))


@pytest.mark.parametrize("loop", WITHOUT, ids=lambda loop: loop.__name__)
def test_where_nothing_moves_the_loops_over_columns_know_nothing_of_it(loop, begun):
    source = inspect.getsource(loop.py_func).replace("@elementwise\n", "")
    for now, then in WITHOUT[loop]:
        assert source.count(now) == 1
        source = source.replace(now, then)
    names = dict(loop.py_func.__globals__)
    exec(source, names)
    passes = f"time.passes={2 if loop in (kick_to_middle, drift_to_end) else 1}"
    still = begun(passes)
    plain = instructions(names[loop.__name__], still)
    assert instructions(loop.py_func, still) == plain
    assert instructions(loop.py_func, begun(passes, LOG)).total() > 1.1 * plain.total()


def test_arrays_and_stages_come_with_what_needs_them(begun):
    plain, gauged, paddled, floating = (begun(*more) for more in ((), GAUGES, (PADDLE,), (LOG,)))
    brought = {"anchor", "work", "load", "apparent"}
    assert not brought & set(plain.plan.arrays)
    assert brought & set(gauged.plan.arrays) == {"load"}
    assert brought & set(paddled.plan.arrays) == {"anchor", "work", "load"}
    assert brought & set(floating.plan.arrays) == {"anchor", "work", "load"}
    runs = [[stage.run for stage in one.stages] for one in (plain, gauged, paddled, floating)]
    assert [push_bodies in each for each in runs] == [False] * 3 + [True]
    assert plain.plan.materials.loaded is None and plain.engine.poses.maps is None
    halos = [one.plan.refreshed + one.plan.ghost_fields for one in (plain, gauged, paddled, floating)]
    assert halos[1:] == halos[:1] * 3
