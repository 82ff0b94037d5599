"""Points in shapes."""

import numpy as np
import pytest

from psph.case.shapes import Shape
from psph.scene.shapes import bounds, inside

TOLERANCE = 1e-9
BOX = {"box": {"lower": [0.0, 0.0], "upper": [2.0, 1.0]}}
DISC = {"disc": {"center": [1.0, 0.5], "radius": 0.5}}
TRIANGLE = {"polygon": {"points": [[0.0, 0.0], [2.0, 0.0], [0.0, 1.0]]}}


def holds(shape, *point):
    """Whether a point lies in the shape."""
    grid = [np.array([float(x)]) for x in point]
    return bool(inside(Shape.model_validate(shape), grid, TOLERANCE)[0])


@pytest.mark.parametrize(
    ("shape", "inner", "outer"),
    [
        ({"box": {"lower": [0.0], "upper": [1.0]}}, [(0.5,)], [(-0.1,), (1.1,)]),
        (BOX, [(1.9, 0.1)], [(1.9, 1.1), (2.1, 0.5), (-0.1, 0.5)]),
        (DISC, [(1.3, 0.8)], [(1.4, 0.9), (0.4, 0.5)]),
        (TRIANGLE, [(0.5, 0.5), (1.8, 0.05)], [(1.5, 0.5), (1.0, -0.1), (-0.1, 0.5)]),
        ({"union": [BOX, DISC]}, [(0.1, 0.1)], [(3.0, 0.5)]),
        (
            {"difference": {"from": BOX, "minus": [DISC, TRIANGLE]}},
            [(1.9, 0.9)],
            [(1.3, 0.8), (0.1, 0.1), (3.0, 0.9)],
        ),
        ({"ball": {"center": [0.0, 0.0, 0.0], "radius": 1.0}}, [(0.5, 0.5, 0.5)], [(0.7, 0.7, 0.7)]),
        (
            {"cylinder": {"center": [0.0, 0.0, 1.0], "axis": "z", "radius": 0.5, "height": 2.0}},
            [(0.4, 0.0, 0.1), (0.0, 0.4, 1.9)],
            [(0.4, 0.4, 1.0), (0.0, 0.0, 2.1)],
        ),
        (
            {"cylinder": {"center": [0.0, 0.0, 0.0], "axis": "x", "radius": 0.5, "height": 2.0}},
            [(0.9, 0.4, 0.0)],
            [(0.0, 0.9, 0.0), (1.1, 0.0, 0.0)],
        ),
    ],
    ids=lambda value: next(iter(value)) if isinstance(value, dict) else "",
)
def test_points_inside_and_outside(shape, inner, outer):
    assert all(holds(shape, *point) for point in inner)
    assert not any(holds(shape, *point) for point in outer)


@pytest.mark.parametrize("shape", [BOX, {"polygon": {"points": [[0, 0], [2, 0], [2, 1], [0, 1]]}}])
def test_a_straight_edge_keeps_the_points_on_its_low_side(shape):
    assert holds(shape, 0.0, 0.0)
    assert holds(shape, 0.0 - 1e-15, 0.5)
    assert not holds(shape, 2.0, 0.5)
    assert not holds(shape, 2.0 - 1e-15, 0.5)
    assert not holds(shape, 1.0, 1.0)


def test_a_round_edge_keeps_no_point():
    assert not any(holds(DISC, *p) for p in [(1.5, 0.5), (0.5, 0.5), (1.0, 1.0), (1.0, 0.0)])


def test_a_polygon_may_turn_either_way():
    turned = {"polygon": {"points": TRIANGLE["polygon"]["points"][::-1]}}
    grid = [np.linspace(-1, 3, 41)[:, None], np.linspace(-1, 2, 31)[None, :]]
    one, other = (inside(Shape.model_validate(s), grid, TOLERANCE) for s in (TRIANGLE, turned))
    assert np.array_equal(one, other)


def test_a_hollow_polygon_has_the_right_area():
    star = {"polygon": {"points": [[0, 0], [4, 0], [4, 3], [2, 1], [0, 3]]}}
    x = (np.arange(400) + 0.5) * 0.01
    mask = inside(Shape.model_validate(star), [x[:, None], x[None, :]], TOLERANCE)
    assert mask.sum() * 1e-4 == pytest.approx(12.0 - 4.0, rel=1e-2)


@pytest.mark.parametrize(
    ("shape", "corners"),
    [
        (BOX, ((0.0, 0.0), (2.0, 1.0))),
        (DISC, ((0.5, 0.0), (1.5, 1.0))),
        (TRIANGLE, ((0.0, 0.0), (2.0, 1.0))),
        ({"union": [BOX, {"disc": {"center": [0.0, 0.0], "radius": 1.0}}]}, ((-1, -1), (2, 1))),
        ({"union": [BOX]}, ((0.0, 0.0), (2.0, 1.0))),
        ({"difference": {"from": BOX, "minus": [DISC]}}, ((0.0, 0.0), (2.0, 1.0))),
        ({"ball": {"center": [1.0, 2.0, 3.0], "radius": 1.0}}, ((0, 1, 2), (2, 3, 4))),
        (
            {"cylinder": {"center": [0.0, 0.0, 0.0], "axis": "y", "radius": 1.0, "height": 4.0}},
            ((-1, -2, -1), (1, 2, 1)),
        ),
    ],
)
def test_bounds(shape, corners):
    assert bounds(Shape.model_validate(shape)) == corners
