"""Polygons."""

from collections.abc import Sequence
from functools import cached_property
from itertools import groupby, product
from typing import NamedTuple

import numpy as np

from psph.scene.forms.form import Faces, Form, Grid, Room, between, radial
from psph.scene.forms.looks import across

AT_ONCE = 1 << 21
"""Distances between points and edges that are looked at together: bounds the memory."""


class Polygonal(Form):
    """A polygon of ``points`` (n, 2), m, that closes itself and may turn either way."""

    dimensions = 2

    def __init__(self, points: Sequence[Sequence[float]]):
        self.points = [tuple(map(float, point)) for point in points]

    def holds(self, grid: Grid, by: np.ndarray, slack: float) -> np.ndarray:
        """As psph.scene.forms.form says: a ray to the right crosses the outline an odd number of times."""
        x, y = (coordinate + d for coordinate, d in zip(grid, by))  # the low side of an edge is inside
        odd = np.zeros(np.broadcast_shapes(np.shape(x), np.shape(y)), bool)
        for (x_1, y_1), (x_2, y_2) in zip(self.points, [*self.points[1:], self.points[0]]):
            if y_1 != y_2:
                crossing = x_1 + (y - y_1) * ((x_2 - x_1) / (y_2 - y_1))
                odd ^= ((y < y_1) != (y < y_2)) & (x < crossing)
        return odd

    def support(self, way: np.ndarray) -> float:
        """As psph.scene.forms.form says."""
        return max(sum(x * w for x, w in zip(point, way) if w) for point in self.points)

    def faces(self, points: np.ndarray, room: Room | None = None) -> Faces:
        """As psph.scene.forms.form says."""
        edges = self._edges if room is None else edges_between(bulged(np.array(self.points), room))
        rows = max(1, AT_ONCE // len(edges.corners))
        parts = [_faces(points[k : k + rows], edges) for k in range(0, max(len(points), 1), rows)]
        return Faces(*(np.concatenate(of) for of in zip(*parts)))

    @cached_property
    def _edges(self) -> "PolygonEdges":
        return edges_between(np.array(self.points))

    def corners(self, apart: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        return np.array(self.points)

    def straight(self, apart: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        corners = self.corners(apart)
        sides = zip(corners, np.roll(corners, -1, axis=0))
        return np.concatenate([corners, *(between(*ends, apart) for ends in sides)])

    def outline(self, spacing: float) -> list[np.ndarray]:
        """As psph.scene.forms.form says."""
        return [across(np.array(self.points), spacing)]


def bulged(corners: np.ndarray, room: Room | None) -> np.ndarray:
    """Corners of a polygon that goes on where several in a row lie at the border of a room, or beyond it."""
    if room is None:
        return corners
    far = 2.0 * (np.ptp(corners, axis=0) + np.where(np.isfinite(room[1] - room[0]), room[1] - room[0], 0.0))
    for d, side in product(range(2), (-1.0, 1.0)):
        beyond = side * corners[:, d] > side * room[int(side > 0.0)][d]
        if not beyond.any() or beyond.all():
            continue
        first = int(beyond.argmin())  # one within the room
        corners, beyond = np.roll(corners, -first, axis=0), np.roll(beyond, -first)
        bulge, found = side * far * np.eye(2)[d], []
        for out, run in groupby(range(len(corners)), key=beyond.__getitem__):
            rows = list(run)
            ends = corners[[rows[0], rows[-1]]]
            found.append([ends[0], *(ends + bulge), ends[1]] if out and len(rows) > 1 else corners[rows])
        corners = np.concatenate(found)
    return corners


class PolygonEdges(NamedTuple):
    """The edges of a polygon, m: each leaves one of the ``corners`` (n, 2) as the vector ``edge`` of the
    ``square`` (n,) length, with the ``normal`` out of it; those that are ``rising`` go on to ``upper``, with
    ``slope`` dx/dy."""

    corners: np.ndarray
    edge: np.ndarray
    square: np.ndarray
    normal: np.ndarray
    rising: np.ndarray
    upper: np.ndarray
    slope: np.ndarray


def edges_between(corners: np.ndarray) -> PolygonEdges:
    """The edges between ``corners`` (n, 2)."""
    after = np.roll(corners, -1, axis=0)
    edge = after - corners
    area = (corners[:, 0] * after[:, 1] - after[:, 0] * corners[:, 1]).sum()
    normal = np.column_stack([edge[:, 1], -edge[:, 0]]) * np.sign(area)
    normal /= np.sqrt((normal**2).sum(axis=1))[:, None]
    rising = corners[:, 1] != after[:, 1]
    slope = edge[rising, 0] / edge[rising, 1]
    return PolygonEdges(
        corners, edge, (edge**2).sum(axis=1), normal, corners[rising], after[rising, 1], slope
    )


def _faces(points: np.ndarray, edges: PolygonEdges) -> Faces:
    """By the nearest edge: φ has its normal unless a corner is nearest."""
    arm = points[:, None] - edges.corners
    share = np.clip((arm * edges.edge).sum(axis=2) / edges.square, 0.0, 1.0)
    left = arm - share[:, :, None] * edges.edge
    square, row = (left**2).sum(axis=2), np.arange(len(points))
    nearest = square.argmin(axis=1)
    found, normal = left[row, nearest], edges.normal[nearest]
    on_edge = (share[row, nearest] > 0.0) & (share[row, nearest] < 1.0)
    # Of two edges that meet at the nearest corner, the point may lie before one and behind the other.
    x, y = points[:, :1], points[:, 1:]
    crossing = edges.rising[:, 0] + (y - edges.rising[:, 1]) * edges.slope
    odd = np.logical_xor.reduce(((y < edges.rising[:, 1]) != (y < edges.upper)) & (x < crossing), axis=1)
    sign = np.where(odd, -1.0, 1.0)
    length, out = radial(found)
    to_corner = ~on_edge & (length > 0.0)
    away = np.where(to_corner, sign * length, (found * normal).sum(axis=1))
    return Faces(away, np.where(to_corner[:, None], sign[:, None] * out, normal))
