"""Which points of rigid bodies, walls and mirrors are at whose faces, where they stand now."""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from itertools import product
from operator import attrgetter
from typing import NamedTuple

import numpy as np

from psph.physics.rigid.pose import PLACE, VELOCITY
from psph.scene.forms.form import Faces
from psph.simulation.obstacles import Obstacle, Tips, obstacles_of

NEARBY, TOUCH, FAR = 1e-3, 0.1, 3.0
"""Of a spacing: so far beside and before a place on a face it is looked whether something else covers it;
and of this, how near two are that touch, and how far off nothing matters any more."""

SLANT, ASKEW = 0.5, 1e-4
"""Part of an axis that lies along a face, from which on it leads to a place beside; and one minus the cosine
of the angle from which on two normals are not the same."""

MOST = 8
"""Points of contact of two bodies, or of a body and a wall, that are kept in 2D; half as many more in 3D."""

ASLANT = 2.0
"""How much the difference of two normals counts beside the distance of two points over a body's size."""


class Seen(NamedTuple):
    """An ``obstacle`` beside a body whose places are moved by a ``shift`` (dim,) m, whole periods."""

    obstacle: Obstacle
    shift: np.ndarray


class ContactPoints(NamedTuple):
    """``points`` (n, dim) m, at the faces of the body of the row ``row`` and of what is ``seen`` by it;
    ``normal`` (n, dim) out of that, and ``gap`` (n,) m between the two."""

    row: int
    seen: Seen
    points: np.ndarray
    normal: np.ndarray
    gap: np.ndarray


