"""Several neighbours side by side in a register, worked on as if they were one number."""

from psph.engine.simd.lanes import EIGHT, WIDTH, lanes_of, spread, where, width_of
from psph.engine.simd.memory import (
    AHEAD,
    GROUP,
    bits,
    consecutive,
    eight,
    narrowed,
    put_consecutive,
    set_bits,
    steps_between,
    turning,
)
from psph.engine.simd.sums import fold, total

__all__ = [
    "AHEAD",
    "EIGHT",
    "GROUP",
    "WIDTH",
    "bits",
    "consecutive",
    "eight",
    "fold",
    "lanes_of",
    "narrowed",
    "put_consecutive",
    "set_bits",
    "spread",
    "steps_between",
    "total",
    "turning",
    "where",
    "width_of",
]
