"""What rigid bodies may meet, and with which points: bodies, walls and mirrors as they are drawn."""

from collections.abc import Iterator
from itertools import product
from typing import Any, NamedTuple

import numpy as np

from psph.composition.reflections import BELOW
from psph.physics.motion import Fixed, is_rigid
from psph.physics.rigid.body import RigidBody
from psph.scene.forms.form import Faces, Form
from psph.scene.forms.make import form_of
from psph.scene.forms.plain import Round
from psph.scene.joints import apart

LAYER = 1.0
"""Spacings below the face to which sites of a body give a point on the face."""

ON_FACE = 1e-6
"""Of a spacing: so far from the face a drawn corner still is one of the shape."""

SHARP, ROUND = 1.0 - 1e-4, 0.5
"""How fast a corner, and a point on a face that may be round, leave their shape on the way to what they may
meet, at least: the cosine of the angle to the nearest way out."""


class Tips(NamedTuple):
    """With what a shape meets the faces of others: balls of a ``radius`` (n,) m around ``points`` (n, dim) at
    the start, on ways that lead out of it at the cosine ``out`` (n,) at least."""

    points: np.ndarray
    radius: np.ndarray
    out: np.ndarray

    @property
    def middle(self) -> np.ndarray:
        """Of a box around the points, m (1, dim)."""
        return 0.5 * (self.points.min(axis=0) + self.points.max(axis=0))[None]

    def reach(self, point: np.ndarray) -> float:
        """How far they reach from a point (1, dim), m."""
        return float((np.sqrt(((self.points - point) ** 2).sum(axis=1)) + self.radius).max())


class Obstacle(NamedTuple):
    """What a body may meet: a ``shape``, a form or the plane of a mirror, in its place at the start.

    ``key`` is its key in the case; ``tips`` are what it meets the faces of bodies with, None of a mirror;
    ``body`` is the row of a body, −1 of others; ``pose`` that of the map that places it, −1 where it stays;
    ``cuts`` are the rows of bodies that it cuts in two, or is joined to, and does not meet; ``corners``
    (n, dim), m, those of a box around it at the start, None where it has no end.
    """

    key: str
    shape: Any
    tips: Tips | None
    body: int = -1
    pose: int = -1
    cuts: tuple[int, ...] = ()
    corners: np.ndarray | None = None

    def faces(self, points: np.ndarray) -> Faces:
        """How far ``points`` (n, dim) are before its faces at the start, m, and the way out."""
        return self.shape.faces(points)


class MirrorFace(NamedTuple):
    """The plane across ``axis`` at ``at`` m of a mirror; ``side`` −1 where bodies are below it, else 1."""

    axis: int
    at: float
    side: int

    def faces(self, points: np.ndarray) -> Faces:
        """How far points are before it, m, and the way out."""
        normal = np.zeros_like(points)
        normal[:, self.axis] = self.side
        return Faces(self.side * (points[:, self.axis] - self.at), normal)


def obstacles_of(scene, plan, rows) -> Iterator[Obstacle]:
    """Bodies, walls that stay or move as a whole, and mirrors; ``rows`` are the poses of the bodies."""
    ends, joined, names = {}, apart(scene), {}
    for part in scene.layout.parts.bodies:
        names[rows.index(int(plan.materials.pose_of[part]))] = scene.layout.parts[part].name
    for part in scene.layout.parts.boundaries:
        key, motion, shape = (
            scene.layout.parts[part].key,
            scene.census.motions[part],
            form_of(scene.layout.parts[part].shape),
        )
        pose = int(plan.materials.pose_of[part]) if is_rigid(motion) else -1
        own = scene.layout.parts[part].name
        cuts = tuple(row for row, name in names.items() if {own, name} in joined)
        corners = np.array([*product(*zip(*shape.bounds))])
        if isinstance(motion, RigidBody):
            ends[row := rows.index(pose)] = shape.bounds
            tips = tips_of(shape, scene.spacing, [*under_faces(scene, part)])
            yield Obstacle(key, shape, tips, row, pose, cuts, corners)
        elif isinstance(motion, Fixed) or is_rigid(motion):
            yield Obstacle(key, shape, tips_of(shape, scene.spacing), -1, pose, cuts, corners)
    for one in scene.layout.mirror_planes:
        cut = [row for row, (low, up) in ends.items() if low[one.axis] < one.at < up[one.axis]]
        plane = MirrorFace(one.axis, one.at, 1 if one.side == BELOW else -1)
        yield Obstacle("a mirror", plane, None, cuts=tuple(cut))


def tips_of(form: Form, spacing: float, on_faces=()) -> Tips:
    """A disc or a ball as a whole; else the drawn corners, and points ``on_faces``, arrays (n, dim) in m."""
    match form:
        case Round(center=center, radius=radius):
            return Tips(np.array([center]), np.array([radius]), np.array([ROUND]))
    corners = form.corners(spacing)
    if len(corners):
        corners = corners[np.abs(form.faces(corners).away) < ON_FACE * spacing]
    points = np.concatenate([*on_faces, corners])
    out = np.full(len(points), ROUND)
    out[len(points) - len(corners) :] = SHARP
    return Tips(points, np.zeros(len(points)), out)


def under_faces(scene, part: int) -> Iterator[np.ndarray]:
    """Points on the faces of a body, under its outer particles, m (n, dim), by chunks."""
    form = form_of(scene.layout.parts[part].shape)
    for begin, end in scene.layout.lattice.chunks():
        held = scene.layout.materials(begin, end) == part
        grid = scene.layout.lattice.grid(begin, end)
        sites = np.stack([np.broadcast_to(x, held.shape)[held] for x in grid], axis=1)
        away, normal = form.faces(sites)
        outer = away > -LAYER * scene.spacing
        yield sites[outer] - away[outer, None] * normal[outer]