class Meetings:
    """Where the bodies of a ``scene`` with the rows ``rows`` of the ``maps`` that place them meet others."""

    def __init__(self, scene, plan, rows, maps: np.ndarray):
        self._maps, self._spacing = maps, scene.spacing
        self._d, self._periods = scene.dimensions, scene.layout.periods
        self._middle = 0.5 * (np.array(scene.layout.lower) + np.array(scene.layout.upper))
        periods = product(*((0.0,) if p is None else (-p, 0.0, p) for p in scene.layout.periods))
        self._shifts = [np.array(one) for one in periods]
        self._obstacles = [*obstacles_of(scene, plan, rows)]
        bodies = sorted((one for one in self._obstacles if one.body >= 0), key=attrgetter("body"))
        self._own = [Seen(one, np.zeros(self._d)) for one in bodies]
        self.tips: list[Tips] = [one.tips for one in bodies if one.tips]
        self._reach = np.array([tips.reach(tips.middle) for tips in self.tips])

    def near(self, ahead: float) -> Iterator[ContactPoints]:
        """Points nearer than ``ahead`` m to a face that nothing covers: some for each body and face."""
        pairs, around = [*self._pairs(ahead)], defaultdict(list)
        for row, seen in pairs:
            around[row].append(seen)
        for row, seen in pairs:
            for tips, face, sign in self._sides(row, seen):
                others = [one for one in around[row] if one is not tips and one is not face]
                points, normal, gap, out = self._before(tips, face, ahead)
                free = self._leads_out(tips, points, normal, out)
                free &= ~self._covered(face, points - gap[:, None] * normal, normal, others)[0]
                covered, goes_on = self._covered(tips, points, -normal, others)
                free &= ~(covered & goes_on)
                points, normal, gap = points[free], normal[free], gap[free]
                if len(points):
                    which = spread_out(points, gap, normal, MOST * self._d // 2)
                    yield ContactPoints(row, seen, points[which], sign * normal[which], gap[which])

    def depths(self) -> Iterator[tuple[int, Obstacle, float]]:
        """The row of each body, what it overlaps, and how deep, m."""
        for row, seen in self._pairs(0.0):
            for tips, face, _ in self._sides(row, seen):
                yield row, seen.obstacle, -float(self._before(tips, face, 0.0)[2].min(initial=0.0))

    def velocity(self, seen: Seen, points: np.ndarray) -> np.ndarray:
        """Of something at ``points`` (n, dim) where a body sees them, m/s."""
        if seen.obstacle.pose < 0:
            return np.zeros_like(points)
        velocity = self._maps[seen.obstacle.pose, VELOCITY]
        return velocity[:, 0] + self._taken_back(seen.obstacle.pose, points + seen.shift) @ velocity[:, 1:].T

    def _pairs(self, ahead: float) -> Iterator[tuple[int, Seen]]:
        """The rows of bodies and what is nearer to them than ``ahead`` m."""
        centre = np.array(
            [self._carried(own.obstacle.pose, tips.middle)[0] for own, tips in zip(self._own, self.tips)]
        )
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
                yield from ((int(row), Seen(obstacle, there[row] - centre[row])) for row in rows)

    def _sides(self, row: int, seen: Seen) -> Iterator[tuple[Seen, Seen, float]]:
        """Whose tips meet whose faces, and 1 or −1, the sign of a normal out of what is seen.

        Of two bodies the other one's tips have their turn in its own row.
        """
        own = self._own[row]
        yield own, seen, 1.0
        if seen.obstacle.body < 0 and seen.obstacle.tips:
            yield seen, own, -1.0

    def _before(self, tips: Seen, face: Seen, ahead: float):
        """The ``tips`` of one nearer to a ``face`` of another than ``ahead`` m: where they are (n, dim), m,
        the ways out of the face (n, dim), the gaps (n,), m, and :attr:`Tips.out` (n,)."""
        which = tips.obstacle.tips
        assert which
        points = self._carried(tips.obstacle.pose, which.points) - tips.shift
        near = np.flatnonzero(self._in_its_box(face, points, (ahead + which.radius)[:, None]))
        away, normal = self._faces(face, points[near])
        gap = away - which.radius[near]
        kept = gap < ahead
        near, normal, gap = near[kept], normal[kept], gap[kept]
        return points[near] - which.radius[near, None] * normal, normal, gap, which.out[near]

    def _leads_out(self, tips: Seen, points: np.ndarray, normal: np.ndarray, out: np.ndarray) -> np.ndarray:
        """Whether the way from ``points`` to a face with the ``normal`` leads out of what has these tips: the
        foot of a block that slides on a floor does not meet the end of that below."""
        step = NEARBY * self._spacing
        return self._faces(tips, points - step * normal).away >= out * step

    def _covered(self, face: Seen, feet: np.ndarray, normal: np.ndarray, others: Sequence[Seen]):
        """Whether ``others`` cover a ``face`` with the ``normal`` (n, dim) at ``feet`` (n, dim), m; and
        whether the face goes on aside.

        So where another touches the place on the face and is before it, a step along the normal, unless the
        face goes on bare as far aside: a floor that is drawn in two parts has no edge where these meet, and a
        wall that stands on a floor keeps its foot.
        """
        step, touches, goes_on = NEARBY * self._spacing, *np.zeros((2, len(feet)), bool)
        others = [one for one in others if self._in_its_box(one, feet, FAR * step).any()]
        away = [self._faces(one, feet).away for one in others]
        others = [one for one, far in zip(others, away) if far.min() < FAR * step]
        if not others:
            return touches, goes_on
        touches = (np.abs(np.min(away, axis=0)) < TOUCH * step) & ~self._bare(others, feet, normal)
        which = np.flatnonzero(touches)
        if not len(which):
            return touches, goes_on
        feet, normal = feet[which], normal[which]
        along = np.eye(self._d)[:, None] - normal.T[:, :, None] * normal  # (axis, n, dim)
        size = np.sqrt((along**2).sum(axis=2, keepdims=True))
        aside = step * along / np.where(size > SLANT, size, np.inf)
        there, out = np.concatenate([feet + aside, feet - aside]), np.tile(normal, (2 * self._d, 1, 1))
        flat, ways = there.reshape(-1, self._d), out.reshape(-1, self._d)
        beside = self._faces(face, flat)
        same = np.tile(size[:, :, 0] > SLANT, (2, 1)).ravel() & (np.abs(beside.away) < TOUCH * step)
        same &= (beside.normal * ways).sum(axis=1) > 1.0 - ASKEW
        bare = same & self._bare(others, flat, ways)
        touches[which], goes_on[which] = (
            ~bare.reshape(there.shape[:2]).any(axis=0),
            same.reshape(there.shape[:2]).any(axis=0),
        )
        return touches, goes_on

    def _bare(self, others: Sequence[Seen], feet: np.ndarray, normal: np.ndarray) -> np.ndarray:
        """Whether none of ``others`` is before a face at ``feet``."""
        step = NEARBY * self._spacing
        return self._nearest(others, feet + step * normal) > (1.0 - ASKEW) * step

    def _nearest(self, others: Sequence[Seen], points: np.ndarray) -> np.ndarray:
        """How far points are before the nearest of ``others``, m."""
        return np.min([self._faces(one, points).away for one in others], axis=0)

    def _faces(self, seen: Seen, points: np.ndarray) -> Faces:
        """How far points are before the faces of something where it stands now, m, and the way out."""
        pose = seen.obstacle.pose
        away, normal = seen.obstacle.faces(self._taken_back(pose, points + seen.shift))
        return Faces(away, self._turned(pose, normal))

    def _home(self, places: np.ndarray) -> np.ndarray:
        """Whole periods by which places (n, dim) are moved to be in the domain, m."""
        home = np.zeros_like(places)
        for d, period in enumerate(self._periods):
            if period is not None:
                home[:, d] = -period * np.rint((places[:, d] - self._middle[d]) / period)
        return home

    def _in_its_box(self, seen: Seen, points: np.ndarray, wide) -> np.ndarray:
        """Whether points are in the box around something, or less than ``wide`` m from it (n,)."""
        low, high = self._box(seen.obstacle)
        there = points + seen.shift
        return ((there + wide >= low) & (there - wide <= high)).all(axis=1)

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
        place = self._maps[pose, PLACE]
        return place[:, 0] + sum(points[:, e, None] * place[:, 1 + e] for e in range(self._d))

    def _taken_back(self, pose: int, points: np.ndarray) -> np.ndarray:
        """Where points were at the start, m."""
        if pose < 0:
            return points
        place = self._maps[pose, PLACE]
        away = points - place[:, 0]
        return sum(away[:, e, None] * place[e, 1:] for e in range(self._d))

    def _turned(self, pose: int, ways: np.ndarray) -> np.ndarray:
        """Directions of the start as they point now."""
        if pose < 0:
            return ways
        place = self._maps[pose, PLACE]
        return sum(ways[:, e, None] * place[:, 1 + e] for e in range(self._d))


def spread_out(points: np.ndarray, away: np.ndarray, normal: np.ndarray, most: int) -> np.ndarray:
    """The places of up to ``most`` points (n, dim), ``away`` m before a face: the nearest, and then whichever
    is farthest from those, in place and normal."""
    if len(points) <= most:
        return np.arange(len(points))
    size = float(np.ptp(points, axis=0).max())
    seen = np.column_stack([points / size, ASLANT * normal])
    kept = [int(away.argmin())]
    far = ((seen - seen[kept[0]]) ** 2).sum(axis=1)
    while len(kept) < most and far.max() > 0.0:
        kept.append(int(far.argmax()))
        far = np.minimum(far, ((seen - seen[kept[-1]]) ** 2).sum(axis=1))
    return np.sort(kept)
