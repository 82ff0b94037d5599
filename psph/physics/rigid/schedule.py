"""When a part of a motion acts, and how it is switched on and off."""

import math
from typing import NamedTuple

Rates = tuple[float, float, float]
"""A value with its first and second derivative by time."""


class ActingTime(NamedTuple):
    """A part acts from ``start`` to ``end``, s; it is switched on, and before the end off, over ``ramp`` s.

    Its share rises by r(u) = 10u³ − 15u⁴ + 6u⁵, u = (t − start)/ramp, and falls so before the end: speed and
    acceleration of what it switches are continuous.  Without a ramp it is 0 or 1.
    """

    start: float = 0.0
    end: float = math.inf
    ramp: float = 0.0

    def share(self, time: float) -> Rates:
        """The share r, 1, 1/s, 1/s²."""
        return self._switched(time)[2:]

    def lasted(self, time: float) -> Rates:
        """∫r dt, the time that a part has acted for, s."""
        return self._switched(time)[1:4]

    def twice_lasted(self, time: float) -> Rates:
        """∫∫r dt dt, s²."""
        return self._switched(time)[:3]

    def _switched(self, time: float) -> tuple[float, ...]:
        on = _risen(time - self.start, self.ramp)
        fall = self.end - self.ramp
        return tuple(a - b for a, b in zip(on, _risen(time - fall, self.ramp))) if time >= fall else on


def _risen(t: float, ramp: float) -> tuple[float, ...]:
    """∫∫r, ∫r, r, r′ and r″ at ``t`` s after the rise began."""
    if t < 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    if t >= ramp:
        s = t - ramp
        return ramp**2 / 7.0 + s * (0.5 * ramp + 0.5 * s), 0.5 * ramp + s, 1.0, 0.0, 0.0
    u = t / ramp
    return (
        ramp**2 * u**5 * (0.5 - 0.5 * u + u * u / 7.0),
        ramp * u**4 * (2.5 - 3.0 * u + u * u),
        u**3 * (10.0 - 15.0 * u + 6.0 * u * u),
        30.0 * u * u * (1.0 - u) ** 2 / ramp,
        60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) / ramp**2,
    )
