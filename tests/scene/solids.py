"""Surfaces for the tests of geometry files, and how to write and ask them."""

import numpy as np
import trimesh

from psph.case.mesh import Mesh
from psph.case.shapes import Shape
from psph.scene.shapes import inside

TOLERANCE = 1e-9


def cube(low=0.0, high=1.0):
    """A cube along the axes."""
    return trimesh.creation.box(bounds=[[low] * 3, [high] * 3])


def shape_of(folder, body, ending="stl", **keys):
    """The shape of a surface, written to a file; with the keys of a mesh."""
    corners = body.vertices[body.faces] if isinstance(body, trimesh.Trimesh) else body
    soup = trimesh.Trimesh(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3), process=False)
    path = folder / f"body.{ending}"
    soup.export(path, **({"file_type": "stl_ascii"} if keys.pop("ascii", False) else {}))
    return shape_at(path, **keys)


def shape_at(path, **keys):
    """The shape of a file."""
    return Shape.model_validate({"mesh": {"file": path.name, "scale": 1.0, **keys}}, context=path.parent)


def mesh_of(folder, body, **keys) -> Mesh:
    """The table ``mesh`` of that shape."""
    return shape_of(folder, body, **keys).form


def lattice(low, high, n):
    """Coordinates of n³ sites, each in the middle of its cell, as arrays that broadcast."""
    x = low + (high - low) * (np.arange(n) + 0.5) / n
    return [x.reshape(-1, 1, 1), x.reshape(-1, 1), x]


def points_of(grid):
    """The points of a grid, (n, 3)."""
    return np.stack([x.ravel() for x in np.broadcast_arrays(*grid)], axis=1)


def held(shape, grid):
    """Whether the points of a grid lie in a shape."""
    return inside(shape, grid, TOLERANCE)


def winding(points, corners):
    """The winding number (n,) of a surface about points (n, 3): the sum of the solid angles of its triangles over 4π.

    A. Van Oosterom and J. Strackee, IEEE Trans. Biomed. Eng. 30, 125 (1983).
    """
    total = np.zeros(len(points))
    for triangle in corners:
        a, b, c = (corner - points for corner in triangle)
        la, lb, lc = (np.linalg.norm(x, axis=1) for x in (a, b, c))
        over = np.einsum("ni,ni->n", a, np.cross(b, c))
        under = la * lb * lc + (a * b).sum(1) * lc + (b * c).sum(1) * la + (c * a).sum(1) * lb
        total += 2.0 * np.arctan2(over, under)
    return total / (4.0 * np.pi)
