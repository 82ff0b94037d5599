"""What has gone over a crest, from the volume beyond it by the metre (psph.output.gauges.volume)."""

import numpy as np

from psph.theory.curves.number import Curve, CurveNumber, NoNumber

LITRES = 1000.0
"""In a m³."""

LEAST = 0.005
"""Part of all that has gone over below which a rise is no wave."""


def discharge(curve: Curve) -> CurveNumber:
    """The mean discharge, litres by the second and metre: what is beyond more at the end than at the start,
    over the time between."""
    if curve.lasts == 0.0:
        raise NoNumber("one row has no duration")
    return CurveNumber(LITRES * float(curve.value[-1] - curve.value[0]) / curve.lasts)


def waves(curve: Curve, rest: float) -> list[tuple[float, float]]:
    """When each wave begins to go over, s, and its volume, m³/m: rises of the largest volume so far, apart
    where there is none for ``rest`` s, from the end of one to the begin of the next: rows may be sparser."""
    rises = np.diff(np.maximum.accumulate(curve.value))
    rows = np.flatnonzero(rises > 0.0)
    pauses = curve.time[rows[1:]] - curve.time[rows[:-1] + 1]
    parts = np.split(rows, np.flatnonzero(pauses > rest) + 1) if len(rows) else []
    found = [(float(curve.time[part[0]]), float(rises[part].sum())) for part in parts]
    return [one for one in found if one[1] > LEAST * float(rises.sum())]


def largest_wave(curve: Curve, rest: float) -> CurveNumber:
    """The volume of the largest of the :func:`waves`, litres by the metre, and when it began."""
    found = waves(curve, rest)
    if not found:
        raise NoNumber("nothing goes over")
    time, volume = max(found, key=lambda one: one[1])
    return CurveNumber(LITRES * volume, time)


def number_of_waves(curve: Curve, rest: float) -> CurveNumber:
    """How many waves go over."""
    return CurveNumber(float(len(waves(curve, rest))))
