"""How the particles of each group move and bear: their motion and their equation of state."""

from typing import Any, NamedTuple

from numba.core import types

from psph.composition.terms import bearing_density
from psph.engine.jit import call_by_number, overload, register_jitable, tuple_of, unrolled
from psph.physics.motion import PRESCRIBED, RIGID
from psph.physics.rigid.pose import ACCELERATION, PLACE, VELOCITY
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
    the number of each group's motion (psph.physics.motion), from PRESCRIBED on one of ``motions``;
    ``poses`` are the maps of what is rigid (psph.simulation.poses), or None, ``pose_of`` the row of each
    group.  ``periods`` m, None for an open axis.  ``told`` are the groups to which a pass gives their
    pressure.
    """

    effects: tuple
    laws: tuple
    law_of: Any
    told: Any
    free: Any
    motions: tuple
    motion_of: Any
    poses: Any
    pose_of: Any
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
    mass: Any = None
    apparent: Any = None
    work: Any = None


@register_jitable
def borne(rules, i, group, rho):
    """Pressure of a particle of ``group`` and density ``rho``, Pa."""
    bearing = rho if group < rules.free else bearing_density(rules.effects, i, rho)
    return pressure(rules.laws, rules.law_of[group], bearing, i.rest_density, i.sound_speed)


@register_jitable
def carry(rules, group, k, time, columns):
    """Put particle ``k`` of a wall where the motion of its ``group`` has it at ``time``, if it moves."""
    number = rules.motion_of[group]
    _carry_by_formula(rules.motions, number, k, time, rules.periods, columns)
    _carry_by_pose(rules.poses, rules.pose_of, number, group, k, rules.periods, columns)


@register_jitable
def hurry(rules, group, k, time, dt, columns):
    """|v|² and |a|² of particle ``k`` by its prescribed motion, m²/s², m²/s⁴; zeros without one."""
    number = rules.motion_of[group]
    v2, a2 = _pace_by_formula(rules.motions, number, k, time, dt, columns)
    w2, b2 = _pace_by_pose(rules.poses, rules.pose_of, number, group, k, columns)
    return v2 + w2, a2 + b2


@register_jitable
def affine(maps, row, which, a):
    """The vector ``a`` by one of the affine maps of a row (psph.physics.rigid.pose.maps)."""
    return _affine(maps, row, which, a)


def _affine(maps, row, which, a):
    linear = maps[row, which]
    return tuple(m[0] + dot(m[1:], a) for m in linear)


@overload(_affine)
def _typed_affine(maps, row, which, a):
    n = len(a)
    sums = (
        " + ".join(
            [f"maps[row, which, {d}, 0]", *(f"maps[row, which, {d}, {1 + e}] * a[{e}]" for e in range(n))]
        )
        for d in range(n)
    )
    return unrolled("maps, row, which, a", f"return {tuple_of(sums)}")


def _carry_by_formula(motions, number, k, time, periods, columns):
    if motions:
        _carry_formula(motions, number, k, time, periods, columns)


def _carry_formula(motions, number, k, time, periods, columns):
    if number >= PRESCRIBED:
        anchor = at(columns.anchor, k)
        x = place(motions, number - PRESCRIBED, anchor, time)
        v = velocity(motions, number - PRESCRIBED, anchor, time)
        settle(columns, k, x, v, periods)


@overload(_carry_by_formula)
def _typed_carry_by_formula(motions, number, k, time, periods, columns):
    return _carry_formula if len(motions) else lambda motions, number, k, time, periods, columns: None


def _carry_by_pose(poses, pose_of, number, group, k, periods, columns):
    if poses is not None:
        _carry_pose(poses, pose_of, number, group, k, periods, columns)


def _carry_pose(poses, pose_of, number, group, k, periods, columns):
    if number == RIGID:
        anchor, row = at(columns.anchor, k), pose_of[group]
        x, v = affine(poses, row, PLACE, anchor), affine(poses, row, VELOCITY, anchor)
        settle(columns, k, x, v, periods)


@overload(_carry_by_pose)
def _typed_carry_by_pose(poses, pose_of, number, group, k, periods, columns):
    if isinstance(poses, types.NoneType):
        return lambda poses, pose_of, number, group, k, periods, columns: None
    return _carry_pose


@register_jitable
def settle(columns, k, x, v, periods):
    """Put particle ``k`` at ``x``, or at the image of it that is nearest to where it is, with ``v``."""
    put(columns.position, k, nearest_to(x, at(columns.position, k), periods))
    put(columns.velocity, k, v)
    put(columns.predicted_velocity, k, v)


def _pace_by_formula(motions, number, k, time, dt, columns):
    return _pace_formula(motions, number, k, time, dt, columns) if motions else (0.0, 0.0)


def _pace_formula(motions, number, k, time, dt, columns):
    if number < PRESCRIBED:
        return 0.0, 0.0
    anchor = at(columns.anchor, k)
    v = velocity(motions, number - PRESCRIBED, anchor, time)
    before = velocity(motions, number - PRESCRIBED, anchor, time - dt)
    change = scale(subtract(v, before), 1.0 / dt if dt > 0.0 else 0.0)
    return dot(v, v), dot(change, change)


@overload(_pace_by_formula)
def _typed_pace_by_formula(motions, number, k, time, dt, columns):
    return _pace_formula if len(motions) else lambda motions, number, k, time, dt, columns: (0.0, 0.0)


def _pace_by_pose(poses, pose_of, number, group, k, columns):
    return (0.0, 0.0) if poses is None else _pace_pose(poses, pose_of, number, group, k, columns)


def _pace_pose(poses, pose_of, number, group, k, columns):
    if number != RIGID:
        return 0.0, 0.0
    v, a = at(columns.velocity, k), affine(poses, pose_of[group], ACCELERATION, at(columns.anchor, k))
    return dot(v, v), dot(a, a)


@overload(_pace_by_pose)
def _typed_pace_by_pose(poses, pose_of, number, group, k, columns):
    if isinstance(poses, types.NoneType):
        return lambda poses, pose_of, number, group, k, columns: (0.0, 0.0)
    return _pace_pose
