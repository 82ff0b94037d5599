"""A run that stops as a held body is let go, goes on as if it had not stopped."""

import numpy as np
import pytest
from drafts import draft
from mpi4py import MPI
from runs.resuming import go_on_alike, keep, steps, taken_up

SCENE = """
space = { dimensions = 2, spacing = 0.05 }
time = { end = 1.0, step = 5e-4 }
physics.gravity = [0.0, -9.81]
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.3] }
pressure = "hydrostatic"
[walls.tank]
shape.difference.from.box = { lower = [-0.15, -0.15], upper = [1.15, 0.7] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [1.0, 0.7] } }]
[bodies.block]
shape.box = { lower = [0.4, 0.2], upper = [0.6, 0.4] }
density = 700.0
held = 0.00525
velocity = [0.2, 0.0]
spin = 1.0
"""
"""The block is let go in the middle of the eleventh step."""


@pytest.mark.parametrize("stop", [9, 10, 11, 12])
def test_a_stop_about_the_release_changes_nothing(stop, tmp_path):
    case = draft(tmp_path, SCENE)
    simulation = steps(case, MPI.COMM_SELF, stop)
    bodies = simulation.engine.of("bodies").bodies
    assert bool(np.any(bodies.ahead)) == bool(bodies.loose[0, 0]) == (stop > 10)
    again = taken_up(case, keep(simulation, case, tmp_path), MPI.COMM_SELF)
    go_on_alike(simulation, again, 40, rebuilds=0)
    assert bodies.loose[0, 0] == 1.0 and bodies.angle[0] == pytest.approx(0.02, abs=0.01)
