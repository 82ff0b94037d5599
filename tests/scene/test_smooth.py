"""Which drawn face a particle of a smooth wall has before it."""

import numpy as np
import pytest
from drafts import draft

from psph.scene import Scene
from psph.scene.smooth import smooth_faces

BED = """
time.end = 1.0
physics.gravity = [0.0, -9.81]
space = { dimensions = 2, spacing = 0.05 }
[soils.bed]
density = 1800.0
young = 2e6
poisson = 0.3
friction_angle = 30.0
shape.polygon.points = [[0.0, 0.0], [1.0, 0.0], [1.5, 0.5], [0.0, 0.5]]
[walls]
floor.shape.box = { lower = [0.0, -0.2], upper = [1.0, 0.0] }
left.shape.box = { lower = [-0.2, -0.2], upper = [0.0, 0.7] }
ramp.shape.polygon.points = [[1.0, 0.0], [1.7, 0.7], [1.7, -0.2], [1.0, -0.2]]
"""


def normals(scene, name, *places):
    """Of particles of a wall at these places."""
    species = np.full(len(places), scene.names.index(name))
    return np.abs(smooth_faces(scene, species, np.array(places)))


def test_it_is_that_which_the_way_out_of_all_walls_goes_through(tmp_path):
    """The nearest face of a wall by itself would be the end of the floor, and the side of the ramp below it."""
    scene = Scene(draft(tmp_path, BED))
    floor = normals(scene, "floor", [0.025, -0.075], [0.975, -0.075], [0.5, -0.175])
    assert floor == pytest.approx(np.tile([0.0, 1.0], (3, 1)), abs=1e-12)
    left = normals(scene, "left", [-0.025, 0.025], [-0.025, 0.625], [-0.175, 0.3])
    assert left[:2] == pytest.approx(np.tile([1.0, 0.0], (2, 1)), abs=1e-12)
    ramp = normals(scene, "ramp", [1.125, 0.025], [1.325, 0.175])
    assert ramp == pytest.approx(np.full((2, 2), 0.5**0.5), abs=1e-12)
    assert np.all((normals(scene, "left", [-0.075, -0.075]) ** 2).sum(axis=1) == 1.0)  # behind the corner
    assert not normals(Scene(draft(tmp_path, BED, "walls.floor.no_slip=true")), "floor", [0.5, -0.025]).any()


def test_the_end_of_a_period_is_no_face(tmp_path):
    extruded = (
        "space={ dimensions=3, spacing=0.05, periodic=['z'], lower=[-0.2, -0.2, 0.0], upper=[1.2, 0.7, 0.5] }",
        "physics.gravity=[0.0, -9.81, 0.0]",
        "soils.bed.shape={ box={ lower=[0.0, 0.0, 0.0], upper=[1.0, 0.5, 0.5] } }",
        "walls={ floor={ shape.box={ lower=[-0.2, -0.2, 0.0], upper=[1.2, 0.0, 0.5] } } }",
    )
    bed = BED[: BED.index("[walls]")].replace(
        "shape.polygon.points = [[0.0, 0.0], [1.0, 0.0], [1.5, 0.5], [0.0, 0.5]]", ""
    )
    scene = Scene(draft(tmp_path, bed, *extruded))
    found = normals(scene, "floor", [0.5, -0.075, 0.025], [0.5, -0.075, 0.475])
    assert found == pytest.approx(np.tile([0.0, 1.0, 0.0], (2, 1)), abs=1e-12)
