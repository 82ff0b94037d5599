"""Waves one by one: how high each comes."""

import math

import numpy as np

from psph.theory.curves.number import Curve, CurveNumber, NoNumber
from psph.theory.curves.oscillation import up_crossings

RARE = 0.02
"""The share of the waves that exceeds the design's."""


def crests(curve: Curve, level: float | None = None, rest: float | None = None) -> np.ndarray:
    """The rows (n,) of the largest values from each rise through a ``level``, or the mean, to the next.

    Of a run-up (psph.output.gauges.run_up) these are the heights R to which the waves come.  A rise sooner
    than ``rest`` s after the former is of the same wave: a thin tongue flickers.  NoNumber where none is.
    """
    times: list[float] = []
    for time in up_crossings(curve, level):
        if not times or time - times[-1] > (rest or 0.0):
            times.append(time)
    ends = np.searchsorted(curve.time, times)
    if len(ends) < 2:
        raise NoNumber("it has no wave from one rise through its mean or level to the next")
    return np.array([low + int(curve.value[low:up].argmax()) for low, up in zip(ends, ends[1:])])


def mean_crest(curve: Curve, level: float | None = None, rest: float | None = None) -> CurveNumber:
    """The mean of the :func:`crests`."""
    return CurveNumber(float(curve.value[crests(curve, level, rest)].mean()))


def rare_crest(curve: Curve, level: float | None = None, rest: float | None = None) -> CurveNumber:
    """R_2%, which 2 % of the :func:`crests` exceed: i/(n + 1) the i-th of n (Weibull 1939), with straight
    lines between.  NoNumber of fewer waves than 49, of which the highest is less rare."""
    rows = crests(curve, level, rest)
    rank = RARE * (len(rows) + 1)
    if rank < 1.0:
        raise NoNumber(
            f"it takes 49 waves, of {len(rows)} the highest is less rare; run longer, or take mean_crest"
        )
    falling = rows[np.argsort(-curve.value[rows], kind="stable")]
    place = np.interp(rank, np.arange(1, len(rows) + 1), curve.value[falling])
    return CurveNumber(float(place), float(curve.time[falling[math.floor(rank) - 1]]))
