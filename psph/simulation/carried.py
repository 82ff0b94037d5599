"""What moves as it is told: where its particles stand, what they feel, and what they give.

Each part is there twice, for motions by a formula (psph.physics.motion) and for poses
(psph.simulation.poses), and in the compiled loop only where the scene has such.
"""

from numba.core import types

from psph.composition import terms
from psph.engine.jit import call_by_number, inside, overload_inside
from psph.physics.motion import FIXED, PRESCRIBED, RIGID
from psph.physics.rigid.mapped import affine, linear, onto
from psph.physics.rigid.pose import ACCELERATION, PLACE, PREDICTED, VELOCITY
from psph.vectors import add, at, dot, nearest_to, put, scale, subtract, zero_like

place = call_by_number("place")
"""(motions, number, anchor, time) → x, m."""
velocity = call_by_number("velocity")
"""(motions, number, anchor, time) → v, m/s."""


@inside
def carry(rules, group, k, time, columns):
    """Put particle ``k`` of a wall where the motion of its ``group`` has it at ``time``, if it moves."""
    number = rules.motion_of[group]
    _carry_by_formula(rules.motions, number, k, time, rules.periods, columns)
    _carry_by_pose(rules.poses, rules.pose_of, number, group, k, rules.periods, columns)


@inside
def prescribed_squares(rules, group, k, time, dt, v, anchor):
    """|v|² and |a|² of particle ``k`` with the velocity ``v`` and an ``anchor`` by its prescribed motion,
    m²/s², m²/s⁴; zeros without one.

    Without branches, as :func:`book_work`: what a branch hands on may be counted, array by array, at each
    particle, which took a hundred times as long as the rest of the loop.
    """
    return _prescribed_squares(rules.motions, rules.poses, rules, group, k, time, dt, v, anchor)


@inside
def store_apparent_force(rules, group, k, time, dt, columns):
    """Store the force per mass of a moving frame on particle ``k`` less its prescribed acceleration, m/s²."""
    _store_apparent_force(columns.apparent, rules, group, k, time, dt, columns)


@inside
def book_work(rules, i, group, k, dt, work, load, v):
    """Book as ``work`` what particle ``k``, seen as ``i``, gives by its ``load`` with its velocity ``v`` in a
    step of ``dt`` s, J.

    A wall that moves pushes the fluid with −m_i a_i, a_i by the fluid around it; to what moves freely those
    body forces give that have no potential, a moving frame's among them.
    """
    _book_work(work, rules, i, group, k, dt, load, v)


def _carry_by_formula(motions, number, k, time, periods, columns):
    if motions:
        _carry_formula(motions, number, k, time, periods, columns)


def _carry_formula(motions, number, k, time, periods, columns):
    if number >= PRESCRIBED:
        anchor = at(columns.anchor, k)
        x = place(motions, number - PRESCRIBED, anchor, time)
        v = velocity(motions, number - PRESCRIBED, anchor, time)
        settle(columns, k, x, v, v, periods)


@overload_inside(_carry_by_formula)
def _typed_carry_by_formula(motions, number, k, time, periods, columns):
    return _carry_formula if len(motions) else lambda motions, number, k, time, periods, columns: None


def _carry_by_pose(poses, pose_of, number, group, k, periods, columns):
    if poses is not None:
        _carry_pose(poses, pose_of, number, group, k, periods, columns)


def _carry_pose(poses, pose_of, number, group, k, periods, columns):
    if number == RIGID:
        anchor, row = at(columns.anchor, k), pose_of[group]
        x, v = affine(poses[row], PLACE, anchor), affine(poses[row], VELOCITY, anchor)
        settle(columns, k, x, v, affine(poses[row], PREDICTED, anchor), periods)
        _whirl(columns.whirl, poses[row], x, k)
        _face(columns.drawn_normal, columns.face_normal, poses[row], k)
        _face(columns.drawn_side, columns.face_side, poses[row], k)


@overload_inside(_carry_by_pose)
def _typed_carry_by_pose(poses, pose_of, number, group, k, periods, columns):
    if isinstance(poses, types.NoneType):
        return lambda poses, pose_of, number, group, k, periods, columns: None
    return _carry_pose


def _whirl(whirl, maps, x, k):
    if whirl is not None:
        _whirl_it(whirl, maps, x, k)


def _whirl_it(whirl, maps, x, k):
    """[ω] of what moves as a whole: between two points velocities differ by [ω] R x₀, places by R x₀."""
    put(whirl, k, onto(maps, PREDICTED, PLACE, x))


@overload_inside(_whirl)
def _typed_whirl(whirl, maps, x, k):
    if isinstance(whirl, types.NoneType):
        return lambda whirl, maps, x, k: None
    return _whirl_it


def _face(drawn, normal, maps, k):
    if drawn is not None:
        _face_it(drawn, normal, maps, k)


def _face_it(drawn, normal, maps, k):
    """R N of a normal N of what moves as a whole."""
    put(normal, k, linear(maps, PLACE, at(drawn, k)))


@overload_inside(_face)
def _typed_face(drawn, normal, maps, k):
    if isinstance(drawn, types.NoneType):
        return lambda drawn, normal, maps, k: None
    return _face_it


@inside
def settle(columns, k, x, v, predicted, periods):
    """Put particle ``k`` at ``x``, or at the image of it that is nearest to where it is, with ``v`` and what
    is ``predicted`` of it."""
    put(columns.position, k, nearest_to(x, at(columns.position, k), periods))
    put(columns.velocity, k, v)
    put(columns.predicted_velocity, k, predicted)


