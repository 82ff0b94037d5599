"""Which points lie inside a shape of a case."""

from collections.abc import Sequence

import numpy as np

from psph.case.keys import AXES
from psph.case.mesh import Mesh
from psph.case.shapes import Ball, Box, Cylinder, Difference, Disc, Polygon, Shape

Corner = tuple[float, ...]
Grid = Sequence[np.ndarray]
"""Coordinates x, y, z of points, m, one array per axis; the arrays broadcast to each other."""


def inside(shape: Shape, grid: Grid, tolerance: float) -> np.ndarray:
    """True where a point of ``grid`` lies in the shape; broadcasts like the grid.

    ``tolerance`` (m, far below the spacing) settles points on an edge in spite of rounding: a
    straight edge keeps its points on the low side of the shape, so that two shapes with a common
    edge share no point and leave none out; a round edge keeps none.
    """
    match shape.form:
        case tuple() as shapes:
            return _any(shapes, grid, tolerance)
        case Difference(base=base, minus=minus):
            return inside(base, grid, tolerance) & ~_any(minus, grid, tolerance)
        case Box(lower=lower, upper=upper):
            return _all(_between(x, *ends, tolerance) for x, *ends in zip(grid, lower, upper))
        case Disc(center=center, radius=radius) | Ball(center=center, radius=radius):
            return _within(grid, center, radius, tolerance)
        case Cylinder() as cylinder:
            return _in_cylinder(cylinder, grid, tolerance)
        case Polygon(points=points):
            return _in_polygon(points, grid, tolerance)
        case Mesh() as mesh:
            from psph.scene.meshes.surface import holds

            return holds(mesh, grid, tolerance)


def bounds(shape: Shape) -> tuple[Corner, Corner]:
    """Lowest and highest corner of a box around the shape, m."""
    match shape.form:
        case tuple() as shapes:
            lower, upper = zip(*map(bounds, shapes))
            return tuple(map(min, zip(*lower))), tuple(map(max, zip(*upper)))
        case Difference(base=base):
            return bounds(base)
        case Box(lower=lower, upper=upper):
            return lower, upper
        case Disc(center=center, radius=radius) | Ball(center=center, radius=radius):
            return _around(center, [radius] * len(center))
        case Cylinder(center=center, axis=axis, radius=radius, height=height):
            return _around(center, [0.5 * height if name == axis else radius for name in AXES])
        case Polygon(points=points):
            return tuple(map(min, zip(*points))), tuple(map(max, zip(*points)))
        case Mesh() as mesh:
            from psph.scene.meshes.surface import box_around

            return box_around(mesh)


def _around(center: Corner, reach: Sequence[float]) -> tuple[Corner, Corner]:
    pairs = list(zip(center, reach))
    return tuple(x - r for x, r in pairs), tuple(x + r for x, r in pairs)


def _all(masks) -> np.ndarray:
    result = True
    for mask in masks:
        result = result & mask
    return result


def _any(shapes: Sequence[Shape], grid: Grid, tolerance: float) -> np.ndarray:
    result = False
    for shape in shapes:
        result = result | inside(shape, grid, tolerance)
    return result


def _between(x: np.ndarray, lower: float, upper: float, tolerance: float) -> np.ndarray:
    return (x >= lower - tolerance) & (x < upper - tolerance)


def _within(grid: Grid, center: Corner, radius: float, tolerance: float) -> np.ndarray:
    return sum((x - c) ** 2 for x, c in zip(grid, center)) < (radius - tolerance) ** 2


def _in_cylinder(cylinder: Cylinder, grid: Grid, tolerance: float) -> np.ndarray:
    along = AXES.index(cylinder.axis)
    middle, half = cylinder.center[along], 0.5 * cylinder.height
    across = [d for d in range(len(AXES)) if d != along]
    round_part = _within(
        [grid[d] for d in across], [cylinder.center[d] for d in across], cylinder.radius, tolerance
    )
    return round_part & _between(grid[along], middle - half, middle + half, tolerance)


def _in_polygon(points: Sequence[Corner], grid: Grid, tolerance: float) -> np.ndarray:
    """A ray to the right crosses the outline an odd number of times."""
    x, y = (coordinate + tolerance for coordinate in grid)  # the low side of an edge is inside
    odd = np.zeros(np.broadcast_shapes(x.shape, y.shape), bool)
    for (x_1, y_1), (x_2, y_2) in zip(points, [*points[1:], points[0]]):
        if y_1 != y_2:
            crossing = x_1 + (y - y_1) * ((x_2 - x_1) / (y_2 - y_1))
            odd ^= ((y < y_1) != (y < y_2)) & (x < crossing)
    return odd


def shown(x: Sequence[float]) -> str:
    """A point in a message."""
    return f"[{', '.join(f'{value:.6g}' for value in x)}]"
