"""What measuring itself costs."""

import time

import pytest
from mpi4py import MPI

from psph.bench.box import Box
from psph.output.ledger import Ledger
from psph.output.progress import Progress
from psph.scene import Scene
from psph.solver.plan import make_plan
from psph.solver.step import Simulation

pytestmark = pytest.mark.alone


def test_measuring_takes_below_a_hundredth_of_a_step():
    """Entries of the ledger and looks of the progress in a step, times what one of them takes."""
    scene = Scene(Box.nearest(2, 20, 20_000).case())
    plan = make_plan(scene)
    store = Box.nearest(2, 20, 20_000).create(scene, plan, MPI.COMM_SELF)
    entries = []

    class Counting(Ledger):
        def __call__(self, name):
            entries.append(name)
            return super().__call__(name)

    simulation = Simulation(scene, plan, store, MPI.COMM_SELF, Counting())
    steps = []
    for _ in range(30):
        entries.clear()
        begun = time.perf_counter()
        simulation.step()
        steps.append(time.perf_counter() - begun)
    progress = Progress(MPI.COMM_SELF, 1e9, "", 1, lines=False)
    ledger, looks = Ledger(), []
    for _ in range(20):
        begun = time.perf_counter()
        for _ in range(100):
            for name in entries:
                with ledger(name):
                    pass
            progress.update(1.0, 1, 1.0)
        looks.append((time.perf_counter() - begun) / 100)
    progress.close()
    assert len(entries) >= 8
    assert min(looks) < 0.01 * min(steps)
