"""Shapes against what they are: volumes, distances, and where turning, mirroring and repeating puts them."""

import math
from itertools import pairwise

import numpy as np
import pytest

from psph.case.shapes import Shape
from psph.scene.forms.make import form_of
from psph.scene.lattice import lattice_around
from psph.scene.shapes import bounds, inside

FINE = 0.02
AWRY = [0.3, -0.5, 0.8]
BOX = {"box": {"lower": [0.1, 0.2, -0.3], "upper": [0.9, 0.6, 0.4]}}
FLAT = {"box": {"lower": [0.1, 0.2], "upper": [0.9, 0.6]}}
BALL = {"ball": {"center": [0.1, 0.2, 0.3], "radius": 0.5}}
RING = {"disc": {"center": [0.6, 0.1], "radius": 0.2}}
WEDGE = {"polygon": {"points": [[0.0, 0.0], [1.0, 0.0], [0.0, 0.5]]}}
TURNED = {"rotate": [{"axis": AWRY, "degrees": 33.0, "about": [0.2, 0.1, 0.0]}], "move": [0.3, 0.0, -0.2]}
TANK = {
    "difference": {
        "from": {"box": {"lower": [-0.2, -0.2, -0.2], "upper": [1.2, 1.0, 0.8]}},
        "minus": [{"box": {"lower": [0.0, 0.0, 0.0], "upper": [1.0, 0.8, 0.8]}}],
    }
}

VOLUMES = {
    "ball": (BALL, 4 / 3 * math.pi * 0.5**3),
    "cylinder in a direction": (
        {"cylinder": {"center": [0.1, 0.0, 0.2], "axis": AWRY, "radius": 0.4, "height": 0.9}},
        math.pi * 0.4**2 * 0.9,
    ),
    "cone": (
        {"cone": {"begin": [0.0, 0.1, 0.2], "end": [0.7, -0.4, 0.9], "radius": 0.5}},
        math.pi * 0.5**2 * math.sqrt(0.49 + 0.25 + 0.49) / 3,
    ),
    "piece of a cone": (
        {"cone": {"begin": [0.0, 0.1, 0.2], "end": [0.0, 0.1, -0.8], "radius": 0.5, "end_radius": 0.2}},
        math.pi * (0.25 + 0.1 + 0.04) / 3,
    ),
    "torus": (
        {"revolution": {"profile": RING, "center": [0.0, 0.2, 0.0], "axis": AWRY}},
        2 * math.pi**2 * 0.6 * 0.2**2,
    ),
    "bowl": (  # Pappus: the area times the way of its centre
        {"revolution": {"profile": WEDGE, "center": [0.0, 0.2, 0.0], "axis": "x"}},
        0.25 * 2 * math.pi / 3,
    ),
    "prism": (
        {"prism": {"profile": WEDGE, "along": "y", "lower": -0.3, "upper": 0.5}},
        0.25 * 0.8,
    ),
    "turned box": (BOX | TURNED, 0.8 * 0.4 * 0.7),
    "box of twice the size": (BOX | {"scale": 1.5}, 1.5**3 * 0.8 * 0.4 * 0.7),
    "half a ball": (
        {"intersection": [BALL, {"half_space": {"at": [0.1, 0.2, 0.3], "normal": AWRY}}]},
        2 / 3 * math.pi * 0.5**3,
    ),
    "five boxes in a circle": (
        {
            "box": {"lower": [0.5, -0.1, 0.0], "upper": [0.9, 0.1, 0.3]},
            "repeat": [{"count": 5, "turn": {"axis": [0.0, 0.0, 1.0], "degrees": 72.0}}],
        },
        5 * 0.4 * 0.2 * 0.3,
    ),
    "six balls in two rows": (
        {
            "ball": {"center": [0.0, 0.0, 0.0], "radius": 0.3},
            "repeat": [{"count": 3, "step": [0.7, 0.0, 0.0]}, {"count": 2, "step": [0.0, 0.7, 0.1]}],
        },
        6 * 4 / 3 * math.pi * 0.3**3,
    ),
    "shell of a ball": (
        {"shell": {"of": BALL, "thickness": 0.2}},
        4 / 3 * math.pi * (0.7**3 - 0.5**3),
    ),
    "rim of a box": (
        {"shell": {"of": BOX, "thickness": 0.1, "side": "inside"}},
        0.8 * 0.4 * 0.7 - 0.6 * 0.2 * 0.5,
    ),
}
SHAPES = pytest.mark.parametrize("shape, volume", VOLUMES.values(), ids=list(VOLUMES))


