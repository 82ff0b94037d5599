"""How far points are from the faces that a case draws, and which way out."""

from collections.abc import Sequence
from itertools import groupby, product
from typing import NamedTuple

import numpy as np

from psph.case.keys import AXES
from psph.case.mesh import Mesh
from psph.case.shapes import Ball, Box, Cylinder, Difference, Disc, Polygon, Shape
from psph.scene.shapes import bounds, inside

BESIDE = 1e-6
"""Of the size of a shape: so far before a face a point lies outside of it."""

SQUARE = 1e-9
"""Cosine of the angle between faces that meet at a right angle."""

Room = tuple[np.ndarray, np.ndarray]
"""Corners of a box beyond which a shape has no faces: it goes on there."""


class Faces(NamedTuple):
    """The signed distance φ of points from the faces of a shape, ``away`` (n,) m, below zero inside, and its
    gradient, the unit ``normal`` (n, dim) out of the shape."""

    away: np.ndarray
    normal: np.ndarray


def faces_of(shape: Shape, points: np.ndarray, room: Room | None = None) -> Faces:
    """φ and ∇φ of ``shape`` at ``points`` (n, dim), m; exact before and behind a plane face.

    Faces at the border of ``room`` or beyond it are none.
    """
    match shape.form:
        case tuple() as shapes:
            return _joined(shapes, points, room)
        case Difference(base=base, minus=minus):
            return _less(faces_of(base, points, room), [faces_of(one, points, _room(base)) for one in minus])
        case Box(lower=lower, upper=upper):
            return _of_box(points, *_opened(np.array(lower), np.array(upper), room))
        case Disc(center=center, radius=radius) | Ball(center=center, radius=radius):
            away, normal = _radial(points - np.array(center))
            return Faces(away - radius, normal)
        case Cylinder() as cylinder:
            return _of_cylinder(points, cylinder, room)
        case Polygon(points=corners):
            return _of_polygon(points, _bulged(np.array(corners), room))
        case Mesh() as mesh:
            from psph.scene.meshes.surface import surface_of

            found = surface_of(mesh).faces(points)
            if not mesh.shell:
                return Faces(*found)
            away, normal = found
            middle = 0.5 * mesh.shell * (1.0 if mesh.side == "outside" else -1.0)
            side = np.where(away < middle, -1.0, 1.0)
            return Faces(side * (away - middle) - 0.5 * mesh.shell, side[:, None] * normal)


def endless(shape: Shape, *where) -> Shape:
    """A shape where some axes repeat: boxes that fill a period go on on both sides.

    ``where`` are the domain's lower and upper corner, m (dim,), and its periods, m, None where it is open.
    """
    match shape.form:
        case tuple() as shapes:
            return shape.model_copy(update={"union": tuple(endless(one, *where) for one in shapes)})
        case Difference(base=base, minus=minus) as difference:
            parts = {"base": endless(base, *where), "minus": tuple(endless(one, *where) for one in minus)}
            return shape.model_copy(update={"difference": difference.model_copy(update=parts)})
        case Box() as box:
            first, last, low, up = (np.array(of) for of in (*where[:2], box.lower, box.upper))
            most = float((last - first).max())
            fills = (low < first + BESIDE * most) & (up > last - BESIDE * most)
            more = most * (fills & [period is not None for period in where[2]])
            ends = {"lower": tuple(low - more), "upper": tuple(up + more)}
            return shape.model_copy(update={"box": box.model_copy(update=ends)})
        case _:
            return shape


def nearest_faces(shapes: Sequence[Shape], points: np.ndarray) -> Faces:
    """Those of the nearest of some ``shapes`` at ``points`` (n, dim), m, outside of all."""
    return _chosen([faces_of(one, points) for one in shapes], np.argmin)


def corners_of(shape: Shape, apart: float) -> np.ndarray:
    """The corners (n, dim) that a shape draws, m; those inside its own parts among them.  In 3D also points
    on its straight edges, no more than ``apart`` m from each other."""
    match shape.form:
        case tuple() as shapes:
            return np.concatenate([corners_of(one, apart) for one in shapes])
        case Difference(base=base, minus=minus):
            return np.concatenate([corners_of(one, apart) for one in (base, *minus)])
        case Box(lower=lower, upper=upper):
            ends = np.array([*product(*zip(lower, upper))])
            if len(lower) < len(AXES):
                return ends
            pairs = (np.flatnonzero(np.count_nonzero(ends != one, axis=1) == 1) for one in ends)
            sides = [(n, m) for n, others in enumerate(pairs) for m in others if n < m]
            return np.concatenate([ends, *(between(ends[n], ends[m], apart) for n, m in sides)])
        case Polygon(points=points):
            return np.array(points)
        case Mesh() as mesh:
            from psph.scene.meshes.surface import surface_of

            ends, sides = surface_of(mesh).sharp
            return np.concatenate([ends, *(between(*side, apart) for side in sides)])
        case _:
            return np.empty((0, len(bounds(shape)[0])))


def between(one: np.ndarray, other: np.ndarray, apart: float) -> np.ndarray:
    """Points (n, dim) between two, no more than ``apart`` m from each other and from those."""
    pieces = int(np.ceil(np.sqrt(((other - one) ** 2).sum()) / apart))
    return one + np.arange(1, pieces)[:, None] * ((other - one) / max(pieces, 1))


