"""What the gauges of a case read after some steps."""

from mpi4py import MPI

from psph.output.gauges import gauges_of
from psph.output.ledger import Ledger
from psph.runs.setup import create_particles
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation


def started(case, steps=0):
    """A simulation of a case after some steps, and its scene."""
    scene = Scene(case)
    plan = make_plan(scene)
    simulation = Simulation(
        scene, plan, create_particles(scene, plan, MPI.COMM_SELF), MPI.COMM_SELF, Ledger()
    )
    for _ in range(steps):
        simulation.step()
    return simulation, scene


def readings(simulation, scene) -> dict[str, float]:
    """What every gauge reads, by column."""
    simulation.settle_pressure()
    found = {}
    for gauge in gauges_of(scene, simulation.plan.mirrors).values():
        found |= dict(zip(gauge.columns(scene), map(float, gauge.row(simulation)), strict=True))
    return found
