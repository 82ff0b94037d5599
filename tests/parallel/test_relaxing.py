"""Fluids that start relaxed have the same bits on any number of ranks."""

import numpy as np
import pytest
from drafts import draft
from mpi4py import MPI

from psph.runs.setup import lattice_particles
from psph.scene import Scene

COMM = MPI.COMM_WORLD
pytestmark = pytest.mark.mpi(min_size=2)

TWO = """
[space]
dimensions = 2
spacing = 0.05
symmetry = ["x.lower"]
lower = [0.0, -0.2]
upper = [1.2, 1.0]
[time]
end = 1.0
[physics]
gravity = [0.0, -10.0]
sound_speed = 30.0
[fluids.water]
shape.box = { lower = [0.0, 0.0], upper = [0.8, 0.4] }
start = "relaxed"
pressure = "hydrostatic"
[fluids.oil]
shape.box = { lower = [0.0, 0.4], upper = [0.8, 0.7] }
start = "relaxed"
density = 800.0
[walls.tank]
shape.difference.from.box = { lower = [0.0, -0.2], upper = [1.0, 1.0] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [0.8, 1.0] } }]
"""
CUBE = """
[space]
dimensions = 3
spacing = 0.1
periodic = ["x", "y", "z"]
lower = [0.0, 0.0, 0.0]
upper = [1.0, 1.0, 1.0]
[time]
end = 1.0
[physics]
sound_speed = 10.0
[fluids.water]
shape.box = { lower = [0.0, 0.0, 0.0], upper = [1.0, 1.0, 1.0] }
start = "relaxed"
"""


def by_id(found):
    """All that particles start with, in the order of their ids."""
    order = np.argsort(found.id)
    return {name: values[order] for name, values in vars(found).items()}


@pytest.mark.parametrize("text", [TWO, CUBE], ids=["two", "cube"])
def test_same_bits_on_any_number_of_ranks(tmp_path, text):
    scene = Scene(draft(tmp_path, text))
    mine = COMM.allgather(vars(lattice_particles(scene, COMM)))
    whole = lattice_particles(scene, MPI.COMM_SELF)
    order = np.argsort(np.concatenate([one["id"] for one in mine]))
    for name, values in by_id(whole).items():
        assert np.array_equal(values, np.concatenate([one[name] for one in mine])[order]), name
    site = whole.position[whole.kind == 0] / scene.spacing % 1.0 - 0.5
    assert np.abs(site).max() > 0.3  # the control: they have moved
