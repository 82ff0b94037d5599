"""How densely particles lie, by the compiled loop, against the sum written out by hand."""

import numpy as np
import pytest
from drafts import draft
from mpi4py import MPI

from psph.moments import first_moment
from psph.output.ledger import Ledger
from psph.runs.setup import create_particles
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation

DX = 0.05
TWO = """
space = { dimensions = 2, spacing = 0.05, lower = [0.0, -0.5], upper = [1.0, 1.5], periodic = ["x"] }
time.end = 1.0
physics.sound_speed = 15.0
physics.gravity = [0.0, -9.81]
[walls.floor]
shape.box = { lower = [0.0, -0.2], upper = [1.0, 0.0] }
[fluids.heavy]
shape.box = { lower = [0.0, 0.0], upper = [1.0, 0.4] }
density = 1000.0
pressure = "hydrostatic"
jitter = 0.2
[fluids.light]
shape.box = { lower = [0.0, 0.4], upper = [1.0, 0.8] }
density = 700.0
pressure = "hydrostatic"
jitter = 0.2
seed = 3
"""


def begun(tmp_path, *keys):
    """The scene and a simulation of it before its first step."""
    scene = Scene(draft(tmp_path, TWO, *keys))
    plan = make_plan(scene)
    store = create_particles(scene, plan, MPI.COMM_SELF)
    return scene, Simulation(scene, plan, store, MPI.COMM_SELF, Ledger())


def test_fullness_is_the_volume_of_the_neighbours_over_that_of_a_lattice(tmp_path):
    scene, simulation = begun(tmp_path)
    store = simulation.store
    inner = store.inner
    x = np.array(store["position"])[:2, inner].T
    volume = store["mass"][inner] / store["density"][inner]
    apart = x[:, None] - x[None]
    apart[..., 0] -= np.round(apart[..., 0])
    r = np.hypot(*np.moveaxis(apart, -1, 0))
    near = (r > 0.0) & (r < scene.kernel.support / scene.kernel.inverse_h)
    moment = np.zeros_like(r)
    moment[near] = [d * scene.kernel.dw(d) for d in r[near]]
    expected = moment @ volume / first_moment(scene.kernel, DX, 2)
    fluid = x[:, 1] > 0.0
    assert np.ptp(volume[fluid]) > 0.01 * DX**2 and np.ptp(expected[fluid]) > 0.2
    assert store["fullness"][inner][fluid] == pytest.approx(expected[fluid], rel=1e-9)
