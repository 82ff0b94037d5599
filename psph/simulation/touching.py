"""Where rigid bodies meet each other, walls and mirrors, by the shapes that are drawn."""

from collections.abc import Iterator
from itertools import product
from operator import itemgetter
from typing import Any, NamedTuple

import numpy as np

from psph.case.shapes import Ball, Disc
from psph.composition.mirrors import BELOW
from psph.physics.motion import Fixed, is_rigid
from psph.physics.rigid.bodies import Bodies, Body
from psph.physics.rigid.contact import OUT, Touching, Yielding, approach, solve
from psph.physics.rigid.pose import PLACE, VELOCITY
from psph.scene.bodies import contact_of
from psph.scene.distance import Faces, corners_of, faces_of
from psph.scene.shapes import bounds

LAYER = 1.0
"""Spacings below the face to which sites of a body give a point on the face."""

AHEAD = 0.1
"""Spacings, and twice the way of two bodies in a step, from which points are looked at."""

ON_FACE = 1e-6
"""Of a spacing: so far from the face a drawn corner still is one of the body."""

NEARBY, TOUCH = 1e-3, 0.1
"""Of a spacing: so far beside and before a place on a face it is looked whether another wall hides that; and
of this, how near two are that touch."""

SLANT, ASKEW = 0.5, 1e-4
"""Part of an axis that lies along a face, from which on it leads to a place beside; and one minus the cosine
of the angle from which on two normals are not the same."""

MOST = 8
"""Points of contact of two bodies, or of a body and a wall, that are kept in 2D; half as many more in 3D."""

ASLANT = 2.0
"""How much the difference of two normals counts beside the distance of two points over a body's size."""


class Obstacle(NamedTuple):
    """What a body may meet: a ``shape``, or the plane of a mirror, in its place at the start.

    ``key`` is its key in the case; ``body`` the row of a body, −1 of others; ``pose`` that of the map that
    places it, −1 where it stays; ``beside`` are the shapes of walls that move as it does,
    and how far off, m: their images and its own among them, where the domain repeats; ``cuts`` are the rows
    of bodies that it cuts in two, and does not meet.
    """

    key: str
    shape: Any
    body: int = -1
    pose: int = -1
    beside: tuple[tuple[Any, np.ndarray], ...] = ()
    cuts: tuple[int, ...] = ()

    @property
    def corners(self) -> np.ndarray | None:
        """Those of a box around it at the start, m; None where it has no end."""
        return None if isinstance(self.shape, Plane) else np.array([*product(*zip(*bounds(self.shape)))])

    def faces(self, points: np.ndarray) -> Faces:
        """How far ``points`` (n, dim) are before its faces at the start, m, and the way out."""
        return self.shape.faces(points) if isinstance(self.shape, Plane) else faces_of(self.shape, points)

    def hidden(self, points: np.ndarray, faces: Faces, step: float) -> np.ndarray:
        """Whether walls beside it hide its ``faces`` from ``points`` (n, dim), m.

        So where another wall touches the place on the face and is before it, a ``step`` in m along the
        normal, unless the face goes on bare as far aside: a floor that is drawn in two parts has no edge
        where these meet, and a wall that stands on a floor keeps its foot.
        """
        if not self.beside:
            return np.zeros(len(points), bool)
        away, normal = faces
        feet, least = points - away[:, None] * normal, TOUCH * step
        found = (np.abs(self._others(feet)) < least) & ~self._bare(feet, normal, step)
        for axis in range(points.shape[1]):
            aside = np.eye(points.shape[1])[axis] - normal[:, axis, None] * normal
            size = np.sqrt((aside**2).sum(axis=1))
            aside /= np.where(size > SLANT, size, np.inf)[:, None]
            for way in (-step, step):
                there = feet + way * aside
                beside = self.faces(there)
                same = (np.abs(beside.away) < least) & ((beside.normal * normal).sum(axis=1) > 1.0 - ASKEW)
                found &= ~(same & self._bare(there, normal, step))
        return found

    def _bare(self, feet: np.ndarray, normal: np.ndarray, step: float) -> np.ndarray:
        """Whether no wall beside it is before its faces at ``feet``."""
        return self._others(feet + step * normal) > (1.0 - ASKEW) * step

    def _others(self, points: np.ndarray) -> np.ndarray:
        """How far points are before the nearest wall beside it, m."""
        return np.min([faces_of(shape, points - off).away for shape, off in self.beside], axis=0)


