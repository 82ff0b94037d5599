"""What the fluid does to rigid bodies: the loads of their particles, added as whole numbers."""

import numpy as np

from psph.composition.pair import take
from psph.engine.jit import elementwise, overload, unrolled
from psph.vectors import Vector, at, nearest_image, scale, subtract, zero_like


@elementwise
def add_pushes(first, last, body_of, places, units, periods, view, columns):
    """F = Σ m_w a_w and T = Σ (x_w − X) × m_w a_w of each body, with accelerations by the fluid alone.

    Over the columns ``first`` to ``last``; ``body_of`` has the row of each group's body, −1 without one,
    and ``places`` X, m, the point about which each turns.  Returns whole numbers (bodies, 6) of the ``units``
    of force, N, and of torque, N m, so that the sums do not depend on the order of particles.
    """
    found = np.zeros((len(places), 6), np.int64)
    per_force, per_torque = 1.0 / units[0], 1.0 / units[1]
    for k in range(np.uint64(first), np.uint64(last)):
        body = body_of[columns.group[k]]
        if body < 0:
            continue
        a = at(columns.load, k)
        if a == zero_like(a):
            continue
        force = scale(a, take(view, k).mass)
        arm = nearest_image(subtract(at(columns.position, k), point(places, body, a)), periods)
        _book(found, body, force, moment(arm, force), per_force, per_torque)
    return found


def point(places, body, like) -> Vector:
    """A row of ``places`` (n, 3) as a vector with as many numbers as ``like``."""
    return tuple(places[body, d] for d in range(len(like)))


@overload(point)
def _point(places, body, like):
    parts = ", ".join(f"places[body, {d}]" for d in range(len(like)))
    return unrolled("places, body, like", f"return ({parts},)")


def moment(arm: Vector, force: Vector) -> Vector:
    """arm × force as three numbers; in 2D about z."""
    (x, y, z), (a, b, c) = ((*one, 0.0)[:3] for one in (arm, force))
    return y * c - z * b, z * a - x * c, x * b - y * a


@overload(moment)
def _moment(arm, force):
    about_z = "arm[0] * force[1] - arm[1] * force[0]"
    if len(arm) == 2:
        return unrolled("arm, force", f"return 0.0, 0.0, {about_z}")
    about_x, about_y = (f"arm[{e}] * force[{f}] - arm[{f}] * force[{e}]" for e, f in ((1, 2), (2, 0)))
    return unrolled("arm, force", f"return {about_x}, {about_y}, {about_z}")


def _book(found, body, force, torque, per_force, per_torque):
    for d in range(len(force)):
        found[body, d] += int(np.rint(force[d] * per_force))
    for d in range(3):
        found[body, 3 + d] += int(np.rint(torque[d] * per_torque))


@overload(_book)
def _typed_book(found, body, force, torque, per_force, per_torque):
    lines = [f"found[body, {d}] += int(rint(force[{d}] * per_force))" for d in range(len(force))]
    lines += [f"found[body, {3 + d}] += int(rint(torque[{d}] * per_torque))" for d in range(3)]
    return unrolled("found, body, force, torque, per_force, per_torque", *lines, rint=np.rint)
