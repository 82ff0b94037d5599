"""Polygons."""

from collections.abc import Sequence
from itertools import groupby, product

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
        corners = bulged(np.array(self.points), room)
        rows = max(1, AT_ONCE // len(corners))
        parts = [_faces(points[k : k + rows], corners) for k in range(0, max(len(points), 1), rows)]
        return Faces(*(np.concatenate(of) for of in zip(*parts)))

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


def _faces(points: np.ndarray, corners: np.ndarray) -> Faces:
    """By the nearest edge: φ has its normal unless a corner is nearest."""
    edge = np.roll(corners, -1, axis=0) - corners
    area = (corners[:, 0] * np.roll(corners[:, 1], -1) - np.roll(corners[:, 0], -1) * corners[:, 1]).sum()
    edge_normal = np.column_stack([edge[:, 1], -edge[:, 0]]) * np.sign(area)
    edge_normal /= np.sqrt((edge_normal**2).sum(axis=1))[:, None]
    arm = points[:, None] - corners
    share = np.clip((arm * edge).sum(axis=2) / (edge**2).sum(axis=1), 0.0, 1.0)
    left = arm - share[:, :, None] * edge
    square, row = (left**2).sum(axis=2), np.arange(len(points))
    nearest = square.argmin(axis=1)
    found, normal = left[row, nearest], edge_normal[nearest]
    on_edge = (share[row, nearest] > 0.0) & (share[row, nearest] < 1.0)
    # Of two edges that meet at the nearest corner, the point may lie before one and behind the other.
    odd = np.zeros(len(points), bool)
    for (x_1, y_1), (x_2, y_2) in zip(corners, np.roll(corners, -1, axis=0)):
        if y_1 != y_2:
            crossing = x_1 + (points[:, 1] - y_1) * ((x_2 - x_1) / (y_2 - y_1))
            odd ^= ((points[:, 1] < y_1) != (points[:, 1] < y_2)) & (points[:, 0] < crossing)
    sign = np.where(odd, -1.0, 1.0)
    length, out = radial(found)
    to_corner = ~on_edge & (length > 0.0)
    away = np.where(to_corner, sign * length, (found * normal).sum(axis=1))
    return Faces(away, np.where(to_corner[:, None], sign[:, None] * out, normal))