class Plane(NamedTuple):
    """The plane across ``axis`` at ``at`` m of a mirror; ``side`` −1 where bodies are below it, else 1."""

    axis: int
    at: float
    side: int

    def faces(self, points: np.ndarray) -> Faces:
        """How far points are before it, m, and the way out."""
        normal = np.zeros_like(points)
        normal[:, self.axis] = self.side
        return Faces(self.side * (points[:, self.axis] - self.at), normal)


class Overlap(NamedTuple):
    """A body of the row ``body`` is ``depth`` m inside what has the key ``other``; 0 where none is in any."""

    depth: float
    body: int
    other: str


class Contacts:
    """The contacts of the rigid bodies of a ``scene`` with the rows ``rows`` of the ``maps`` that place them.

    A body meets others with points on its faces: those below which its outer particles lie, and its drawn
    corners.  ``restitution`` is the speed after over that before an impact, ``friction`` Coulomb's
    coefficient.  Every rank computes all, with the same bits.
    """

    def __init__(self, scene, plan, rows, maps: np.ndarray):
        self.maps, self._rows, self._spacing = maps, rows, scene.spacing
        self._d, self._periods = scene.dimensions, scene.periods
        self._middle = 0.5 * (np.array(scene.lower) + np.array(scene.upper))
        contact = contact_of(scene)
        self._friction, self._restitution = contact.friction, contact.restitution
        places = np.array([plan.rigid[row].reference[: self._d] for row in rows])
        bodies = range(scene.layout.first_body, len(scene.parts))
        self._row_of = {part: rows.index(int(plan.pose_of[part])) for part in bodies}
        self._own = [on_faces(scene, part) for part, _ in sorted(self._row_of.items(), key=itemgetter(1))]
        self._shifts = [
            np.array(one) for one in product(*((0.0,) if p is None else (-p, 0.0, p) for p in scene.periods))
        ]
        self._obstacles = [*self._all_obstacles(scene, plan)]
        self._reach = np.array([one.reach(one.middle) for one in self._own])
        self._size = np.array([one.reach(at[None]) for one, at in zip(self._own, places)])
        self._touching: Touching | None = None
        self._extra: tuple[np.ndarray, np.ndarray] | None = None

    def meet(self, bodies: Bodies, before: tuple[np.ndarray, np.ndarray], then: float, dt: float) -> None:
        """Impulses on the ``bodies`` so that in the step of ``dt`` s until ``then`` none gets into another.

        Where two would meet within the step they part with the ``restitution`` of the velocities and spins
        ``before`` it; where they rest they come no nearer than they are.  What overlaps is pushed out by a
        velocity that ends with the step.
        """
        speed, spin = bodies.velocity.copy(), bodies.spin_by(bodies.angular_momentum)
        self._touching, self._extra = self.near(bodies, speed, spin, dt), None
        touching, yielding = self._touching, bodies.yielding(then)
        if not len(touching.first):
            return
        gap = np.maximum(touching.gap, 0.0)
        closing = gap + dt * approach(touching, speed, spin) <= 0.0
        bounced = -self._restitution * approach(touching, *before)
        wanted = np.where(closing, np.maximum(bounced, -gap / dt), -gap / dt)
        impulse = solve(touching, yielding, wanted, self._friction, speed, spin)
        pressed = (impulse != 0.0).any(axis=1)
        self._push(bodies, touching, impulse, dt)
        if (touching.gap < 0.0).any():
            wanted = np.maximum(approach(touching, speed, spin), -OUT * touching.gap / dt)
            wanted = np.where(touching.gap < 0.0, wanted, -gap / dt)
            self._extra = _sums(touching, solve(touching, yielding, wanted, 0.0, speed, spin), bodies)
            bodies.shoved(*self._extra)
        self._touching = Touching(*(of[pressed] for of in touching))
        self._yielding: Yielding = yielding

    def rest(self, bodies: Bodies, dt: float) -> None:
        """What came to rest in the step does not set off again by the second half of its kick."""
        touching = self._touching
        if self._extra:
            bodies.shoved(*self._extra, sign=-1.0)
        if touching is None or not len(touching.first):
            return
        speed, spin = bodies.velocity.copy(), bodies.spin_by(bodies.angular_momentum)
        wanted = np.zeros(len(touching.first))
        impulse = solve(touching, self._yielding, wanted, self._friction, speed, spin)
        self._push(bodies, touching, impulse, dt)

    def deepest(self, bodies: Bodies) -> "Overlap":
        """Where a body is deepest inside another, a wall or a mirror."""
        found = Overlap(0.0, -1, "")
        for row, obstacle, near in self._pairs(bodies, 0.0):
            if (depth := -float(near.gap.min())) > found.depth:
                found = Overlap(depth, row, obstacle.key)
        return found

    def near(self, bodies: Bodies, speed: np.ndarray, spin: np.ndarray, dt: float) -> Touching:
        """The points in which bodies may meet in a step of ``dt`` s, at the velocities and spins given."""
        ways = np.sqrt((speed**2).sum(axis=1)) + self._size * np.sqrt((spin**2).sum(axis=1))
        most = AHEAD * self._spacing + 4.0 * dt * float(ways.max())
        found = [near for _, _, near in self._pairs(bodies, most)] or [NOTHING]
        return Touching(*(np.concatenate(of) for of in zip(*found)))

    def _pairs(self, bodies: Bodies, ahead: float) -> Iterator[tuple[int, Obstacle, Touching]]:
        """A body and what it may meet, with the points on its faces nearer to that than ``ahead`` m."""
        centre = np.array([self._carried(row, one.middle)[0] for row, one in zip(self._rows, self._own)])
        reach = self._reach + ahead
        for obstacle in self._obstacles:
            low, high = self._box(obstacle)
            home = self._home(centre)
            if obstacle.body >= 0:
                home = home - self._home(centre[obstacle.body : obstacle.body + 1])
            for shift in self._shifts:
                there = centre + shift + home
                near = ((there + reach[:, None] >= low) & (there - reach[:, None] <= high)).all(axis=1)
                near[[*obstacle.cuts, *([obstacle.body] if obstacle.body >= 0 else [])]] = False
                rows = np.flatnonzero(near)
                if len(rows):  # φ grows by no more than the way
                    away = obstacle.faces(self._taken_back(obstacle.pose, there[rows])).away
                    rows = rows[away < reach[rows]]
                for row in rows:
                    if found := self._met(bodies, row, obstacle, there[row] - centre[row], ahead):
                        yield int(row), obstacle, found

    def _met(self, bodies: Bodies, row: int, obstacle: Obstacle, shift, ahead: float) -> Touching | None:
        """The points on the faces of a body nearer to an obstacle than ``ahead`` m, or None."""
        own = self._own[row]
        points = self._carried(self._rows[row], own.points)
        then = self._taken_back(obstacle.pose, points + shift)
        away, normal = obstacle.faces(then)
        gap = away - own.radius
        chosen = spread_out(then, gap, normal, ahead, MOST * self._d // 2)
        seen = Faces(away[chosen], normal[chosen])
        chosen = chosen[~obstacle.hidden(then[chosen], seen, NEARBY * self._spacing)]
        if not len(chosen):
            return None
        out = self._turned(obstacle.pose, normal[chosen])
        met = points[chosen] - own.radius[chosen, None] * out
        return self._touching_at(bodies, row, obstacle, met, shift, out, gap[chosen])

    def _touching_at(self, bodies, row, obstacle, points, shift, normal, gap) -> Touching:
        """The ``points`` (n, dim) of a body at an obstacle that stands ``shift`` m from where they see it."""
        count, d = len(points), self._d
        arms, other_arms, out, told = np.zeros((4, count, 3))
        arms[:, :d], out[:, :d] = points - bodies.place[row, :d], normal
        if obstacle.body >= 0:
            other_arms[:, :d] = points + shift - bodies.place[obstacle.body, :d]
        elif obstacle.pose >= 0:
            velocity = self.maps[obstacle.pose, VELOCITY]
            told[:, :d] = velocity[:, 0] + self._taken_back(obstacle.pose, points + shift) @ velocity[:, 1:].T
        rows = np.full(count, row), np.full(count, obstacle.body)
        return Touching(*rows, arms, other_arms, out, gap, told)

    def _push(self, bodies: Bodies, touching: Touching, impulse: np.ndarray, dt: float) -> None:
        push, twist = _sums(touching, impulse, bodies)
        bodies.shoved(push, twist)
        bodies.pressing, bodies.twisting = bodies.pressing + push / dt, bodies.twisting + twist / dt

    def _home(self, places: np.ndarray) -> np.ndarray:
        """Whole periods by which places (n, dim) are moved to be in the domain, m."""
        home = np.zeros_like(places)
        for d, period in enumerate(self._periods):
            if period is not None:
                home[:, d] = -period * np.rint((places[:, d] - self._middle[d]) / period)
        return home

    def _box(self, obstacle: Obstacle) -> tuple[np.ndarray, np.ndarray]:
        """The corners of a box around an obstacle, as it stands now, m."""
        if obstacle.corners is None:
            return np.full(self._d, -np.inf), np.full(self._d, np.inf)
        now = self._carried(obstacle.pose, obstacle.corners)
        return now.min(axis=0), now.max(axis=0)

    def _carried(self, pose: int, points: np.ndarray) -> np.ndarray:
        """Where points (n, dim) of the start have come by a map, m."""
        if pose < 0:
            return points
        place = self.maps[pose, PLACE]
        return place[:, 0] + sum(points[:, e, None] * place[:, 1 + e] for e in range(self._d))

    def _taken_back(self, pose: int, points: np.ndarray) -> np.ndarray:
        """Where points were at the start, m."""
        if pose < 0:
            return points
        place = self.maps[pose, PLACE]
        away = points - place[:, 0]
        return sum(away[:, e, None] * place[e, 1:] for e in range(self._d))

    def _turned(self, pose: int, ways: np.ndarray) -> np.ndarray:
        """Directions of the start as they point now."""
        if pose < 0:
            return ways
        place = self.maps[pose, PLACE]
        return sum(ways[:, e, None] * place[:, 1 + e] for e in range(self._d))

    def _all_obstacles(self, scene, plan) -> Iterator[Obstacle]:
        """Bodies, walls that stay or move as a whole, and mirrors."""
        walls: list[Obstacle] = []
        for part in range(scene.layout.first_wall, len(scene.parts)):
            key, motion, shape = scene.key_of(part), scene.species_in_motion[part], scene.parts[part].shape
            if isinstance(motion, Body):
                row = self._row_of[part]
                yield Obstacle(key, shape, row, self._rows[row])
            elif isinstance(motion, Fixed) or is_rigid(motion):
                walls.append(Obstacle(key, shape, -1, int(plan.pose_of[part]) if is_rigid(motion) else -1))
        for one in walls:
            around = ((k, off) for k in walls if k.pose == one.pose for off in self._shifts)
            beside = ((k.shape, off) for k, off in around if k is not one or off.any())
            near = (pair for pair in beside if touch(one.shape, *pair, scene.spacing))
            yield one._replace(beside=tuple(near))
        for one in scene.mirror_planes:
            ends = {row: bounds(scene.parts[part].shape) for part, row in self._row_of.items()}
            cut = [row for row, (low, up) in ends.items() if low[one.axis] < one.at < up[one.axis]]
            yield Obstacle(
                "a mirror", Plane(one.axis, one.at, 1 if one.side == BELOW else -1), cuts=tuple(cut)
            )


NONE, NOWHERE = np.empty(0, np.int64), np.empty((0, 3))
NOTHING = Touching(NONE, NONE, NOWHERE, NOWHERE, NOWHERE, np.empty(0), NOWHERE)
"""No contact."""


def touch(one, other, off: np.ndarray, near: float) -> bool:
    """Whether boxes around two shapes, the other ``off`` m away, are no farther apart than ``near``, m."""
    (low, high), (lowest, highest) = (np.array(bounds(shape)) for shape in (one, other))
    return bool((low - near <= highest + off).all() and (lowest + off - near <= high).all())


def _sums(touching: Touching, impulse: np.ndarray, bodies: Bodies) -> tuple[np.ndarray, np.ndarray]:
    """All impulses, N s, and their moments about the reference points, N m s, of each body (n, 3)."""
    push, twist = np.zeros_like(bodies.force), np.zeros_like(bodies.force)
    for rows, arms, sign in (
        (touching.first, touching.arms, 1.0),
        (touching.second, touching.other_arms, -1.0),
    ):
        own = rows >= 0
        np.add.at(push, rows[own], sign * impulse[own])
        np.add.at(twist, rows[own], np.cross(arms[own], sign * impulse[own]))
    return push, twist


class OnFaces(NamedTuple):
    """What of a body meets others: balls of a ``radius`` (n,) m around ``points`` (n, dim) at the start."""

    points: np.ndarray
    radius: np.ndarray

    @property
    def middle(self) -> np.ndarray:
        """Of a box around the points, m (1, dim)."""
        return 0.5 * (self.points.min(axis=0) + self.points.max(axis=0))[None]

    def reach(self, point: np.ndarray) -> float:
        """How far they reach from a point (1, dim), m."""
        return float((np.sqrt(((self.points - point) ** 2).sum(axis=1)) + self.radius).max())


def on_faces(scene, part: int) -> OnFaces:
    """A disc or a ball as a whole; else points on the faces, under the outer particles, and drawn corners."""
    shape, found = scene.parts[part].shape, []
    match shape.form:
        case Disc(center=center, radius=radius) | Ball(center=center, radius=radius):
            return OnFaces(np.array([center]), np.array([radius]))
    for begin, end in scene.lattice.chunks():
        held = scene.layout.materials(begin, end) == part
        grid = scene.lattice.grid(begin, end)
        sites = np.stack([np.broadcast_to(x, held.shape)[held] for x in grid], axis=1)
        away, normal = faces_of(shape, sites)
        outer = away > -LAYER * scene.spacing
        found.append(sites[outer] - away[outer, None] * normal[outer])
    corners = corners_of(shape)
    found.append(corners[np.abs(faces_of(shape, corners).away) < ON_FACE * scene.spacing])
    points = np.concatenate(found)
    return OnFaces(points, np.zeros(len(points)))


def spread_out(
    points: np.ndarray, away: np.ndarray, normal: np.ndarray, ahead: float, most: int
) -> np.ndarray:
    """The places of up to ``most`` points (n, dim) less than ``ahead`` m before a face: the nearest, and then
    whichever is farthest from those, in place and normal."""
    near = np.flatnonzero(away < ahead)
    if len(near) <= most:
        return near
    size = float(np.ptp(points, axis=0).max())
    seen = np.column_stack([points[near] / size, ASLANT * normal[near]])
    kept = [int(away[near].argmin())]
    far = ((seen - seen[kept[0]]) ** 2).sum(axis=1)
    while len(kept) < most and far.max() > 0.0:
        kept.append(int(far.argmax()))
        far = np.minimum(far, ((seen - seen[kept[-1]]) ** 2).sum(axis=1))
    return near[np.sort(kept)]
