"""Means, extremes and integrals of a curve."""

import math

import numpy as np

from psph.theory.curves.number import NORMAL, Curve, CurveNumber, NoNumber


def mean(curve: Curve) -> CurveNumber:
    """∫q dt/T, with the reach of σ √(2τ/T): σ the standard deviation, τ the integral of the correlation of
    the curve with itself up to its first zero (Tennekes & Lumley 1972, A First Course in Turbulence, 6.4)."""
    if curve.lasts == 0.0:
        return CurveNumber(float(curve.value.mean()))
    value = impulse(curve).value / curve.lasts
    try:
        step, even = curve.evenly()
    except NoNumber:
        return CurveNumber(value)
    off = even - even.mean()
    size = float(off @ off)
    if size == 0.0:
        return CurveNumber(value, reach=0.0)
    padded = np.fft.rfft(off, 2 * len(off))
    likeness = np.fft.irfft(padded * padded.conj())[: len(off)] / size
    below = np.flatnonzero(likeness <= 0.0)
    scale = step * float(likeness[: below[0] if len(below) else len(off)].sum() - 0.5)
    return CurveNumber(value, reach=NORMAL * float(off.std()) * math.sqrt(2.0 * scale / curve.lasts))


def spread(curve: Curve) -> CurveNumber:
    """The standard deviation over time, by the trapezoidal rule."""
    middle = mean(curve).value
    return CurveNumber(math.sqrt(mean(Curve(curve.time, (curve.value - middle) ** 2)).value))


def minimum(curve: Curve) -> CurveNumber:
    """The least value and its first time."""
    row = int(curve.value.argmin())
    return CurveNumber(float(curve.value[row]), float(curve.time[row]))


def maximum(curve: Curve) -> CurveNumber:
    """The largest value and its first time."""
    row = int(curve.value.argmax())
    return CurveNumber(float(curve.value[row]), float(curve.time[row]))


def amplitude(curve: Curve) -> CurveNumber:
    """Half of the way from the least value to the largest."""
    return CurveNumber(0.5 * curve.swing)


def last(curve: Curve) -> CurveNumber:
    """The last value."""
    return CurveNumber(float(curve.value[-1]), float(curve.time[-1]))


def change(curve: Curve) -> CurveNumber:
    """The last value less the first."""
    return CurveNumber(float(curve.value[-1] - curve.value[0]), float(curve.time[-1]))


def impulse(curve: Curve) -> CurveNumber:
    """∫q dt by the trapezoidal rule."""
    return CurveNumber(float(np.trapezoid(curve.value, curve.time)))
