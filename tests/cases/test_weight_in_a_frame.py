"""A frame of reference that is accelerated is gravity changed by as much, in all that reads gravity."""

import numpy as np
import pytest
from drafts import draft
from gauging import start
from long import long_but_for

from psph.physics.damping import diffusion
from psph.physics.fluid.weight import Steady

TANK = """
space = { dimensions = 2, spacing = 0.05 }
time.end = 1.0
physics.sound_speed = 60
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [0.6, 0.5] }
pressure = "hydrostatic"
[walls.tank.shape.difference]
from.box = { lower = [-0.2, -0.2], upper = [0.8, 0.8] }
minus = [{ box = { lower = [0.0, 0.0], upper = [0.6, 0.8] } }]
"""
LIFTED = TANK + "[frame]\nmotion = { acceleration = [0.0, 29.43] }\n"
FORMS = {
    "default": (),
    "density_diffusion": ("physics.fourth_order_diffusion=off", "physics.density_diffusion=0.1"),
    "extrapolated": ("walls.tank.condition=extrapolated",),
}


def after(folder, text, gravity, keys, steps=40):
    """Densities after some steps, kg/m³."""
    simulation = start(draft(folder, text, f"physics.gravity=[0.0, {gravity}]", *keys))
    for _ in range(steps):
        simulation.step()
    order = np.argsort(simulation.store.shown("id"))
    return simulation.store.shown("density")[order]


@pytest.mark.parametrize("form", long_but_for(["default"], FORMS))
def test_a_frame_that_rises_makes_the_water_heavier(tmp_path, monkeypatch, form):
    """The control is the density diffusion that knew the case's gravity alone: floor 19,205 for 19,620 Pa."""
    keys = FORMS[form]
    heavy = after(tmp_path, TANK, -39.24, keys)
    assert after(tmp_path, LIFTED, -9.81, keys) == pytest.approx(heavy, abs=1e-7)
    monkeypatch.setattr(diffusion, "gravitation_of", lambda scene: Steady((None, *scene.gravity[1:])))
    blind = after(tmp_path, LIFTED, -9.81, keys)
    assert np.abs(blind - heavy).max() > 1e-3
