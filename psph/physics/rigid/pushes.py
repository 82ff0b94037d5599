"""What pushes and pulls rigid bodies: the loads of their particles, added as whole numbers."""

import numpy as np
from numba.core import types

from psph.composition import terms
from psph.composition.pair import take
from psph.engine.jit import elementwise, overload, tuple_of, unrolled
from psph.vectors import Vector, add, at, nearest_image, scale, subtract, zero_like


@elementwise
def add_pushes(first, last, body_of, places, units, periods, pulls, masses, view, columns):
    """F = Σ f_w and T = Σ (x_w − X) × f_w + m_w c_w of each body, f_w = m_w a_w + M_w b_w.

    Over the columns ``first`` to ``last``; ``body_of`` has the row of each group's body, −1 without one,
    and ``places`` X, m, the point about which each turns.  a_w is the acceleration by the fluid alone of a
    particle with the mass m_w that it shows, c_w its couple (psph.composition.loads), b_w that by
    the effects ``pulls`` on its part M_w of the body's mass, by ``masses`` (psph.scene.bodies.shares_of).
    Returns whole numbers (bodies, 6) of the ``units`` of force, N, and of torque, N m, so that
    the sums do not depend on the order of particles.
    """
    found = np.zeros((len(places), 6), np.int64)
    per_force, per_torque = 1.0 / units[0], 1.0 / units[1]
    for k in range(np.uint64(first), np.uint64(last)):
        body = body_of[columns.group[k]]
        if body < 0:
            continue
        force = pulled(pulls, masses, body, take(view, k), k, columns)
        if force == zero_like(force):
            continue
        arm = nearest_image(subtract(at(columns.position, k), point(places, body, force)), periods)
        torque = twisted(moment(arm, force), columns.couple, k, take(view, k).mass)
        book(found, body, force, torque, per_force, per_torque)
    return found


def pulled(pulls, masses, body, i, k, columns) -> Vector:
    """The force on particle ``k`` of a ``body``, seen as ``i``, N."""
    return (
        _pulled(pulls, masses, body, i, k, columns) if pulls else _pushed(pulls, masses, body, i, k, columns)
    )


def _pushed(pulls, masses, body, i, k, columns):
    return scale(at(columns.load, k), i.mass)


def _pulled(pulls, masses, body, i, k, columns):
    share, anchor = masses[body, 0], at(columns.anchor, k)
    for d in range(len(anchor)):
        share += masses[body, 1 + d] * anchor[d]
    return add(scale(at(columns.load, k), i.mass), scale(terms.body(pulls, i), share))


@overload(pulled)
def _typed_pulled(pulls, masses, body, i, k, columns):
    return _pulled if len(pulls) else _pushed


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


def twisted(torque, couple, k, mass):
    """A torque and the couple of particle ``k``, N m; the torque where nothing has couples."""
    if couple is None:
        return torque
    own = scale(at(couple, k), mass)
    return add(torque, (0.0,) * (3 - len(own)) + own)


@overload(twisted)
def _typed_twisted(torque, couple, k, mass):
    if isinstance(couple, types.NoneType):
        return lambda torque, couple, k, mass: torque
    first = 3 - len(couple)
    parts = (f"torque[{d}]" + f" + couple[{d - first}][k] * mass" * (d >= first) for d in range(3))
    return unrolled("torque, couple, k, mass", f"return {tuple_of(parts)}")


def book(found, body, force, torque, per_force, per_torque):
    """Add a force and a torque to those ``found`` for a body, in whole numbers."""
    for d in range(len(force)):
        found[body, d] += int(np.rint(force[d] * per_force))
    for d in range(3):
        found[body, 3 + d] += int(np.rint(torque[d] * per_torque))


@overload(book)
def _typed_book(found, body, force, torque, per_force, per_torque):
    lines = [f"found[body, {d}] += int(rint(force[{d}] * per_force))" for d in range(len(force))]
    lines += [f"found[body, {3 + d}] += int(rint(torque[{d}] * per_torque))" for d in range(3)]
    return unrolled("found, body, force, torque, per_force, per_torque", *lines, rint=np.rint)
