"""Sand that is torn apart flies on as grains and lands: the gap between them is forgotten."""

import numpy as np
from drafts import draft
from gauging import start

THROWN = """
space = { dimensions = 2, spacing = 0.02 }
time.end = 1.0
[soils.sand]
shape.box = { lower = [0.0, 0.0], upper = [0.2, 0.1] }
density = 1800.0
young = 1.0e5
poisson = 0.3
friction_angle = 30.0
velocity_gradient = [[6.0, 0.0], [0.0, 0.0]]
[walls.floor]
shape.box = { lower = [-0.1, -0.36], upper = [0.3, -0.3] }
no_slip = true
"""


def thrown(tmp_path, *more):
    """The least density over that of rest after 0.2 s of a handful of sand that flies apart."""
    simulation = start(draft(tmp_path, THROWN, *more))
    while simulation.time < 0.2:
        simulation.step()
    inner = simulation.store.inner
    soil = simulation.store.group[inner] == 0
    return float(np.array(simulation.store["density"])[inner][soil].min() / 1800.0)


def test_sand_that_flies_apart_keeps_its_density(tmp_path):
    """To the 10 % of a gap that has to close again."""
    assert thrown(tmp_path) > 0.89


def test_without_a_floor_it_thins_out(tmp_path):
    """The control: the guard of densities ends such a run."""
    assert thrown(tmp_path, "physics.tension_floor='off'") < 0.6
