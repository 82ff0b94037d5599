"""A fluid under the same pressure as its walls stays at rest with corrected gradients."""

from gauging import started

from psph.case import load
from psph.physics.fluid.correction import GradientCorrection

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
    """The largest speed in the box in any of some steps, over that of sound."""
    simulation, scene = started(load("run/cases/hard/box.toml", KEYS))
    speeds = []
    for _ in range(STEPS):
        simulation.step()
        speeds.append(simulation.speed)
    return max(speeds) / scene.sound_speed


def test_it_stays_at_rest(monkeypatch):
    """The control corrects in walls as in a fluid: they push, for there is nothing behind them."""
    found = fastest()
    monkeypatch.setattr(GradientCorrection, "in_scene", lambda self, scene: self)
    control = fastest()
    assert control > 5e-5 and found < 1e-12, (found, control)
