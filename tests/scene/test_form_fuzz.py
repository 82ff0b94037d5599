"""Hundreds of shapes drawn at random, one within another: what holds of any shape holds of each."""

import numpy as np
import pytest

from psph.case.shapes import Shape
from psph.scene.forms.make import form_of
from psph.scene.shapes import inside

SHAPES = 150
"""For each seed."""


class Drawing:
    """Random tables of shapes."""

    def __init__(self, seed):
        self.rng = np.random.default_rng(seed)

    def point(self, dim):
        return self.rng.normal(size=dim).tolist()

    def size(self, low=0.2, high=1.0):
        return float(self.rng.uniform(low, high))

    def place(self, dim):
        """Keys that place a shape, some of them."""
        axis = {"axis": self.point(3)} if dim == 3 else {}
        degrees = float(self.rng.choice([90.0, 30.0, -45.0, 180.0, 12.3]))
        keys = {
            "scale": self.size(0.5, 2.0),
            "mirror": {"at": self.point(dim), "normal": self.point(dim)},
            "rotate": [{"degrees": degrees, "about": self.point(dim)} | axis],
            "move": self.point(dim),
            "repeat": [{"count": int(self.rng.integers(2, 4)), "step": self.point(dim)}],
        }
        return {name: value for name, value in keys.items() if self.rng.random() < 0.25}

    def shape(self, dim, depth=0):
        """A shape of so many dimensions, two deep at most."""
        names = ["box", "disc" if dim == 2 else "ball", "polygon" if dim == 2 else "cylinder"]
        names += ["cone", "prism", "revolution"] if dim == 3 else []
        names += ["union", "difference", "intersection", "shell"] if depth < 2 else []
        name = str(self.rng.choice(names))
        return {name: getattr(self, name)(dim, depth)} | self.place(dim)

    def box(self, dim, depth):
        low = self.point(dim)
        return {"lower": low, "upper": [x + self.size() for x in low]}

    def disc(self, dim, depth):
        return {"center": self.point(dim), "radius": self.size()}

    ball = disc

    def polygon(self, dim, depth):
        angles = np.sort(self.rng.random(self.rng.integers(3, 7))) * 2 * np.pi
        return {"points": np.column_stack([np.cos(angles), np.sin(angles)]).tolist()}

    def cylinder(self, dim, depth):
        axis = self.point(3) if self.rng.random() < 0.5 else "y"
        return {"center": self.point(3), "axis": axis, "radius": self.size(), "height": self.size()}

    def cone(self, dim, depth):
        end = float(self.rng.choice([0.0, 0.3]))
        return {"begin": self.point(3), "end": self.point(3), "radius": self.size(), "end_radius": end}

    def prism(self, dim, depth):
        along = str(self.rng.choice(["x", "y", "z"]))
        return {"profile": self.shape(2, depth + 1), "along": along, "lower": 0.0, "upper": self.size()}

    def revolution(self, dim, depth):
        profile = {"union": [self.shape(2, 2)], "move": [6.0, 0.0]}
        return {"profile": profile, "center": self.point(3), "axis": self.point(3)}

    def union(self, dim, depth):
        return [self.shape(dim, depth + 1) for _ in range(2)]

    def difference(self, dim, depth):
        return {"from": self.shape(dim, depth + 1), "minus": [self.shape(dim, depth + 1)]}

    def intersection(self, dim, depth):
        plane = {"half_space": {"at": self.point(dim), "normal": self.point(dim)}}
        return [self.shape(dim, depth + 1), plane]

    def shell(self, dim, depth):
        side = str(self.rng.choice(["inside", "outside"]))
        return {"of": self.shape(dim, depth + 1), "thickness": self.size(0.05, 0.3), "side": side}


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.filterwarnings("error")
def test_any_shape(seed):
    """It lies in its box; φ is below zero in it and has a direction; a grid holds what its points do."""
    drawing, rng, held_at_all = Drawing(seed), np.random.default_rng(seed), 0
    for _ in range(SHAPES):
        dim = int(rng.integers(2, 4))
        shape = Shape.model_validate(drawing.shape(dim))
        form = form_of(shape)
        lower, upper = map(np.array, form.bounds)
        size = np.maximum(upper - lower, 0.01)
        points = lower - 0.3 * size + rng.random((800, dim)) * 1.6 * size
        held = np.broadcast_to(form.holds([*points.T], np.zeros(dim), 0.0), 800)
        beyond = (points < lower - 1e-9).any(axis=1) | (points > upper + 1e-9).any(axis=1)
        away, normal = form.faces(points)
        assert not (held & beyond).any(), shape
        assert np.array_equal(held, away < 0.0), shape
        assert np.allclose(np.linalg.norm(normal, axis=1), 1.0), shape
        open_grid = np.meshgrid(*np.linspace(lower, upper, 8).T, indexing="ij", sparse=True)
        whole = [x.ravel() for x in np.broadcast_arrays(*open_grid)]
        in_grid = np.broadcast_to(inside(shape, open_grid, 1e-9), (8,) * dim).ravel()
        assert np.array_equal(in_grid, np.broadcast_to(inside(shape, whole, 1e-9), 8**dim)), shape
        held_at_all += held.any()
    assert held_at_all > 0.8 * SHAPES