@inside
def prescribed_acceleration(rules, group, k, time, dt, v, anchor):
    """a of particle ``k`` with a velocity ``v`` and an ``anchor`` by its prescribed motion, m/s²; zeros
    without one."""
    number = rules.motion_of[group]
    by_formula = _acceleration_by_formula(rules.motions, number, k, time, dt, v, anchor)
    return add(by_formula, _acceleration_by_pose(rules.poses, rules.pose_of, number, group, k, v, anchor))


def _acceleration_by_formula(motions, number, k, time, dt, v, anchor):
    if not motions:
        return zero_like(v)
    return _acceleration_formula(motions, number, k, time, dt, v, anchor)


def _acceleration_formula(motions, number, k, time, dt, v, anchor):
    """By the change of the velocity in the step."""
    place = at(anchor, k)
    if number < PRESCRIBED:
        return zero_like(v)
    now = velocity(motions, number - PRESCRIBED, place, time)
    before = velocity(motions, number - PRESCRIBED, place, time - dt)
    return scale(subtract(now, before), 1.0 / dt if dt > 0.0 else 0.0)


@overload_inside(_acceleration_by_formula)
def _typed_acceleration_by_formula(motions, number, k, time, dt, v, anchor):
    if len(motions):
        return _acceleration_formula
    return lambda motions, number, k, time, dt, v, anchor: zero_like(v)


def _acceleration_by_pose(poses, pose_of, number, group, k, v, anchor):
    if poses is None:
        return zero_like(v)
    return _acceleration_pose(poses, pose_of, number, group, k, v, anchor)


def _acceleration_pose(poses, pose_of, number, group, k, v, anchor):
    a = affine(poses[pose_of[group]], ACCELERATION, at(anchor, k))
    return scale(a, 1.0 if number == RIGID else 0.0)


@overload_inside(_acceleration_by_pose)
def _typed_acceleration_by_pose(poses, pose_of, number, group, k, v, anchor):
    if isinstance(poses, types.NoneType):
        return lambda poses, pose_of, number, group, k, v, anchor: zero_like(v)
    return _acceleration_pose


def _prescribed_squares(motions, poses, rules, group, k, time, dt, v, anchor):
    if not motions and poses is None:
        return 0.0, 0.0
    return _squares_of_motion(motions, poses, rules, group, k, time, dt, v, anchor)


def _squares_of_motion(motions, poses, rules, group, k, time, dt, v, anchor):
    a = prescribed_acceleration(rules, group, k, time, dt, v, anchor)
    moves = rules.motion_of[group] > FIXED
    return dot(v, v) if moves else 0.0, dot(a, a) if moves else 0.0


@overload_inside(_prescribed_squares)
def _typed_squares(motions, poses, rules, group, k, time, dt, v, anchor):
    if not len(motions) and isinstance(poses, types.NoneType):
        return lambda motions, poses, rules, group, k, time, dt, v, anchor: (0.0, 0.0)
    return _squares_of_motion


def _store_apparent_force(apparent, rules, group, k, time, dt, columns):
    if apparent is not None:
        _store_force(apparent, rules, group, k, time, dt, columns)


def _store_force(apparent, rules, group, k, time, dt, columns):
    x, v = at(columns.position, k), at(columns.predicted_velocity, k)
    a = prescribed_acceleration(rules, group, k, time, dt, v, columns.anchor)
    put(apparent, k, subtract(inertial(rules.frame, x, v), a))


@overload_inside(_store_apparent_force)
def _typed_store(apparent, rules, group, k, time, dt, columns):
    if isinstance(apparent, types.NoneType):
        return lambda apparent, rules, group, k, time, dt, columns: None
    return _store_force


def inertial(frame, x, v):
    """What a moving frame adds to gravity at ``x`` for a velocity ``v``, m/s²; zeros without one."""
    return zero_like(x) if frame is None else _inertial(frame, x, v)


def _inertial(frame, x, v):
    return add(affine(frame, 0, x), affine(frame, 1, v))


@overload_inside(inertial)
def _typed_inertial(frame, x, v):
    return (lambda frame, x, v: zero_like(x)) if isinstance(frame, types.NoneType) else _inertial


def _book_work(work, rules, i, group, k, dt, load, v):
    if work is not None:
        _book(work, rules, i, group, k, dt, load, v)


def _book(work, rules, i, group, k, dt, load, v):
    given, taken = dot(terms.body(rules.booked, i), v), dot(stored(load, v, k), v)
    taken = taken if rules.motion_of[group] > FIXED else 0.0
    work[k] += dt * i.mass * (given if group < rules.free else -taken)


@overload_inside(_book_work)
def _typed_book(work, rules, i, group, k, dt, load, v):
    if isinstance(work, types.NoneType):
        return lambda work, rules, i, group, k, dt, load, v: None
    return _book


def stored(arrays, v, k):
    """The vector of particle ``k``, as many numbers as ``v``; zeros where there are no arrays."""
    return zero_like(v) if arrays is None else at(arrays, k)


@overload_inside(stored)
def _typed_stored(arrays, v, k):
    if isinstance(arrays, types.NoneType):
        return lambda arrays, v, k: zero_like(v)
    return lambda arrays, v, k: at(arrays, k)
