"""When a curve arrives, how often it crosses a level, and how it swings."""

import math

import numpy as np

from psph.theory.curves.number import NORMAL, Curve, CurveNumber, NoNumber

BAND = 0.05
"""Part of the swing that a curve has to go beyond a level, on either side, to cross it: noise does not."""

PROMINENT = 0.1
"""Part of the swing by which a maximum stands out, or it is none."""

CAP = 0.25
"""Part of what a maximum stands out by, below its top, to which a parabola is fitted."""


HARMONICS = 3
"""Multiples of a frequency that are fitted together: a steep wave has the next two too."""


def arrival(curve: Curve, level: float | None = None) -> CurveNumber:
    """The first time at which the curve reaches a ``level`` on a straight line from row to row; without one
    half of the way from its first value to that which is farthest from it.  NoNumber where it never does."""
    begin = curve.value[0]
    if level is None:
        level = 0.5 * (begin + curve.value[np.abs(curve.value - begin).argmax()])
    past = curve.value >= level if begin < level else curve.value <= level
    if begin == level or not past.any():
        says = "it begins there" if begin == level and curve.swing else "it never comes there"
        raise NoNumber(f"{says}, {level:g}")
    row = int(past.argmax())
    (t_0, t_1), (q_0, q_1) = curve.time[row - 1 : row + 1], curve.value[row - 1 : row + 1]
    time = float(t_0 + (t_1 - t_0) * (level - q_0) / (q_1 - q_0))
    return CurveNumber(time, time)


def up_crossings(curve: Curve, level: float | None = None) -> np.ndarray:
    """The times (n,), s, at which the curve goes up through a ``level``, without one its mean.

    What does not come a twentieth of the swing below and above it does not count.
    """
    off = curve.value - (_mean(curve) if level is None else level)
    band = BAND * curve.swing
    side = np.where(off > band, 1, np.where(off < -band, -1, 0))
    rows = np.flatnonzero(side)
    rises = np.flatnonzero((side[rows][:-1] < 0) & (side[rows][1:] > 0))
    found = []
    for low, high in zip(rows[rises], rows[rises + 1]):
        row = low + int(np.flatnonzero(off[low : high + 1] > 0.0)[0])
        share = off[row - 1] / (off[row - 1] - off[row])
        found.append(curve.time[row - 1] + share * (curve.time[row] - curve.time[row - 1]))
    return np.array(found)


def crossings(curve: Curve, level: float | None = None) -> CurveNumber:
    """How often it goes up through a ``level`` (:func:`up_crossings`)."""
    times = up_crossings(curve, level)
    return CurveNumber(float(len(times)), float(times[0]) if len(times) else math.nan)


def mean_period(curve: Curve) -> CurveNumber:
    """The mean time from one maximum to the next, and from one minimum to the next, s.

    A damped swing keeps these, whatever it swings about.  A maximum stands out by a tenth of the whole
    swing; its time is that of the top of a parabola.  A time half of which has no row does not count.  The
    reach is by the scatter of the times, where there are three or more.
    """
    gaps = np.concatenate([_lasting(one) for one in (curve, Curve(curve.time, -curve.value))])
    if not len(gaps):
        raise NoNumber("it has no two maxima, nor two minima, that stand out by a tenth of the whole swing")
    reach = NORMAL * float(gaps.std(ddof=1)) / math.sqrt(len(gaps)) if len(gaps) > 2 else math.nan
    return CurveNumber(float(gaps.mean()), reach=reach)


def _lasting(curve: Curve) -> np.ndarray:
    """The times (n,), s, from each maximum to the next."""
    times = tops(curve)
    rows = np.searchsorted(curve.time, times)
    holes = [np.diff(curve.time[max(low - 1, 0) : up + 1]).max() for low, up in zip(rows, rows[1:])]
    last = np.diff(times)
    return last[np.array(holes) < 0.5 * last]


def tops(curve: Curve) -> np.ndarray:
    """The times (n,), s, of the maxima that stand out."""
    from scipy.signal import find_peaks  # late: a start of psph has no use for it

    rows, found = find_peaks(curve.value, prominence=PROMINENT * curve.swing or math.inf)
    times = []
    for row, stands_out in zip(rows, found["prominences"]):
        low = curve.value < curve.value[row] - CAP * stands_out
        first = int(np.flatnonzero(low[:row])[-1]) + 1 if low[:row].any() else 0
        end = row + int(np.flatnonzero(low[row:])[0]) if low[row:].any() else len(low)
        first, end = min(first, row - 1), max(end, row + 2)
        away = curve.time[first:end] - curve.time[row]
        bend, slope, _ = np.polyfit(away, curve.value[first:end], 2)
        times.append(curve.time[row] - 0.5 * slope / bend if bend < 0.0 else curve.time[row])
    return np.array(times)


def harmonic(curve: Curve, of_period: float) -> tuple[complex, float]:
    """The complex amplitude A of the part Re A exp(iωt) with this period, s, over as many whole ones as end
    with the curve, beside its harmonics and a straight line, by least squares; and the standard error of
    |A|."""
    rows = len(curve.time)
    covered = (
        curve.lasts * rows / max(rows - 1, 1)
    )  # a row counts until the next: the last of a period is due
    whole = math.floor(covered / of_period * (1.0 + 1e-9))
    if whole < 1:
        raise NoNumber(f"it lasts {curve.lasts:g} s, less than a period of {of_period:g} s")
    used = curve.time >= curve.time[-1] - whole * of_period * (1.0 + 1e-9)
    time, value = curve.time[used], curve.value[used]
    if len(time) < 4 * HARMONICS:
        raise NoNumber(f"{len(time)} rows in its periods are too few")
    angle, away = 2.0 * math.pi / of_period * time, time - time.mean()
    tones = [part for n in range(1, 1 + HARMONICS) for part in (np.cos(n * angle), -np.sin(n * angle))]
    basis = np.column_stack([*tones, np.ones(len(time)), away])
    parts = np.linalg.lstsq(basis, value, rcond=None)[0]
    rest = value - basis @ parts
    error = math.sqrt(float(rest @ rest) / (len(time) - basis.shape[1]) * 2.0 / len(time))
    return complex(parts[0], parts[1]), error


def response(curve: Curve, wave: Curve, period: float | None = None) -> CurveNumber:
    """How far something swings for each metre of a ``wave``: the ratio of both amplitudes at the period of
    the wave, s (response amplitude operator)."""
    at = mean_period(wave).value if period is None else period
    (own, error), (other, error_of_wave) = (harmonic(one, at) for one in (curve, wave))
    if wave.is_still or not abs(other) > NORMAL * error_of_wave:
        raise NoNumber(f"the other curve does not swing with a period of {at:g} s")
    ratio = abs(own) / abs(other)
    return CurveNumber(ratio, reach=NORMAL * math.hypot(error, ratio * error_of_wave) / abs(other))


def _mean(curve: Curve) -> float:
    return float(np.trapezoid(curve.value, curve.time)) / curve.lasts if curve.lasts else curve.value.mean()
