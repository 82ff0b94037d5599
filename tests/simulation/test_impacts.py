"""Gradients are gathered at once where something strikes: psph.simulation.impacts."""

import numpy as np
import pytest
from drafts import draft
from gauging import start
from mpi4py import MPI

from psph.simulation import impacts
from psph.simulation.impacts import LASTS, Impacts

SQUARES = """
space = { dimensions = 2, spacing = 0.05, lower = [-3, -3], upper = [5, 4] }
time.end = 0.4
[fluids.a]
velocity = [2.0, 0.0]
shape.box = { lower = [0.0, 0.0], upper = [0.5, 0.5] }
[fluids.b]
velocity = [-2.0, 0.0]
shape.box = { lower = [0.6, 0.1], upper = [1.1, 0.6] }
"""


def energy_left(folder, *keys):
    """Of 1000 J of motion, J."""
    case = draft(folder, SQUARES, *keys)
    simulation = start(case, MPI.COMM_SELF)
    while simulation.time < case.time.end:
        simulation.step(case.time.end)
    v, m = simulation.store.shown("velocity"), simulation.store.shown("mass")
    return float(0.5 * m @ (v**2).sum(axis=1))


@pytest.mark.parametrize(("passes", "left", "more"), [(1, 755.2, 20.0), (2, 748.5, 10.0)])
def test_an_impact_takes_the_energy_that_it_takes_with_fresh_gradients(
    passes, left, more, tmp_path, monkeypatch
):
    """The control gathers in every eighth pass whatever happens, and loses 26 J more, in two passes 15."""
    taken = f"time.passes={passes}"
    found, fresh = energy_left(tmp_path, taken), energy_left(tmp_path, taken, "time.gather_every=1")
    monkeypatch.setattr(impacts, "STRONG", np.inf)
    control = energy_left(tmp_path, taken)
    assert fresh == pytest.approx(left, abs=2.0)
    assert abs(found - fresh) < 4.0 < more < fresh - control


def test_an_impact_is_sudden_and_strong():
    """Not what is always so, and not what grows slowly."""
    watch = Impacts(1000.0)
    for _ in range(200):
        watch.see(15.0)
    assert not watch.lasts
    watch.see(55.0)
    seen = []
    while watch.lasts:
        seen.append(1)
        watch.see(15.0)
    assert len(seen) == LASTS
    for _ in range(400):
        watch.see(55.0)
    assert not watch.lasts
    again = Impacts(1000.0)
    again.restore(watch.state())
    for one in (watch, again):
        one.see(190.0)
    assert watch.lasts and again.lasts and watch.state() == again.state()
    slow = Impacts(1000.0)
    for k in range(1, 2000):
        slow.see(0.05 * k)
        assert not slow.lasts
