"""What the gauges of a case read after some steps."""

from mpi4py import MPI

from psph.output.gauges import gauges_of
from psph.output.ledger import Ledger
from psph.runs.setup import create_particles
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation


def start(case, comm=MPI.COMM_SELF, ledger=None):
    """The simulation of a case before its first step."""
    scene = Scene(case)
    plan = make_plan(scene)
    return Simulation(scene, plan, create_particles(scene, plan, comm), comm, ledger or Ledger())


def started(case, steps=0):
    """A simulation of a case after some steps, and its scene."""
    scene, simulation = Scene(case), start(case)
    for _ in range(steps):
        simulation.step()
    return simulation, scene


def readings(simulation, scene) -> dict[str, float]:
    """What every gauge reads, by column."""
    simulation.settle_pressure()
    found = {}
    for gauge in gauges_of(scene).values():
        found |= dict(zip(gauge.columns(scene), map(float, gauge.row(simulation)), strict=True))
    return found
