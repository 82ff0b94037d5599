"""Gradients are gathered at once where something strikes: psph.simulation.impacts."""

import numpy as np
import pytest
from drafts import draft
from gauging import start
from mpi4py import MPI

from psph.simulation import impacts
from psph.simulation.impacts import LASTS, Impacts

SQUARES = """
space = {{ dimensions = 2, spacing = 0.05, lower = [-3, -3], upper = [5, 4] }}
time.end = {end}
[fluids.a]
velocity = [2.0, 0.0]
shape.box = {{ lower = [0.0, 0.0], upper = [0.5, 0.5] }}
[fluids.b]
velocity = [-2.0, 0.0]
shape.box = {{ lower = [{left}, 0.1], upper = [{right}, 0.6] }}
"""

GAPS = 0.05 * np.arange(2, 12)
"""m: after so many ways the squares meet, some steps of eight after gradients were gathered."""


def energies_left(folder, *keys):
    """Of 1000 J of motion, J, 0.375 s after they meet, for each of the gaps."""
    found = []
    for gap in GAPS:
        case = draft(folder, SQUARES.format(end=0.375 + gap / 4.0, left=0.5 + gap, right=1.0 + gap), *keys)
        simulation = start(case, MPI.COMM_SELF)
        while simulation.time < case.time.end:
            simulation.step(case.time.end)
        v, m = simulation.store.shown("velocity"), simulation.store.shown("mass")
        found.append(float(0.5 * m @ (v**2).sum(axis=1)))
    return np.array(found)


@pytest.mark.parametrize(("passes", "left", "more"), [(1, 755.2, 20.0), (2, 748.5, 10.0)])
def test_an_impact_takes_the_energy_that_it_takes_with_fresh_gradients(
    passes, left, more, tmp_path, monkeypatch
):
    """On the mean over ten gaps.  The control gathers in every eighth pass whatever happens."""
    taken = f"time.passes={passes}"
    found, fresh = energies_left(tmp_path, taken), energies_left(tmp_path, taken, "time.gather_every=1")
    monkeypatch.setattr(impacts, "STRONG", np.inf)
    control = energies_left(tmp_path, taken)
    assert fresh.mean() == pytest.approx(left, abs=2.0)
    assert np.abs(found - fresh).mean() < 4.0 < more < (fresh - control).mean()


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
