"""The surfaces of walls in 3D, as triangles: of the shapes that a case has drawn."""

import numpy as np

from psph.case.shapes import Shape
from psph.scene.forms.form import Form, Triangles
from psph.scene.forms.looks import normals, with_area
from psph.scene.forms.make import form_of
from psph.scene.forms.plain import Boxed
from psph.scene.shapes import bounds, inside

SIDE, ROUND = 1e-3, 0.05
"""Spacings by which a point on either side of a triangle is off it; the middle of one that stands for a part
of something round is itself up to 0.02 off."""
EDGE = 1e-6
"""Spacings that settle points on an edge."""


def surface(shape: Shape, spacing: float, lower: np.ndarray, upper: np.ndarray) -> Triangles:
    """The surface of ``shape`` within the domain from ``lower`` to ``upper`` (3,), m.

    The faces of every part are cut along the edges of all others; what has the inside of the shape on
    one side only is kept.
    """
    parts = list(form_of(shape).pieces())
    lines = _lines(parts, spacing, lower, upper)
    kept = []
    for part in parts:
        faces = part.surface(spacing, lines)
        faces = faces if isinstance(part, Boxed) else _cut(faces, lower, upper)
        middle, across = faces.mean(axis=1), normals(faces)
        off = (SIDE if isinstance(part, Boxed) else ROUND) * spacing
        off = off * across / np.linalg.norm(across, axis=1)[:, None]
        before, behind = (inside(shape, (middle + way * off).T, EDGE * spacing) for way in (1, -1))
        here = ((middle > lower) & (middle < upper)).all(axis=1)
        kept += [faces[here & behind & ~before], faces[here & before & ~behind][:, ::-1]]
    return np.concatenate(kept)


def encloses(shape: Shape, lower: np.ndarray, upper: np.ndarray) -> bool:
    """Whether the box around ``shape`` holds that from ``lower`` to ``upper`` (3,), m."""
    low, high = map(np.array, bounds(shape))
    return bool(((low <= lower) & (high >= upper)).all())


def inwards(faces: Triangles, shape: Shape) -> Triangles:
    """The faces of a wall but for those in the sides of the box around it, which would hide the inside."""
    low, high = map(np.array, bounds(shape))
    near = 1e-6 * (high - low)
    outer = ((faces < low + near).all(axis=1) | (faces > high - near).all(axis=1)).any(axis=1)
    return faces[~outer]


def _lines(parts: list[Form], spacing: float, lower: np.ndarray, upper: np.ndarray) -> list[np.ndarray]:
    """Places along each axis at which flat faces are cut: where any part or the domain ends.

    Where a part is round, a grid of the spacing too.
    """
    ends = [end for part in parts for end in part.bounds]
    cuts = [np.unique(x[np.isfinite(x)]) for x in np.array([lower, upper, *ends]).T]
    if all(isinstance(part, Boxed) for part in parts):
        return cuts
    return [np.union1d(x, np.arange(x[0], x[-1], spacing)) for x in cuts]


def _cut(faces: Triangles, lower: np.ndarray, upper: np.ndarray) -> Triangles:
    """What of ``faces`` lies in the domain from ``lower`` to ``upper`` (3,), m."""
    from trimesh.intersections import slice_faces_plane

    for axis, way in ((axis, way) for axis in range(3) for way in (1.0, -1.0)):
        end = (lower if way > 0.0 else upper)[axis]
        if (way * faces[..., axis] < way * end).any():
            at, across = np.zeros(3), np.zeros(3)
            at[axis], across[axis] = end, way
            corners = faces.reshape(-1, 3)
            places, kept, _ = slice_faces_plane(corners, np.arange(len(corners)).reshape(-1, 3), across, at)
            faces = places[kept]
    return with_area(faces)
