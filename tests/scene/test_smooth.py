"""Which drawn face a particle of a smooth wall has before it."""

import tomllib

import numpy as np
import pytest
import tomli_w
from drafts import draft
from invariances.transforms import TURNS_OF_A_SCENE

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
    return np.abs(smooth_faces(scene, species, np.array(places)).normal)


def test_it_is_that_which_the_way_out_of_all_walls_goes_through(tmp_path):
    """The nearest face of a wall by itself would be the end of the floor, and the side of the ramp below it."""
    scene = Scene(draft(tmp_path, BED))
    floor = normals(scene, "floor", [0.025, -0.075], [0.975, -0.075], [0.5, -0.175])
    assert floor == pytest.approx(np.tile([0.0, 1.0], (3, 1)), abs=1e-12)
    left = normals(scene, "left", [-0.025, 0.025], [-0.025, 0.625], [-0.175, 0.3])
    assert left[:2] == pytest.approx(np.tile([1.0, 0.0], (2, 1)), abs=1e-12)
    ramp = normals(scene, "ramp", [1.125, 0.025], [1.325, 0.175])
    assert ramp == pytest.approx(np.full((2, 2), 0.5**0.5), abs=1e-12)
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


def test_of_faces_as_near_none_is_chosen(tmp_path):
    """The lower one had been, and without gravity the first in the order of the axes."""
    scene = Scene(draft(tmp_path, TANK))
    places = np.array(
        [[-0.0625, -0.0625], [-0.1875, -0.1875], [1.5625, 1.1875], [1.5625, 1.0625], [1.6875, 1.1875]]
    )
    found = smooth_faces(scene, np.full(5, scene.layout.names.index("tank")), places)
    assert found.normal[:2] == pytest.approx(0.0) and found.edge.tolist() == [1.0, 1.0, 0.0, 0.0, 0.0]
    rim, side = found.normal[2], found.side[2]
    assert {tuple((rim + k * side).tolist()) for k in (-1.0, 1.0)} == {(-1.0, 0.0), (0.0, 1.0)}
    assert np.abs(found.normal[3:]).tolist() == [[1.0, 0.0], [0.0, 1.0]] and not found.side[3:].any()


@pytest.mark.parametrize("pull", ([0.0, 0.0], [1.0, -9.0]))
@pytest.mark.parametrize("name", TURNS_OF_A_SCENE)
def test_faces_turn_as_the_scene_does(name, pull, tmp_path):
    turn = TURNS_OF_A_SCENE[name]
    tables = tomllib.loads(TANK) | {"physics": {"gravity": pull}}
    places = np.array(
        [(x, y) for x in np.arange(-0.4375, 2.0, 0.125) for y in (-0.1875, -0.0625, 1.0625, 1.1875)]
    )
    places = places[(places[:, 0] < 0.0) | (places[:, 0] > 1.5) | (places[:, 1] < 0.0)]
    one, other = (
        smooth_faces(scene, np.full(len(places), scene.layout.names.index("tank")), at)
        for scene, at in (
            (Scene(draft(tmp_path, tomli_w.dumps(tables))), places),
            (Scene(draft(tmp_path, tomli_w.dumps(turn.of(tables)))), turn.points(places)),
        )
    )
    assert other.edge.tolist() == one.edge.tolist() and one.side.any() and one.edge.any()
    for k in (-1.0, 1.0):  # which of two is the first does not matter
        turned, found = (
            turn.points(one.normal + k * one.side),
            np.array([other.normal + m * other.side for m in (1, -1)]),
        )
        assert np.minimum(*np.abs(np.abs(found) - np.abs(turned)).max(axis=2)).max() < 1e-12


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


def test_a_face_is_the_same_whatever_else_a_rank_has(tmp_path):
    """On a cone the normal had turned by how far other particles lie below theirs."""
    cone = {"begin": [0.0, 0.0, 0.8], "end": [0.0, 0.0, 0.0], "radius": 0.5}
    tables = tomllib.loads(TANK) | {"physics": {"gravity": [0.0, 0.0, -9.0]}, "walls": {"cone": {}}}
    tables["space"] = {"dimensions": 3, "spacing": 0.125}
    tables["soils"]["bed"]["shape"] = {"box": {"lower": [-0.5, -0.5, -1.0], "upper": [0.5, 0.5, 0.0]}}
    tables["walls"]["cone"]["shape"] = {"cone": cone}
    scene = Scene(draft(tmp_path, tomli_w.dumps(tables)))
    steps = np.arange(-0.4375, 0.8, 0.125)
    grid = np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)
    places = grid[np.hypot(grid[:, 0], grid[:, 1]) < 0.625 * np.minimum(grid[:, 2], 0.79)]
    species = np.full(len(places), scene.layout.names.index("cone"))
    together = smooth_faces(scene, species, places)
    alone = [smooth_faces(scene, species[:1], place[None]).normal[0] for place in places]
    assert together.normal.any() and np.array_equal(together.normal, alone)
