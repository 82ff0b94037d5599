"""The surfaces of walls in 3D, as triangles: of the shapes that a case has drawn."""

import math
from collections.abc import Iterator

import numpy as np

from psph.case.keys import AXES
from psph.case.mesh import Mesh
from psph.case.shapes import Ball, Box, Cylinder, Difference, Shape
from psph.scene.meshes.surface import surface_of
from psph.scene.shapes import bounds, inside

SIDE, ROUND = 1e-3, 0.05
"""Spacings by which a point on either side of a triangle is off it; the middle of one that stands for a part
of something round is itself up to 0.02 off."""
EDGE = 1e-6
"""Spacings that settle points on an edge."""
ARC = 48
"""Parts of a full turn at least."""

Triangles = np.ndarray
"""Corners (n, 3, 3), m, anticlockwise as seen from outside."""


def surface(shape: Shape, spacing: float, lower: np.ndarray, upper: np.ndarray) -> Triangles:
    """The surface of ``shape`` within the domain from ``lower`` to ``upper`` (3,), m.

    The faces of every part are cut along the edges of all others; what has the inside of the shape on
    one side only is kept.
    """
    parts = list(_parts(shape))
    lines = _lines(parts, spacing, lower, upper)
    kept = []
    for part in parts:
        faces = _faces(part.form, lines, spacing)
        faces = _cut(faces, lower, upper) if isinstance(part.form, Mesh) else faces
        middle = faces.mean(axis=1)
        off = (SIDE if isinstance(part.form, Box) else ROUND) * spacing * _normals(faces)
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


def _parts(shape: Shape) -> Iterator[Shape]:
    """The shapes in it that are made of no others."""
    match shape.form:
        case tuple() as shapes:
            for one in shapes:
                yield from _parts(one)
        case Difference(base=base, minus=minus):
            for one in (base, *minus):
                yield from _parts(one)
        case _:
            yield shape


def _lines(parts: list[Shape], spacing: float, lower: np.ndarray, upper: np.ndarray) -> list[np.ndarray]:
    """Places along each axis at which flat faces are cut: where any part or the domain ends.

    Where a part is round, a grid of the spacing too.
    """
    ends = [end for part in parts for end in bounds(part)]
    cuts = [np.unique(x[np.isfinite(x)]) for x in np.array([lower, upper, *ends]).T]
    if all(isinstance(part.form, Box) for part in parts):
        return cuts
    return [np.union1d(x, np.arange(x[0], x[-1], spacing)) for x in cuts]


def _faces(form: Box | Ball | Cylinder | Mesh, lines: list[np.ndarray], spacing: float) -> Triangles:
    """The surface of a form by itself, cut along ``lines`` where it is flat."""
    match form:
        case Box(lower=lower, upper=upper):
            return np.concatenate(list(_sides(lower, upper, lines)))
        case Ball(center=center, radius=radius):
            turn = _turn(radius, spacing)
            polar = turn[: len(turn) // 2 + 1, None]
            ring = np.sin(polar)
            grid = [ring * np.cos(turn), ring * np.sin(turn), np.cos(polar) + 0 * turn]
            return _triangles(*(c + radius * x for c, x in zip(center, grid)))
        case Mesh():
            return surface_of(form).sheet.corners
        case Cylinder(center=center, axis=axis, radius=radius, height=height):
            return np.concatenate(list(_barrel(center, AXES.index(axis), radius, height, lines, spacing)))


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
    return faces[np.linalg.norm(_cross(faces), axis=1) > 0]


def _sides(lower, upper, lines) -> Iterator[Triangles]:
    cuts = [x[(x >= low) & (x <= high)] for x, low, high in zip(lines, lower, upper)]
    for axis in range(3):
        for place in (lower[axis], upper[axis]):
            others = [cut for d, cut in enumerate(cuts) if d != axis]
            grid = list(np.meshgrid(*others, indexing="ij"))
            grid.insert(axis, np.full_like(grid[0], place))
            yield _triangles(*grid)


def _barrel(center, along: int, radius: float, height: float, lines, spacing: float) -> Iterator[Triangles]:
    turn = _turn(radius, spacing)[None, :]
    low, high = center[along] - height / 2, center[along] + height / 2
    cut = lines[along]
    cut = cut[(cut > low) & (cut < high)]
    rings = np.arange(0.0, radius, spacing)
    for distance, level in (
        (np.full((len(cut) + 2, 1), radius), np.array([low, *cut, high])[:, None]),
        (np.append(rings, radius)[:, None], low),
        (np.append(rings, radius)[:, None], high),
    ):
        grid = [distance * np.cos(turn), distance * np.sin(turn)]
        grid = [x + c for x, c in zip(grid, [c for d, c in enumerate(center) if d != along])]
        grid.insert(along, level + 0 * grid[0])
        yield _triangles(*grid)


def _turn(radius: float, spacing: float) -> np.ndarray:
    """Angles of a full turn in an even number of steps of about a spacing."""
    turn = np.linspace(0.0, 2 * math.pi, 2 * max(ARC // 2, round(math.pi * radius / spacing)) + 1)
    turn[-1] = 0.0  # to the last bit where it began: no seam
    return turn


def _triangles(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> Triangles:
    """Two triangles for each cell of a grid of points, each (n, m); those without an area are left out."""
    points = np.stack([x, y, z], axis=-1)
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    faces = np.concatenate([np.stack(three, axis=-2).reshape(-1, 3, 3) for three in ((a, b, c), (a, c, d))])
    return faces[np.linalg.norm(_cross(faces), axis=1) > 0]


def _cross(faces: Triangles) -> np.ndarray:
    return np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])


def _normals(faces: Triangles) -> np.ndarray:
    across = _cross(faces)
    return across / np.linalg.norm(across, axis=1)[:, None]
