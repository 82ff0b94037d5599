"""How far a part of a motion has come: its displacement and its angle by time, with two derivatives.

A law gives, at a time of its schedule, the displacement (x, y, z) in m and the angle in rad as a tuple of
four, and the first and the second derivative of these.
"""

import hashlib
import math
from bisect import bisect_right
from typing import NamedTuple

import numpy as np

from psph.physics.rigid.schedule import ActingTime, Rates
from psph.vectors import Vector, scale, subtract

Ways = tuple[Vector, Vector, Vector]
"""Displacement and angle, their first and their second derivative."""

STILL = (0.0, 0.0, 0.0, 0.0)

LOOKS = 33
"""Places between two rows of a series at which its spline is looked at."""


class SteadyRate(NamedTuple):
    """Constant rates: s = v ∫r dt; ``rate`` v in m/s and rad/s."""

    rate: Vector

    def ways(self, schedule: ActingTime, time: float) -> Ways:
        """The law."""
        return _scaled(self.rate, schedule.lasted(time))

    def drift(self, schedule: ActingTime) -> Vector | None:
        """The velocity, m/s, that it has at all times, or None."""
        return self.rate[:3] if schedule == ActingTime() and self.rate[3] == 0.0 else None


class Accelerated(NamedTuple):
    """Constant accelerations: s = a ∫∫r dt dt; ``change`` a in m/s².  What was gained stays after the end."""

    change: Vector

    def ways(self, schedule: ActingTime, time: float) -> Ways:
        """The law."""
        return _scaled(self.change, schedule.twice_lasted(time))


class Sinusoidal(NamedTuple):
    """A sinusoid with ``amplitude`` A in m and rad, ``turn`` ω = 2πf in rad/s and ``phase`` φ in rad.

    With a ramp s = r A sin(ωτ + φ), τ = t − start.  Without one it begins where the thing stands:
    s = A (sin(ωτ + φ) − sin φ), and it stays where it is at the end.
    """

    amplitude: Vector
    turn: float
    phase: float

    def ways(self, schedule: ActingTime, time: float) -> Ways:
        """The law."""
        moved, speed, change = faded(schedule, time, self._sine)
        return _scaled(self.amplitude, (moved[0], speed[0], change[0]))

    def _sine(self, t: float) -> Ways:
        w = self.turn
        s, c = math.sin(w * t + self.phase), math.cos(w * t + self.phase)
        return (s,), (w * c,), (-w * w * s,)


class Tabulated:
    """A series: cubic between its times, at rest before the first and after the last.

    ``times`` (n,) s since the start of the part; ``ways`` (n, 4) m and rad.  Between two times it
    is the cubic spline with two continuous derivatives whose slope is zero at both ends.  Two of the same
    numbers are equal.
    """

    def __init__(self, times: np.ndarray, ways: np.ndarray):
        from scipy.interpolate import CubicSpline

        self.times = times.tolist()
        self.pieces = CubicSpline(times, ways, bc_type="clamped").c.transpose(1, 0, 2).tolist()
        self._digest = hashlib.sha256(times.tobytes() + np.ascontiguousarray(ways).tobytes()).hexdigest()

    def __eq__(self, other) -> bool:
        return isinstance(other, Tabulated) and self._digest == other._digest

    def __hash__(self) -> int:
        return hash(self._digest)

    def __repr__(self) -> str:
        return f"Tabulated({self._digest[:16]})"

    def ways(self, schedule: ActingTime, time: float) -> Ways:
        """The law: as a sinusoid, with the values of the table in the place of A sin."""
        return faded(schedule, time, self._spline)

    def overshoot(self) -> tuple[float, float, float]:
        """How far the spline goes beyond both of two successive rows, at most, and where.

        Over the range of their column; then the times of these rows, s since the start of the part.
        """
        steps = np.diff(self.times)[:, None]
        a, b, c, d = np.moveaxis(np.array(self.pieces), 1, 0)
        u = steps * np.linspace(0.0, 1.0, LOOKS)[:, None, None]  # (looks, rows, columns)
        way = ((a * u + b) * u + c) * u
        beyond = np.maximum(
            way.max(axis=0) - np.maximum(way[-1], 0.0), np.minimum(way[-1], 0.0) - way.min(axis=0)
        )
        extent = np.ptp(np.concatenate([d, d[-1:] + way[-1, -1:]]), axis=0)
        share = np.divide(beyond, extent, out=np.zeros_like(beyond), where=extent > 0.0).max(axis=1)
        row = int(share.argmax())
        return float(share[row]), self.times[row], self.times[row + 1]

    def _spline(self, t: float) -> Ways:
        inside = min(max(t, self.times[0]), self.times[-1])
        piece = min(bisect_right(self.times, inside), len(self.times) - 1) - 1
        a, b, c, d = self.pieces[piece]
        u = inside - self.times[piece]
        place = tuple(((a[k] * u + b[k]) * u + c[k]) * u + d[k] for k in range(4))
        if inside != t or t == self.times[-1]:
            return place, STILL, STILL
        speed = tuple((3.0 * a[k] * u + 2.0 * b[k]) * u + c[k] for k in range(4))
        return place, speed, tuple(6.0 * a[k] * u + 2.0 * b[k] for k in range(4))


def _scaled(vector: Vector, rates: Rates) -> Ways:
    return tuple(scale(vector, rate) for rate in rates)


def faded(schedule: ActingTime, time: float, law) -> Ways:
    """A law of the time since the start, by its share; without a ramp as far as it has come since."""
    since = time - schedule.start
    if schedule.ramp > 0.0:
        w, dw, ddw = schedule.share(time)
        f, df, ddf = law(since)
        return (
            scale(f, w),
            tuple(w * v + dw * x for x, v in zip(f, df)),
            tuple(w * a + 2.0 * dw * v + ddw * x for x, v, a in zip(f, df, ddf)),
        )
    first = law(0.0)[0]
    place, speed, change = law(min(max(since, 0.0), schedule.end - schedule.start))
    if since < 0.0 or time >= schedule.end:
        speed, change = scale(speed, 0.0), scale(change, 0.0)
    return subtract(place, first), speed, change
