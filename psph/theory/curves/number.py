"""A number of a curve, and what it cannot have."""

import math
from typing import NamedTuple

import numpy as np

CONFIDENCE = 0.9
"""Of the intervals."""

NORMAL = 1.6449
"""Standard errors on either side that hold a normal number with that confidence."""


class CurveNumber(NamedTuple):
    """A ``value``, the ``time`` in s at which the curve has it, and the ``reach`` on either side within which
    it lies with 90 %; NaN where there is no such time, or nothing tells the reach."""

    value: float
    time: float = math.nan
    reach: float = math.nan


class NoNumber(ValueError):
    """A curve has no such number; the text says why, in a few words."""


class Curve(NamedTuple):
    """Values over time, s, both (n,): rows without a value (NaN) are left out."""

    time: np.ndarray
    value: np.ndarray

    @classmethod
    def of(cls, time, value) -> "Curve":
        """The rows that have a value, in the order of their times; NoNumber where none has."""
        time, value = np.asarray(time, float), np.asarray(value, float)
        known = np.isfinite(value)
        if not known.any():
            raise NoNumber("no row has a value")
        return cls(time[known], value[known])

    @property
    def lasts(self) -> float:
        """From the first row to the last, s."""
        return float(self.time[-1] - self.time[0])

    @property
    def swing(self) -> float:
        """From the least value to the largest."""
        return float(np.ptp(self.value))

    @property
    def is_still(self) -> bool:
        """Whether it does not change but by rounding."""
        return self.swing <= 1e-12 * float(np.abs(self.value).max())

    def detrended(self) -> "Curve":
        """Less the straight line that fits best."""
        return self if self.lasts == 0.0 else Curve(self.time, self.value - self._line())

    def _line(self) -> np.ndarray:
        middle = self.time - self.time.mean()
        return np.polyval(np.polyfit(middle, self.value, 1), middle)

    def evenly(self, fewest: int = 8) -> tuple[float, np.ndarray]:
        """The step, s, of equal steps as long as the rows' in the middle, and the values there, on straight
        lines.  NoNumber where there are fewer than ``fewest`` rows."""
        if len(self.time) < fewest or self.lasts == 0.0:
            raise NoNumber(f"{len(self.time)} rows are too few")
        count = max(fewest, round(self.lasts / float(np.median(np.diff(self.time)))) + 1)
        at = np.linspace(self.time[0], self.time[-1], count)
        return float(at[1] - at[0]), np.interp(at, self.time, self.value)
