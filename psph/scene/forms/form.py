"""What every form answers, and the words that forms share."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

Corner = tuple[float, ...]
Grid = Sequence[np.ndarray]
"""Coordinates x, y, z of points, m, one array per axis; the arrays broadcast to each other."""

Triangles = np.ndarray
"""Corners (n, 3, 3), m, turned either way."""

ASKEW = np.array([1.0, 0.5 * np.sqrt(2.0), np.sqrt(3.0) / 3.0])
"""Towards where points are moved by the tolerance: along no face that a person would draw."""

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


class Form:
    """A region of space of so many ``dimensions``."""

    dimensions: int

    def holds(self, grid: Grid, by: np.ndarray, slack: float) -> np.ndarray:
        """True where a point of a grid lies in it; broadcasts like the grid.

        Straight faces ask for points that are moved ``by`` (dim,), m: the low side of a face is inside.
        Round ones keep no point nearer than ``slack``, m.
        """
        raise NotImplementedError

    def support(self, way: np.ndarray) -> float:
        """The largest x · ``way`` (dim,) of its points x; of what has no end infinity."""
        raise NotImplementedError

    def faces(self, points: np.ndarray, room: Room | None = None) -> Faces:
        """φ and ∇φ at ``points`` (n, dim), m; exact before and behind a plane face.

        Faces at the border of ``room`` or beyond it are none.
        """
        raise NotImplementedError

    def away(self, points: np.ndarray) -> np.ndarray:
        """φ alone (n,), m."""
        return self.faces(points).away

    def corners(self, apart: float) -> np.ndarray:
        """Its sharp corners (n, dim), m, in 3D also points on its straight edges, ``apart`` m at most."""
        return np.empty((0, self.dimensions))

    def straight(self, apart: float) -> np.ndarray:
        """In 2D its corners, and points on its straight edges, ``apart`` m from each other at most."""
        return self.corners(apart)

    def endless(self, lower: np.ndarray, upper: np.ndarray, periods: Sequence[float | None]) -> "Form":
        """The same where some axes repeat: what fills a period goes on on both sides.

        ``lower`` and ``upper`` are the corners of the domain, ``periods`` None where it is open; m.
        """
        return self

    def pieces(self) -> Iterator["Form"]:
        """The forms in it that are made of no others, in their places."""
        yield self

    def surface(self, spacing: float, lines: Sequence[np.ndarray]) -> Triangles:
        """In 3D its surface in pieces of about a ``spacing``, m, or cut along ``lines`` across each axis."""
        raise NotImplementedError

    def outline(self, spacing: float) -> list[np.ndarray]:
        """In 2D its border, lines through points (n, 2) about a ``spacing`` m apart, the last the first."""
        raise NotImplementedError

    @property
    def bounds(self) -> tuple[Corner, Corner]:
        """Lowest and highest corner of a box around it, m."""
        ways = np.eye(self.dimensions)
        lower = tuple(0.0 - self.support(-way) for way in ways)
        return lower, tuple(self.support(way) + 0.0 for way in ways)


def in_its_box(
    form: Form, holds, grid: Grid, by: np.ndarray, slack: float, held: np.ndarray | None = None
) -> np.ndarray:
    """What ``holds`` says, asked only in the box around a form where each array of a grid has an axis of its
    own; or what was ``held`` before, which is changed."""
    shape = np.broadcast_shapes(*(np.shape(x) for x in grid))
    held = np.zeros(shape, bool) if held is None else held
    axes = [np.flatnonzero(np.array(np.shape(x)) > 1) + len(shape) - np.ndim(x) for x in grid]
    own = [axis[0] for axis in axes if len(axis) == 1]
    if len(own) < len(grid) or len(set(own)) < len(own):
        held |= holds(grid, by, slack)
        return held
    part = [slice(None)] * len(shape)
    for x, axis, low, up, d in zip(grid, own, *form.bounds, np.abs(by)):
        near = np.flatnonzero((x.ravel() >= low - 2.0 * d) & (x.ravel() <= up + 2.0 * d))
        part[axis] = slice(near[0], near[-1] + 1) if len(near) else slice(0, 0)
    if held[tuple(part)].size:
        cut = [
            x[tuple(p if n > 1 else slice(None) for p, n in zip(part[len(shape) - x.ndim :], x.shape))]
            for x in grid
        ]
        held[tuple(part)] |= holds(cut, by, slack)
    return held


def along(way: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> float:
    """The largest x · ``way`` of the points x in a box."""
    return float(sum(w * (up if w > 0.0 else low) for w, low, up in zip(way, lower, upper) if w))


def room_in(form: Form) -> Room | None:
    """The box around a form, a trifle smaller; None where it has no end."""
    lower, upper = map(np.array, form.bounds)
    if not np.isfinite([lower, upper]).all():
        return None
    inwards = BESIDE * np.max(upper - lower)
    return lower + inwards, upper - inwards


def between(one: np.ndarray, other: np.ndarray, apart: float) -> np.ndarray:
    """Points (n, dim) between two, no more than ``apart`` m from each other and from those."""
    pieces = int(np.ceil(np.sqrt(((other - one) ** 2).sum()) / apart))
    return one + np.arange(1, pieces)[:, None] * ((other - one) / max(pieces, 1))


def chosen(found: Sequence[Faces], choose) -> Faces:
    """Of several faces at each point the one whose distance is chosen."""
    if len(found) == 1:
        return found[0]
    away, normal = (np.stack(of) for of in zip(*found))
    which, row = choose(away, axis=0), np.arange(away.shape[1])
    return Faces(away[which, row], normal[which, row])


def meeting(one: Faces, other: Faces) -> Faces:
    """Of what lies behind both; before a rim at a right angle the edge is nearest."""
    found = chosen([one, other], np.argmax)
    at_right_angles = np.abs((one.normal * other.normal).sum(axis=1)) < SQUARE
    before = (one.away > 0.0) & (other.away > 0.0) & np.isfinite(one.away + other.away)
    rim = np.flatnonzero(before & at_right_angles)
    arm = one.away[rim, None] * one.normal[rim] + other.away[rim, None] * other.normal[rim]
    found.away[rim], found.normal[rim] = radial(arm)
    return found


def radial(arm: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lengths and directions of vectors (n, dim); the first axis where there is none."""
    length = np.sqrt((arm**2).sum(axis=1))
    normal = arm / np.where(length > 0.0, length, 1.0)[:, None]
    normal[length == 0.0, 0] = 1.0
    return length, normal
