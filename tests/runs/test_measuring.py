"""What measuring itself costs: entries of the ledger in a step."""

import pytest
from mpi4py import MPI

from psph.lab.bench.box import FluidBox
from psph.output.ledger import Ledger
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation

MOST = 10
"""Entries in a step without a rebuild; a microsecond each, while a step takes a tenth of one for every
particle: below a hundredth of a step from 10,000 particles on."""


class Counting(Ledger):
    """A ledger that knows its entries."""

    def __init__(self):
        super().__init__()
        self.entries = []

    def __call__(self, name):
        self.entries.append(name)
        return super().__call__(name)


@pytest.mark.parametrize("particles", [400, 4000])
def test_a_step_has_few_entries_however_many_particles(particles):
    layout = FluidBox.nearest(2, 20, particles)
    scene = Scene(layout.case())
    plan, ledger = make_plan(scene), Counting()
    simulation = Simulation(scene, plan, layout.create(scene, plan, MPI.COMM_SELF), MPI.COMM_SELF, ledger)
    for _ in range(5):
        simulation.step()
    rebuilds = simulation.domain.rebuilds
    ledger.entries.clear()
    simulation.step()
    assert simulation.domain.rebuilds == rebuilds
    assert 4 <= len(ledger.entries) <= MOST and ledger.entries.count("pairs") <= 2