def sites(shape, spacing=FINE, origin=(0.0, 0.0, 0.0)):
    """The places of a lattice in a shape, (n, dim), in order."""
    shape = Shape.model_validate(shape)
    ends = bounds(shape)
    lattice = lattice_around([ends], origin[: len(ends[0])], spacing, None)
    form = lattice.shape(0, lattice.planes)
    grid = [np.broadcast_to(x, form) for x in lattice.grid(0, lattice.planes)]
    open_grid = inside(shape, lattice.grid(0, lattice.planes), 1e-6 * spacing)
    held = np.broadcast_to(open_grid, form)
    one_by_one = inside(shape, [x.ravel() for x in grid], 1e-6 * spacing)
    assert np.array_equal(one_by_one, held.ravel())  # a grid and its points
    found = np.stack([x[held] for x in grid], axis=1)
    return found[np.lexsort(np.floor(found / spacing).T)]


@SHAPES
def test_volumes(shape, volume):
    assert len(sites(shape)) * FINE**3 == pytest.approx(volume, rel=0.015)


@SHAPES
def test_boxes_around(shape, volume):
    """They hold all, and touch it."""
    (lower, upper), found = bounds(Shape.model_validate(shape)), sites(shape)
    slack = 3.0 * FINE if "half_space" not in str(shape) else math.inf
    for d in range(3):
        assert 0.0 <= found[:, d].min() - lower[d] + FINE and found[:, d].min() - lower[d] < slack
        assert 0.0 <= upper[d] - found[:, d].max() + FINE and upper[d] - found[:, d].max() < slack


@SHAPES
def test_distances(shape, volume):
    """φ has the sign of the inside, a gradient of length 1 that points to the faces, and faces where it ends."""
    form, rng = form_of(Shape.model_validate(shape)), np.random.default_rng(1)
    lower, upper = map(np.array, form.bounds)
    points = lower - 0.1 + rng.random((4000, 3)) * (upper - lower + 0.2)
    away, normal = form.faces(points)
    held = form.holds([*points.T], np.zeros(3), 0.0)
    assert np.array_equal(held, away < 0.0)
    assert np.linalg.norm(normal, axis=1) == pytest.approx(1.0)
    near = np.abs(away) < 0.05
    foot = (points - away[:, None] * normal)[near]
    step = 1e-6  # but for edges, to which a part is nearest alone
    for wrong in (form.faces(foot).away, form.faces(points + step * normal).away - away - step):
        assert np.quantile(np.abs(wrong), 0.94) < 1e-9


def test_a_turned_cylinder_is_as_far_away_as_its_points():
    """Against the nearest of many points on its surface."""
    shape = {"cylinder": {"center": [0.1, 0.0, 0.2], "axis": AWRY, "radius": 0.4, "height": 0.9}}
    form = form_of(Shape.model_validate(shape))
    surface = form.surface(0.01, [np.array([-2.0, 2.0])] * 3).reshape(-1, 3)
    points = np.random.default_rng(2).random((40, 3)) * 3.0 - 1.5
    nearest = np.sqrt(((points[:, None] - surface) ** 2).sum(axis=2).min(axis=1))
    assert np.abs(form.faces(points).away) == pytest.approx(nearest, abs=0.01)


QUARTERS = [
    ({"rotate": [{"degrees": 90.0}]}, {"lower": [-0.6, 0.1], "upper": [-0.2, 0.9]}),
    ({"rotate": [{"degrees": -270.0, "about": [0.1, 0.2]}]}, {"lower": [-0.3, 0.2], "upper": [0.1, 1.0]}),
    ({"rotate": [{"degrees": 180.0}], "move": [1.0, 0.7]}, {"lower": [0.1, 0.1], "upper": [0.9, 0.5]}),
    ({"mirror": {"at": [0.5, 0.0], "normal": [3.0, 0.0]}}, {"lower": [0.1, 0.2], "upper": [0.9, 0.6]}),
    ({"mirror": {"at": [0.0, 0.0], "normal": [1.0, -1.0]}}, {"lower": [0.2, 0.1], "upper": [0.6, 0.9]}),
    ({"rotate": [{"degrees": 45.0}, {"degrees": 45.0}]}, {"lower": [-0.6, 0.1], "upper": [-0.2, 0.9]}),
    ({"scale": 2.0, "move": [-0.3, 0.7]}, {"lower": [-0.1, 1.1], "upper": [1.5, 1.9]}),
]


