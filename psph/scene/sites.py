"""Sites of a lattice: around a particle, and in a shape."""

import math

import numpy as np

from psph.case.shapes import Shape
from psph.scene.lattice import TOLERANCE, lattice_around
from psph.scene.shapes import bounds, inside


def sites_within(scene, radius: float) -> float:
    """Lattice sites within ``radius`` m of a particle in the bulk."""
    ball = {1: 2.0, 2: math.pi, 3: 4.0 / 3.0 * math.pi}[scene.dimensions]
    return ball * (radius / scene.spacing) ** scene.dimensions - 1.0


def sites_in(scene, shape: Shape, offset: float = 0.0) -> np.ndarray:
    """The sites in a shape (n, dim), m, of the scene's lattice moved by ``offset`` spacings along each
    axis."""
    dx = scene.spacing
    origin = tuple(x + offset * dx for x in scene.case.space.origin)
    lattice = lattice_around([bounds(shape)], origin, dx, scene.layout.axis)
    grid, form = lattice.grid(0, lattice.planes), lattice.shape(0, lattice.planes)
    held = np.broadcast_to(inside(shape, grid, TOLERANCE * dx), form)
    return np.stack([np.broadcast_to(x, form)[held] for x in grid], axis=1)