def _chosen(found: Sequence[Faces], choose) -> Faces:
    """Of several faces at each point the one whose distance is chosen."""
    away, normal = (np.stack(of) for of in zip(*found))
    which, row = choose(away, axis=0), np.arange(away.shape[1])
    return Faces(away[which, row], normal[which, row])


def _less(base: Faces, taken: Sequence[Faces]) -> Faces:
    """Of a shape less others, which have no faces beyond it; before a rim the edge is nearest."""
    hole = _chosen([Faces(-one.away, -one.normal) for one in taken], np.argmax)
    found = _chosen([base, hole], np.argmax)
    at_right_angles = np.abs((base.normal * hole.normal).sum(axis=1)) < SQUARE
    rim = np.flatnonzero((base.away > 0.0) & (hole.away > 0.0) & at_right_angles)
    arm = base.away[rim, None] * base.normal[rim] + hole.away[rim, None] * hole.normal[rim]
    found.away[rim], found.normal[rim] = _radial(arm)
    return found


def _room(shape: Shape) -> Room:
    lower, upper = map(np.array, bounds(shape))
    inwards = BESIDE * np.max(upper - lower)
    return lower + inwards, upper - inwards


def _opened(lower: np.ndarray, upper: np.ndarray, room: Room | None) -> Room:
    """Corners of a box that goes on beyond a room."""
    if room is None:
        return lower, upper
    return np.where(lower < room[0], -np.inf, lower), np.where(upper > room[1], np.inf, upper)


def _joined(shapes: Sequence[Shape], points: np.ndarray, room: Room | None) -> Faces:
    """Of a union: faces that lie within other parts are none."""
    found = [faces_of(one, points, room) for one in shapes]
    if len(shapes) == 1:
        return found[0]
    whole = _chosen(found, np.argmin)
    within = np.flatnonzero(whole.away <= 0.0)
    if len(within):
        real = []
        for number, (own, part) in enumerate(zip(shapes, found)):
            lower, upper = bounds(own)
            step = BESIDE * max(up - low for low, up in zip(lower, upper))
            there = part.normal[within] * (step - part.away[within, None])
            before = [*(points[within] + there).T]
            others = [one for k, one in enumerate(shapes) if k != number]
            hidden = np.logical_or.reduce([inside(one, before, 0.0) for one in others])
            away = np.where(hidden | (part.away[within] > 0.0), -np.inf, part.away[within])
            real.append(Faces(away, part.normal[within]))
        nearest = _chosen(real, np.argmax)
        known = np.isfinite(nearest.away)
        whole.away[within[known]], whole.normal[within[known]] = nearest.away[known], nearest.normal[known]
    return whole


def _radial(arm: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lengths and directions of vectors (n, dim); the first axis where there is none."""
    length = np.sqrt((arm**2).sum(axis=1))
    normal = arm / np.where(length > 0.0, length, 1.0)[:, None]
    normal[length == 0.0, 0] = 1.0
    return length, normal


def _of_box(points: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> Faces:
    below, above = lower - points, points - upper
    beyond, row = np.maximum(below, above), np.arange(len(points))
    sign, nearest = np.where(below > above, -1.0, 1.0), beyond.argmax(axis=1)
    flat = np.zeros_like(points)
    flat[row, nearest] = sign[row, nearest]
    outer = np.maximum(beyond, 0.0)
    aslant = np.count_nonzero(outer, axis=1) > 1
    away, normal = _radial(sign * outer)
    return Faces(
        np.where(aslant, away, beyond[row, nearest]),
        np.where(aslant[:, None], normal, flat),
    )


def _of_cylinder(points: np.ndarray, cylinder: Cylinder, room: Room | None) -> Faces:
    along = AXES.index(cylinder.axis)
    across = [d for d in range(len(AXES)) if d != along]
    length, out = _radial((points - np.array(cylinder.center))[:, across])
    flat, half = np.column_stack([length, points[:, along]]), np.full(len(AXES), 0.5 * cylinder.height)
    lower, upper = _opened(np.array(cylinder.center) - half, np.array(cylinder.center) + half, room)
    ends = np.array([[-np.inf, lower[along]], [cylinder.radius, upper[along]]])
    found = _of_box(flat, *ends)
    normal = np.empty_like(points)
    normal[:, across], normal[:, along] = found.normal[:, :1] * out, found.normal[:, 1]
    return Faces(found.away, normal)


def _bulged(corners: np.ndarray, room: Room | None) -> np.ndarray:
    """Corners of a polygon that goes on where several in a row lie at the border of a room, or beyond it."""
    if room is None:
        return corners
    far = 2.0 * (np.ptp(corners, axis=0) + (room[1] - room[0]))
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


def _of_polygon(points: np.ndarray, corners: np.ndarray) -> Faces:
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
    length, out = _radial(found)
    to_corner = ~on_edge & (length > 0.0)
    away = np.where(to_corner, sign * length, (found * normal).sum(axis=1))
    return Faces(away, np.where(to_corner[:, None], sign[:, None] * out, normal))
