"""How the particles of each group move and bear: their motion and their equation of state."""

from typing import Any, NamedTuple

from psph.composition.terms import bearing_density
from psph.engine.jit import call_by_number, overload, register_jitable
from psph.physics.motion import PRESCRIBED
from psph.vectors import at, dot, nearest_to, put, scale, subtract

place = call_by_number("place")
"""(motions, number, anchor, time) → x, m."""
velocity = call_by_number("velocity")
"""(motions, number, anchor, time) → v, m/s."""
density = call_by_number("density")
"""(laws, number, pressure, rest_density, sound_speed) → ρ, kg/m^d."""
pressure = call_by_number("pressure")
"""(laws, number, density, rest_density, sound_speed) → p, Pa."""


class Rules(NamedTuple):
    """What kick, drift and equation of state do with a particle, by its group.

    ``effects`` are those with a part in them.  ``laws`` are the scene's equations of state and
    ``law_of`` has the number of each group's.  The first ``free`` groups move freely; ``motion_of`` has
    the number of each group's motion (psph.physics.motion), from PRESCRIBED on one of ``motions``.
    ``periods`` m, None for an open axis.  ``told`` are the groups to which a pass gives their pressure.
    """

    effects: tuple
    laws: tuple
    law_of: Any
    told: Any
    free: Any
    motions: tuple
    motion_of: Any
    periods: tuple


class Columns(NamedTuple):
    """The arrays of a rank's particles that the step advances; vectors are tuples of component arrays."""

    group: Any
    anchor: Any
    position: Any
    velocity: Any
    predicted_velocity: Any
    acceleration: Any
    density: Any
    density_rate: Any
    density_rate_1: Any
    density_rate_2: Any
    specific_volume: Any
    pressure: Any


@register_jitable
def borne(rules, i, group, rho):
    """Pressure of a particle of ``group`` and density ``rho``, Pa."""
    bearing = rho if group < rules.free else bearing_density(rules.effects, i, rho)
    return pressure(rules.laws, rules.law_of[group], bearing, i.rest_density, i.sound_speed)


def carry(motions, number, k, time, periods, columns):
    """Put particle ``k`` where motion ``number`` has it at ``time``, if that is a prescribed one."""
    if motions:
        _carry(motions, number, k, time, periods, columns)


def _carry(motions, number, k, time, periods, columns):
    if number >= PRESCRIBED:
        anchor = at(columns.anchor, k)
        x = place(motions, number - PRESCRIBED, anchor, time)
        v = velocity(motions, number - PRESCRIBED, anchor, time)
        put(columns.position, k, nearest_to(x, at(columns.position, k), periods))
        put(columns.velocity, k, v)
        put(columns.predicted_velocity, k, v)


@overload(carry)
def _typed_carry(motions, number, k, time, periods, columns):
    return _carry if len(motions) else lambda motions, number, k, time, periods, columns: None


def hurry(motions, number, k, time, dt, columns):
    """|v|² and |a|² of particle ``k`` by motion ``number`` at ``time``, m²/s², m²/s⁴; 0 if not prescribed."""
    return _hurry(motions, number, k, time, dt, columns) if motions else (0.0, 0.0)


def _hurry(motions, number, k, time, dt, columns):
    if number < PRESCRIBED:
        return 0.0, 0.0
    anchor = at(columns.anchor, k)
    v = velocity(motions, number - PRESCRIBED, anchor, time)
    before = velocity(motions, number - PRESCRIBED, anchor, time - dt)
    change = scale(subtract(v, before), 1.0 / dt if dt > 0.0 else 0.0)
    return dot(v, v), dot(change, change)


@overload(hurry)
def _typed_hurry(motions, number, k, time, dt, columns):
    return _hurry if len(motions) else lambda motions, number, k, time, dt, columns: (0.0, 0.0)
