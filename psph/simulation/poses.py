"""The poses of all that moves as a whole, and their maps in one small array that the loops read."""

from collections.abc import Sequence
from itertools import product

import numpy as np

from psph.physics.motion import is_rigid
from psph.physics.rigid.pose import ACCELERATION, PLACE, PREDICTED, VELOCITY, ZERO, in_space, inertia, maps

UPRIGHT = 1e-12
"""By how much a cosine of a turn may differ from one in what is not turned: angles of 1e-6 rad."""


class Poses:
    """One row for each rigid motion of a scene, the same on every rank without any message.

    ``motions`` have a pose at any time (psph.physics.motion); ``corners`` (rows, n, dim) are points, m,
    around all particles of each row as they stand at the start.  ``movers`` are the works of kinds of matter
    (psph.kinds) that move some of the rows themselves.  ``maps`` (rows, 4, dim, 1 + dim) place
    the particles (psph.physics.rigid.pose.maps); None where nothing is rigid, so that loops have no code
    for it.  ``middle`` are the same at the middle of the last step, along chords: half of both places, and
    their difference by Δt.  The fourth map is the velocity that friction reads; where steps are ``midway``
    it is that of the chord and Δt/2 of the acceleration before, as a particle of the fluid has it: else
    a drum would brake what turns with it by (ωΔt)²/2.  The arrays stay the same objects: loops see each
    change.
    ``frame`` is what a moving frame of reference adds to ``gravity``, m/s² (psph.physics.rigid.pose.inertia),
    or None.
    """

    def __init__(
        self,
        motions: Sequence,
        corners: np.ndarray,
        frame=None,
        gravity=ZERO,
        movers: Sequence = (),
        midway: bool = False,
    ):
        self.motions, self._corners, self._dimensions = tuple(motions), corners, len(gravity)
        self._frame, self._gravity = frame, in_space(gravity)
        self._movers, self._is_midway = movers, midway
        moved = {row for mover in movers for row in mover.rows}
        self._told = sorted(set(range(len(self.motions))) - moved)
        dimensions = self._dimensions
        self.maps = np.zeros((len(motions), 4, dimensions, 1 + dimensions)) if motions else None
        self.middle = self.maps.copy() if motions else None
        self.frame = None if frame is None else np.zeros((2, dimensions, 1 + dimensions))
        self.turn_to(0.0)

    def turn_to(self, time: float) -> None:
        """Have all that is prescribed by time where it is at ``time``, s."""
        for row in self._told:
            self.maps[row, :PREDICTED] = maps(self.motions[row].pose(time), self._dimensions)
        for mover in self._movers:
            self.maps[mover.rows, :PREDICTED] = mover.maps(time)
        if self.motions:
            self.maps[:, PREDICTED] = self.maps[:, VELOCITY]
            self.middle[:] = self.maps
        if self._frame is not None:
            self.frame[:] = inertia(self._frame.pose(time), self._gravity, self._dimensions)

    def advance(self, time: float, dt: float) -> float:
        """The same after a step of ``dt`` s that ends at ``time``.

        Returns the largest acceleration, m/s², that can be told from this step of any of their particles,
        jumps of the velocity included: what the lists must stand.
        """
        if not self.motions:
            self.turn_to(time)
            return 0.0
        before, was = self._at_corners(), self.maps.copy()
        for mover in self._movers:
            mover.drift(time, dt)
        self.turn_to(time)
        self._go_along_chords(was, dt)
        (x, v), (x_0, v_0) = self._at_corners(), before
        strayed, gained = x - x_0 - v_0 * dt, v - v_0
        most = max(2.0 * _longest(strayed) / dt, _longest(gained)) / dt
        return float(most)

    def _go_along_chords(self, was: np.ndarray, dt: float) -> None:
        """The middle of a step of ``dt`` s from where the maps ``was`` had all, and what it predicts."""
        self.middle[:, PLACE] = 0.5 * (was[:, PLACE] + self.maps[:, PLACE])
        chord = (self.maps[:, PLACE] - was[:, PLACE]) / dt
        self.middle[:, VELOCITY] = self.middle[:, PREDICTED] = chord
        if self._is_midway:
            told = self._told
            self.maps[told, PREDICTED] = chord[told] + 0.5 * dt * was[told, ACCELERATION]

    def beside(self, row: int, position: np.ndarray, periods: Sequence[float | None]) -> np.ndarray:
        """Of points at ``position`` (n, dim) the periodic images, m, nearest to the middle of all that moves
        by a row, which is not taken back into the domain when it leaves it."""
        place, middle = self.maps[row, PLACE], self._corners[row].mean(axis=0)
        nearest = position.copy()
        for d, period in enumerate(periods):
            if period is not None:
                now = place[d, 0] + sum(place[d, 1 + e] * middle[e] for e in range(self._dimensions))
                nearest[:, d] -= period * np.rint((nearest[:, d] - now) / period)
        return nearest

    def carried(self, row: int, points: np.ndarray) -> np.ndarray:
        """Where ``points`` (n, dim) have come that moved by a row from the start, m."""
        place = self.maps[row, PLACE]
        return place[:, 0] + sum(points[:, e, None] * place[:, 1 + e] for e in range(self._dimensions))

    def turned(self, row: int) -> frozenset[int]:
        """The axes that the turn of a row mixes with others: along these, what moves repeats no more."""
        place = self.maps[row, PLACE]
        return frozenset(d for d in range(self._dimensions) if place[d, 1 + d] < 1.0 - UPRIGHT)

    def taken_back(self, row: int, position: np.ndarray) -> np.ndarray:
        """Where points at ``position`` (n, dim) were at the start if they moved by a row, m."""
        place = self.maps[row, PLACE]
        away = position - place[:, 0]
        return sum(away[:, d, None] * place[d, 1:] for d in range(self._dimensions))

    @property
    def around(self) -> tuple[np.ndarray, np.ndarray]:
        """The corners of boxes around the particles of each row as they stand now, m (rows, dim)."""
        places = self._at_corners()[0]
        return places.min(axis=1), places.max(axis=1)

    def _at_corners(self) -> tuple[np.ndarray, np.ndarray]:
        """Places, m, and velocities, m/s, of the corners of all rows (rows, n, dim)."""
        return tuple(self._mapped(self.maps[:, which]) for which in (PLACE, VELOCITY))

    def _mapped(self, chosen: np.ndarray) -> np.ndarray:
        """The corners by an affine map each: sums in a fixed order, on any processor."""
        places = np.repeat(chosen[:, None, :, 0], self._corners.shape[1], axis=1)
        for e in range(self._dimensions):
            places = places + chosen[:, None, :, 1 + e] * self._corners[:, :, None, e]
        return places


def corners_of(scene, plan) -> np.ndarray:
    """The corners of boxes around the particles of each rigid motion at the start, m (rows, 2^dim, dim)."""
    corners = []
    for row in range(len(plan.materials.rigid)):
        moved = [
            n for n, s in enumerate(scene.species) if is_rigid(s.motion) and plan.materials.pose_of[n] == row
        ]
        ends = scene.census.lowest[moved].min(axis=0), scene.census.highest[moved].max(axis=0)
        corners.append(list(product(*zip(*ends))))
    return np.array(corners)


def _longest(vectors: np.ndarray) -> float:
    """The length of the longest of vectors (rows, n, dim)."""
    return float(np.sqrt((vectors**2).sum(axis=-1).max()))
