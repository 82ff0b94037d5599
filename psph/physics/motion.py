"""How the particles of a species move: freely, not at all, or as they are told.

A motion is a typed value, as an effect is.  One that is prescribed has two methods, of a particle's
``anchor`` (where it stood at the start, m) and the time (s):

    place(anchor, time)     → where it is, m
    velocity(anchor, time)  → the time derivative of that, m/s

so that its particles never drift from where they belong, however many steps a run takes.
"""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import method_of, overload, register_jitable, unrolled
from psph.fields import FLUID, VECTOR, WALL, Field
from psph.vectors import at, dot, put, scale, subtract

ANCHOR = Field("anchor", "m", "place at time zero, of particles whose motion is prescribed", VECTOR)


class Free(NamedTuple):
    """Particles move as forces have them."""

    kind = FLUID


class Fixed(NamedTuple):
    """Particles stay where they are."""

    kind = WALL


FREE, FIXED, PRESCRIBED = 0, 1, 2
"""Numbers of motions in compiled loops: of prescribed ones, the first."""


def is_prescribed(motion) -> bool:
    """Whether a motion says where its particles are."""
    return hasattr(motion, "place")


def carry(motions, motion_of, group, k, time, periods, anchor, position, velocity, predicted_velocity):
    """Put particle ``k`` where the prescribed motion of its group has it at ``time``, and at its speed."""
    number = motion_of[group[k]] if motions else FIXED
    for n, motion in enumerate(motions, PRESCRIBED):
        if n == number:
            x = motion.place(at(anchor, k), time)
            v = motion.velocity(at(anchor, k), time)
            put(position, k, _beside(x, at(position, k), periods))
            put(velocity, k, v)
            put(predicted_velocity, k, v)


def _beside(x, old, periods):
    """The periodic image of ``x`` that is nearest to ``old``; exactly x where it is x itself."""
    return tuple(
        a if period is None else a - period * np.rint((a - b) / period)
        for a, b, period in zip(x, old, periods)
    )


@overload(_beside)
def _typed_beside(x, old, periods):
    parts = (
        f"x[{d}] - periods[{d}] * rint((x[{d}] - old[{d}]) / periods[{d}])"
        if hasattr(period, "bitwidth")
        else f"x[{d}]"
        for d, period in enumerate(periods)
    )
    return unrolled("x, old, periods", f"return ({', '.join(parts)},)", rint=np.rint)


@overload(carry)
def _typed_carry(motions, motion_of, group, k, time, periods, anchor, position, velocity, predicted_velocity):
    lines = ["number = motion_of[group[k]]"] if len(motions) else []
    names = {"at": at, "put": put, "beside": _beside}
    for n, kind in enumerate(motions):
        names |= {f"place_{n}": method_of(kind, "place"), f"velocity_{n}": method_of(kind, "velocity")}
        lines += [
            f"if number == {n + PRESCRIBED}:",
            f"    x = place_{n}(motions[{n}], at(anchor, k), time)",
            f"    v = velocity_{n}(motions[{n}], at(anchor, k), time)",
            "    put(position, k, beside(x, at(position, k), periods))",
            "    put(velocity, k, v)",
            "    put(predicted_velocity, k, v)",
        ]
    return unrolled(
        "motions, motion_of, group, k, time, periods, anchor, position, velocity, predicted_velocity",
        *lines,
        "return",
        **names,
    )


def hurry(motions, motion_of, group, k, time, dt, anchor):
    """|v|² and |a|² of particle ``k`` by its group's prescribed motion at ``time``, m²/s², m²/s⁴."""
    number = motion_of[group[k]] if motions else FIXED
    for n, motion in enumerate(motions, PRESCRIBED):
        if n == number:
            return _hurry(motion.velocity(at(anchor, k), time), motion.velocity(at(anchor, k), time - dt), dt)
    return 0.0, 0.0


@register_jitable
def _hurry(v, before, dt):
    change = scale(subtract(v, before), 1.0 / dt if dt > 0.0 else 0.0)
    return dot(v, v), dot(change, change)


@overload(hurry)
def _typed_hurry(motions, motion_of, group, k, time, dt, anchor):
    lines = ["number = motion_of[group[k]]"] if len(motions) else []
    names = {"at": at, "hurry": _hurry}
    for n, kind in enumerate(motions):
        names[f"velocity_{n}"] = method_of(kind, "velocity")
        speeds = (f"velocity_{n}(motions[{n}], at(anchor, k), {t})" for t in ("time", "time - dt"))
        lines += [f"if number == {n + PRESCRIBED}:", f"    return hurry({', '.join(speeds)}, dt)"]
    return unrolled("motions, motion_of, group, k, time, dt, anchor", *lines, "return 0.0, 0.0", **names)
