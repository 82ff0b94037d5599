"""Triangles and lines that forms are drawn with."""

import math

import numpy as np

ARC = 48
"""Parts of a full turn at least."""


def turn(radius: float, spacing: float) -> np.ndarray:
    """Angles of a full turn in an even number of steps of about a spacing."""
    angles = np.linspace(0.0, 2 * math.pi, 2 * max(ARC // 2, round(math.pi * radius / spacing)) + 1)
    angles[-1] = 0.0  # to the last bit where it began: no seam
    return angles


def across(corners: np.ndarray, spacing: float) -> np.ndarray:
    """The closed line through ``corners`` (n, dim), with points about a ``spacing`` m apart."""
    ends = np.roll(corners, -1, axis=0)
    counts = np.maximum(1, np.round(np.linalg.norm(ends - corners, axis=1) / spacing)).astype(int)
    parts = [np.arange(n)[:, None] / n * (b - a) + a for a, b, n in zip(corners, ends, counts)]
    return np.concatenate([*parts, corners[:1]])


def cells(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Two triangles for each cell of a grid of points, each (n, m); those without an area are left out."""
    points = np.stack([x, y, z], axis=-1)
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    return with_area(
        np.concatenate([np.stack(three, axis=-2).reshape(-1, 3, 3) for three in ((a, b, c), (a, c, d))])
    )


def with_area(faces: np.ndarray) -> np.ndarray:
    """Those triangles (n, 3, 3) that have one."""
    return faces[np.linalg.norm(normals(faces), axis=1) > 0]


def normals(faces: np.ndarray) -> np.ndarray:
    """Vectors (n, 3) across triangles, twice as long as their areas."""
    return np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])


def filled(ring: np.ndarray, holds, spacing: float) -> np.ndarray:
    """Triangles (n, 3, 2) that fill a ``ring`` (n, 2), m, of about a spacing; ``holds`` tells which points
    (n, 2) lie in it."""
    from scipy.spatial import Delaunay

    sides = [
        np.arange(low + 0.5 * spacing, up, spacing) for low, up in zip(ring.min(axis=0), ring.max(axis=0))
    ]
    middle = np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1).reshape(-1, 2)
    points = np.concatenate([ring[:-1], middle[holds(middle)]])
    faces = points[Delaunay(points).simplices]
    return faces[holds(faces.mean(axis=1))]
