"""What an open end gives to the fluid: the shape of what comes in, and waves that leave.

A velocity end gives the mean speed ū_t through its face, a pressure end the pressure p_t.  What comes in has
the shape of the end, what goes out that of the fluid.  With Z = ρ₀c, means over the face by a bar, speeds u
inward, and a reference that follows the mean in τ, the state behind the face is corrected by

    pressure end:  δp = ½[(p̄ − p̄_t) + Z (u_r − ū)],   δu = −½[(ū − u_r) + (p̄ − p̄_t)/Z]
    velocity end:  δp = ½[(p_r − p̄) + Z (ū_t − ū)],   δu = −½[(ū_t − ū) + (p̄ − p_r)/Z]

so that the wave that goes out finds no answer: Thompson (1987), J. Comput. Phys. 68, 1; for SPH, by particle,
Lastiwka, Basa & Quinlan (2009), Int. J. Numer. Meth. Fluids 61, 709.  Here means alone are corrected: by
particle, rows with different speeds part.  Waves that take longer than τ count as a change of the flow.
Under a free surface Z = ρ₀√(gH).

Under a level layers of fluids at rest have p = c²(ρ − ρ₀) and dp/dz = −ρg, so that p + ρ₀c² grows
downwards in each by exp(gd/c²) over d.
"""

import math
from typing import NamedTuple

import numpy as np

from psph.formula import helper


class WaveAnswer(NamedTuple):
    """What is added behind the face: to the pressure in Pa, and to the inward speed in m/s."""

    pressure: float = 0.0
    speed: float = 0.0


NO_ANSWER = WaveAnswer()


def of_pressure_end(
    pressure: float, given: float, speed: float, reference: float, impedance: float
) -> WaveAnswer:
    """By the mean ``pressure`` and the one that is ``given``, Pa, the mean ``speed`` and its ``reference``,
    m/s, and Z, kg/(m² s)."""
    over, faster = pressure - given, speed - reference
    return WaveAnswer(0.5 * (over - impedance * faster), -0.5 * (faster + over / impedance))


def of_velocity_end(
    speed: float, given: float, pressure: float, reference: float, impedance: float
) -> WaveAnswer:
    """By the mean ``speed`` and the one that is ``given``, m/s, the mean ``pressure`` and its ``reference``,
    Pa, and Z, kg/(m² s)."""
    over, slower = pressure - reference, given - speed
    return WaveAnswer(0.5 * (impedance * slower - over), -0.5 * (slower + over / impedance))


def follow(reference: float, value: float, dt: float, time: float) -> float:
    """The ``reference`` after ``dt`` s, which follows a ``value`` in ``time``, s."""
    return reference + (1.0 - math.exp(-dt / time)) * (value - reference)


def grown(time: float, ramp: float) -> float:
    """The part of what is given that has grown in a ``ramp``, s: ½(1 − cos πt/T)."""
    return 1.0 if time >= ramp else 0.5 * (1.0 - math.cos(math.pi * time / ramp))


def parabola(across: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """∏ 6 s(1 − s), the flow between plates with a mean of 1, at ``across`` (n, axes) between ``low`` and
    ``high`` (axes,), m."""
    s = (across - low) / (high - low)
    return np.prod(np.maximum(6.0 * s * (1.0 - s), 0.0), axis=1)


def pipe(across: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """2(1 − r²/R²), Poiseuille's flow with a mean of 1, at ``across`` (n, 2) in the round pipe within
    ``low`` and ``high`` (2,), m."""
    middle, radius = 0.5 * (low + high), 0.5 * (high - low).min()
    return np.maximum(2.0 * (1.0 - ((across - middle) ** 2).sum(axis=1) / radius**2), 0.0)


@helper
def column_pressure(level, height, pull, edges, rest, sound):
    """Pressure at a ``height`` below the ``level`` of fluids at rest, Pa, and none above it.

    Layers from the lowest up meet at ``edges`` (layers + 1,), m, of which the first is below all and the last
    above, with ``rest`` densities (layers,), kg/m^d, and speeds of ``sound`` (layers,), m/s, under a ``pull``
    in m/s².
    """
    pressure, top = 0.0, level
    for n in range(len(rest) - 1, -1, -1):
        low = max(edges[n], height)
        if top > low:
            c2 = sound[n] * sound[n]
            pressure += (pressure + rest[n] * c2) * np.expm1((top - low) * pull / c2)
            top = low
    return pressure


@helper
def column_weight(middle, height, pull, edges, rest):
    """−∫ρg dz from the ``middle`` to a ``height``, Pa, by the same layers."""
    low, high, weight = min(middle, height), max(middle, height), 0.0
    for n in range(len(rest)):
        weight += rest[n] * pull * max(min(high, edges[n + 1]) - max(low, edges[n]), 0.0)
    return weight if height < middle else -weight