@pytest.mark.parametrize("far", [0.0, 1e5])
@pytest.mark.parametrize("keys, drawn", QUARTERS)
def test_a_box_turned_by_a_right_angle_is_the_box_drawn_there(keys, drawn, far):
    """Its sites to the last one, where faces go through sites too, and far from the origin."""
    for spacing, on in ((0.1, 0.0), (0.1, 0.05), (0.05, 0.0)):
        origin = (far + on, on)
        there = {"box": {name: [x + far, y] for name, (x, y) in drawn.items()}}
        moved = {"union": [FLAT | keys], "move": [far, 0.0]}
        one, other = sites(moved, spacing, origin), sites(there, spacing, origin)
        assert len(one) and np.array_equal(one, other)


@pytest.mark.parametrize("axis", [[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, 2.0, 0.0]])
@pytest.mark.parametrize(
    "shape", [BOX, TANK, {"cylinder": {"center": [0.0] * 3, "axis": "y", "radius": 0.3, "height": 0.4}}]
)
def test_a_quarter_turn_keeps_every_site(shape, axis):
    """All sites between faces: their number, and their places turned."""
    there = sites(shape | {"rotate": [{"axis": axis, "degrees": 90.0}]}, 0.1)
    here = sites(shape, 0.1)
    turn = np.round(_turn(axis)).astype(int)
    moved = here @ turn.T
    assert len(here) == len(there)
    assert np.allclose(moved[np.lexsort(np.floor(moved / 0.1).T)], there, atol=1e-12)


def _turn(axis):
    from scipy.spatial.transform import Rotation

    return Rotation.from_rotvec(90.0 * np.array(axis) / np.linalg.norm(axis), degrees=True).as_matrix()


@pytest.mark.parametrize("degrees", [0.0, 17.0, 45.0, 90.0, 135.0])
def test_shapes_that_touch_share_no_site_and_leave_none_out(degrees):
    """A block cut in two by a plane through sites, turned as one."""
    turn = {"rotate": [{"degrees": degrees}]}
    left, right = (
        {"box": {"lower": [a, -0.5], "upper": [b, 0.5]}} | turn for a, b in pairwise((-0.5, 0.0, 0.5))
    )
    whole = {"box": {"lower": [-0.5, -0.5], "upper": [0.5, 0.5]}} | turn
    parts = [sites(one, 0.1, (0.05, 0.05)) for one in (left, right)]
    assert sum(map(len, parts)) == len(sites(whole, 0.1, (0.05, 0.05)))
    assert len(sites({"union": [left, right]}, 0.1, (0.05, 0.05))) == len(sites(whole, 0.1, (0.05, 0.05)))


def test_a_shape_drawn_out_is_that_of_three_dimensions():
    """Every row of it is the shape in 2D, where faces go through sites too."""
    flat = {"difference": {"from": FLAT, "minus": [RING, WEDGE]}, "rotate": [{"degrees": 30.0}]}
    one = sites(flat, 0.05)
    for along, others in (("x", [1, 2]), ("y", [0, 2]), ("z", [0, 1])):
        solid = sites({"prism": {"profile": flat, "along": along, "lower": 0.0, "upper": 0.2}}, 0.05)
        rows = {tuple(row) for row in np.floor(solid[:, others] / 0.05)}
        assert len(solid) == 4 * len(one) and rows == {tuple(row) for row in np.floor(one / 0.05)}


def test_a_box_drawn_out_is_a_box():
    form = form_of(
        Shape.model_validate({"prism": {"profile": FLAT, "along": "y", "lower": 0.0, "upper": 2.0}})
    )
    assert form.bounds == ((0.1, 0.0, 0.2), (0.9, 2.0, 0.6)) and type(form).__name__ == "Boxed"


@pytest.mark.parametrize("side", ["inside", "outside"])
@pytest.mark.parametrize("of", [BALL, BOX, BOX | TURNED, TANK])
def test_a_shell_ends_where_its_shape_begins(of, side):
    """No site in both outside, each in one of both inside; and it is as thick as it says."""
    shell = Shape.model_validate({"shell": {"of": of, "thickness": 0.15, "side": side}})
    lower, upper = bounds(shell)
    grid = np.meshgrid(*(np.arange(low, up, 0.05) for low, up in zip(lower, upper)), indexing="ij")
    held, own = inside(shell, grid, 1e-8), inside(Shape.model_validate(of), grid, 1e-8)
    assert held.any() and not (held & (~own if side == "inside" else own)).any()
    away = form_of(Shape.model_validate(of)).faces(np.stack([x.ravel() for x in grid], axis=1)).away
    expected = (away.reshape(held.shape) < 0.15 - 1e-6) & ~own if side == "outside" else own
    expected = expected & (away.reshape(held.shape) > -0.15 + 1e-6)
    assert not (expected & ~held).any()
