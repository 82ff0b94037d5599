"""Where neighbours are: differences of positions, in double precision or in fixed point."""

from typing import NamedTuple

import numpy as np
from numba.core import types

from psph.engine.jit import call_by_type, overload, register_jitable, tuple_of, unrolled
from psph.engine.simd import EIGHT, consecutive, lanes_of, steps_between
from psph.vectors import nearest_image, subtract

difference = call_by_type("difference")
"""(space, i, j, records, k) -> x_i − x_j, m; k is the column of i."""

RANGE = 256.0
"""Smoothing lengths after which a fixed-point coordinate repeats itself."""

STEPS = 2.0**32
"""Steps of a fixed-point coordinate."""

BEYOND = 64.0
"""Distance over h that lanes behind the end of a row get: beyond the support of every kernel, and its
powers are numbers in single precision."""


class Metres(NamedTuple):
    """Positions in double precision; ``periods`` m, None for an open axis."""

    periods: tuple

    lanes = lanes_of(types.float64).width
    record_type = np.dtype(np.float64)
    tiny = 1e-20
    """r² + tiny h² keeps two particles at one place from dividing by zero; too small to change any
    other distance."""

    def difference(self, i, j, records, k):
        """x_i − x_j to the nearest image, m."""
        return nearest_image(subtract(i.position, j.position), self.periods)


class FixedPoint(NamedTuple):
    """Positions as whole steps modulo 2³², so that a difference is exact wherever the pair is.

    A step is 256 h/2³² = 6e-8 h, finer than single precision resolves near neighbours, and it does
    not grow with the domain.  A period is a whole number of ranges: its images need no code.
    ``units`` m a step, an axis each.
    """

    units: tuple

    lanes = lanes_of(types.float32).width
    record_type = np.dtype(np.float32)
    tiny = 1e-12
    """Fourth powers of h/r at one place are still numbers in single precision; it changes no distance
    above 0.004 h."""

    def difference(self, i, j, records, k):
        """x_i − x_j to the nearest image, m."""
        return steps_each(records, k, j.position, self.units)


def fixed_point(smoothing_length: float, periods) -> FixedPoint:
    """Steps for a smoothing length (m) and periods (m, None for an open axis)."""
    most = RANGE * smoothing_length
    ranges = (most if p is None else p / max(1.0, np.ceil(p / most)) for p in periods)
    return FixedPoint(tuple(float(r / STEPS) for r in ranges))


def softening(space, smoothing_length: float, longest: int) -> np.ndarray:
    """What the pair loop adds to r², m², entry by entry of a row of ``longest`` neighbours.

    ``space.tiny`` h², and (64 h)² for the lanes behind the end of a row: by their number, they are out
    of reach, wherever a period or the range of a fixed-point coordinate puts them.
    """
    added = np.full(longest + EIGHT, space.tiny * smoothing_length**2, space.record_type)
    added[longest:] = (BEYOND * smoothing_length) ** 2
    return added


@register_jitable
def softened(softening, left):
    """What is added to r² in the register that begins ``left`` entries before the end of a row."""
    return consecutive(softening, np.uint64(len(softening) - EIGHT) - left)


def steps_each(records, k, positions, units):
    """Differences along each axis."""
    own = records[k, : len(units)].view(np.int32)
    steps = own - np.array(positions, np.float32).view(np.int32)  # wraps around
    return tuple(float(n) * unit for n, unit in zip(steps, units))


@overload(steps_each)
def _typed_steps_each(records, k, positions, units):
    parts = (f"steps_between(records, k, axes[{d}], positions[{d}], units[{d}])" for d in range(len(units)))
    return unrolled(
        "records, k, positions, units",
        f"return {tuple_of(parts)}",
        steps_between=steps_between,
        axes=tuple(np.arange(len(units), dtype=np.uint64)),
    )
