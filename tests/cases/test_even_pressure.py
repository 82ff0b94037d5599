"""A fluid under the same pressure as its walls stays at rest with corrected gradients."""

from mpi4py import MPI

from psph.case import load
from psph.output.ledger import Ledger
from psph.physics.fluid.correction import GradientCorrection
from psph.runs.setup import create_particles
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation

KEYS = (
    "perturbations=off",
    "space.kernel=wendland-c2",
    "space.smoothing=1.4",
    "space.normalised=false",
    "physics.gradient_correction=1.0",
    "physics.background_pressure=off",
    "physics.tension_floor=off",
    "fluids.fluid.pressure=1000",
)
STEPS = 60


def fastest():
    """The largest speed in the box after some steps, over that of sound."""
    scene = Scene(load("run/cases/hard/box.toml", KEYS))
    plan = make_plan(scene)
    particles = create_particles(scene, plan, MPI.COMM_SELF)
    simulation = Simulation(scene, plan, particles, MPI.COMM_SELF, Ledger())
    for _ in range(STEPS):
        simulation.step()
    return simulation.speed / scene.sound_speed


def test_it_stays_at_rest(monkeypatch):
    """The control corrects in walls as in a fluid: they push, for there is nothing behind them."""
    found = fastest()
    monkeypatch.setattr(GradientCorrection, "in_scene", lambda self, scene: self)
    control = fastest()
    assert control > 5e-5 and found < 1e-12, (found, control)
