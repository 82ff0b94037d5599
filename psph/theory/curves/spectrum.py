"""Waves of all lengths: the spectrum of a level, and the numbers that stand for it."""

import math

import numpy as np

from psph.theory.curves.number import NORMAL, Curve, CurveNumber, NoNumber
from psph.theory.curves.oscillation import up_crossings

PARTS = 4
"""Into which a record is cut for a spectrum; they overlap by a half, so that seven are averaged."""


FEWEST = 3.0
"""Waves in each part, or a period is not told from the length of the part."""


def spectrum(curve: Curve, parts: int = PARTS) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies f, Hz, and the variance density S, of the unit of the curve squared by Hz.

    By the mean of the periodograms of so many ``parts`` and those between them, each less its straight line
    and under Hann's window (Welch 1967, IEEE Trans. Audio Electroacoust. 15, 70): ∫S df is the variance.
    """
    from scipy.signal import welch  # late: a start of psph has no use for it

    step, even = curve.detrended().evenly()
    frequency, density = welch(even, 1.0 / step, nperseg=max(8, len(even) // parts), detrend="linear")
    return frequency[1:], density[1:]


def significant_height(curve: Curve) -> CurveNumber:
    """H_m0 = 4 √m₀ with the variance m₀ of the curve, less its straight line.

    The reach is that of the variance of a record of the length T, ∫S² df/T (Bendat & Piersol, Random Data).
    """
    even = curve.detrended().evenly()[1]
    if curve.is_still:
        return CurveNumber(0.0, reach=0.0)
    variance = float(even.var())
    frequency, density = spectrum(curve)
    error = math.sqrt(float((density**2).sum()) * (frequency[1] - frequency[0]) / curve.lasts) / variance
    return CurveNumber(4.0 * math.sqrt(variance), reach=NORMAL * 0.5 * 4.0 * math.sqrt(variance) * error)


def peak_period(curve: Curve) -> CurveNumber:
    """T_p = ∫S⁴ df/∫f S⁴ df, s: a mean about the peak of the spectrum, which a single frequency is not sure
    of (Young 1995, J. Waterw. Port Coast. Ocean Eng. 121, 261).  The reach is half a step of the frequencies.
    A short record is cut into fewer parts, so that each has three waves; NoNumber where it has not.
    """
    for parts in (PARTS, 2, 1):
        frequency, density = spectrum(curve, parts)
        if curve.is_still:
            raise NoNumber("it does not swing")
        weight = (density / density.max()) ** 4
        peak = float((frequency * weight).sum() / weight.sum())
        if peak >= FEWEST * frequency[0]:
            return CurveNumber(1.0 / peak, reach=0.5 * (frequency[1] - frequency[0]) / peak**2)
    raise NoNumber(f"it lasts {curve.lasts:g} s, less than three of its waves")


def highest_third(curve: Curve) -> CurveNumber:
    """H_1/3, the mean of the highest third of the waves: each from the least to the largest value between two
    times at which the curve, less its straight line, goes up through zero."""
    own = curve.detrended()
    times = up_crossings(own, 0.0)
    ends = np.searchsorted(own.time, times)
    heights = sorted(float(np.ptp(own.value[a:b])) for a, b in zip(ends, ends[1:]))
    if not heights:
        raise NoNumber("it has no wave from one rise through its mean to the next")
    third = heights[-max(1, round(len(heights) / 3)) :]
    return CurveNumber(float(np.mean(third)))
