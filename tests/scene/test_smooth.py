"""Which drawn face a particle of a smooth wall has before it."""

import numpy as np
import pytest
from drafts import draft

from psph.scene import Scene
from psph.scene.layout import Layout
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
    species = np.full(len(places), scene.layout.names.index(name))
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


TANK = """
time.end = 1.0
physics.gravity = [1.0, -9.0]
space = { dimensions = 2, spacing = 0.125 }
[soils.bed]
density = 1800.0
young = 2e6
poisson = 0.3
friction_angle = 30.0
shape.box = { lower = [0.0, 0.0], upper = [1.5, 1.0] }
[walls.tank]
shape.difference.from.box = { lower = [-0.5, -0.5], upper = [2.0, 1.25] }
shape.difference.minus = [{ box = { lower = [0.0, 0.0], upper = [1.5, 1.25] } }]
"""


def test_a_corner_shows_the_lower_of_its_faces_and_a_rim_the_inner_one(tmp_path):
    """As often as a place is as near to both: the first in the order of the axes had decided."""
    scene = Scene(draft(tmp_path, TANK))
    corners = [[-0.0625, -0.0625], [-0.1875, -0.1875], [1.5625, -0.0625]]
    assert normals(scene, "tank", *corners) == pytest.approx(np.tile([0.0, 1.0], (3, 1)), abs=1e-12)
    rims = normals(scene, "tank", [-0.0625, 1.1875], [1.5625, 1.1875])
    assert rims == pytest.approx(np.tile([1.0, 0.0], (2, 1)), abs=1e-12)
    across = Scene(draft(tmp_path, TANK, "physics.gravity=[-9.0,1.0]"))
    assert normals(across, "tank", *corners[:2]) == pytest.approx(np.tile([1.0, 0.0], (2, 1)), abs=1e-12)


def test_the_reach_of_a_wall_is_the_same_at_any_spacing(tmp_path, monkeypatch):
    """It had been divided by the spacing: 400 sites each way at 1 cm."""
    tried = []
    folded = Layout.folded
    monkeypatch.setattr(Layout, "folded", lambda *args: tried.append(0) or folded(*args))
    for text in (TANK, TANK.replace("0.125", "0.0625")):
        tried.clear()
        normals(Scene(draft(tmp_path, text)), "tank", [-0.48, -0.48])
        assert len(tried) <= 2 * 9 * 9


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
