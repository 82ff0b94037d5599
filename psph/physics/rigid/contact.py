"""Contact of rigid bodies with each other, with walls and with mirrors: hard, by impulses."""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import elementwise
from psph.vectors import add, dot, multiply, scale

ROUNDS = 200
"""Rounds over all contacts at most."""

ENOUGH = 1e-10
"""Part of the largest impulse below which a round changes nothing."""

HELD = 1e-10
"""Part of its giving way that joints leave to a point below which they hold it: no impulse moves it."""

OUT = 0.2
"""Part of an overlap that a step takes back."""


class BodyContacts(NamedTuple):
    """Points in which bodies may meet in a step, each an entry of m.

    ``first`` (m,) is the row of a body, ``second`` that of the body it meets, −1 for a wall; ``arms`` and
    ``other_arms`` (m, 3) lead from their reference points to the point, m; ``normal`` (m, 3) is the unit
    vector out of the second; ``gap`` (m,) m how far the point is before the face; ``prescribed`` (m, 3)
    m/s the velocity of a wall there.
    """

    first: np.ndarray
    second: np.ndarray
    arms: np.ndarray
    other_arms: np.ndarray
    normal: np.ndarray
    gap: np.ndarray
    prescribed: np.ndarray


class Yielding(NamedTuple):
    """How bodies give way to an impulse P at the arm r.

    Velocities change by ``sliding`` (n, 3) P, 1/kg, and spins by ``turning`` (n, 3, 3) (r × P), 1/(kg m²);
    zeros in what is held.
    """

    sliding: np.ndarray
    turning: np.ndarray


class Answers(NamedTuple):
    """How joints answer to impulses at points of contact, in r rows; r is 0 where nothing is joined.

    After impulses P at the points they bear ``borne`` (r,) = Σ ``answer`` (m, r, 3) P, N s or N m s, for
    which the points part by ``near`` (m, 3, r) times that more slowly (psph.physics.rigid.joints_answer).
    """

    near: np.ndarray
    answer: np.ndarray
    borne: np.ndarray


def approach(touching: BodyContacts, velocity: np.ndarray, spin: np.ndarray) -> np.ndarray:
    """The speed (m,) m/s at which points of contact part, of bodies with ``velocity`` and ``spin`` (n, 3)."""
    one, other = touching.first, touching.second
    here = velocity[one] + np.cross(spin[one], touching.arms)
    there = velocity[other] + np.cross(spin[other], touching.other_arms)
    there = np.where(other[:, None] < 0, touching.prescribed, there)
    return ((here - there) * touching.normal).sum(axis=1)


@elementwise
def solve(touching, yielding, wanted, friction, velocity, spin, joined):
    """The impulses (m, 3) N s after which no point parts more slowly than ``wanted`` (m,) m/s.

    Signorini and Coulomb: along the normal p ≥ 0, and above 0 only where the point would part more slowly;
    along the face |p_t| ≤ μ p, against the sliding, and below that only where nothing slides any more.  By
    rounds over the contacts one after the other (Gauss & Seidel projected: Moreau 1988; Jourdan, Alart & Jean
    1998, Comput. Methods Appl. Mech. Eng. 155, 31; Catto 2005).  ``velocity`` and ``spin`` (n, 3) take what
    the impulses change, ``joined`` what joints bear of them.
    """
    count = len(touching.first)
    impulse, along = np.zeros((count, 3)), np.zeros(count)
    for _ in range(ROUNDS):
        changed = largest = 0.0
        for c in range(count):
            slip = _sliding(touching, c, velocity, spin, joined)
            normal = _row(touching.normal, c)
            give = _give(touching, yielding, c, normal, joined)
            if give > 0.0:
                pushed = max(along[c] + (wanted[c] - dot(slip, normal)) / give, 0.0)
                step = pushed - along[c]
                along[c] = pushed
                _push(touching, yielding, c, scale(normal, step), impulse, velocity, spin, joined)
                changed, largest = max(changed, abs(step)), max(largest, pushed)
            if friction > 0.0:  # also of one that is let go: its friction goes with its push
                most = friction * along[c]
                rubbed = _rub(touching, yielding, c, most, impulse, velocity, spin, joined)
                changed = max(changed, rubbed)
        if changed <= ENOUGH * largest:
            break
    return impulse


@elementwise
def _rub(touching, yielding, c, most, impulse, velocity, spin, joined):
    """Friction of at most ``most`` N s at contact c; returns how much it changed."""
    normal, slip = _row(touching.normal, c), _sliding(touching, c, velocity, spin, joined)
    slip = add(slip, scale(normal, -dot(slip, normal)))
    speed = np.sqrt(dot(slip, slip))
    own = _row(impulse, c)
    held = add(own, scale(normal, -dot(own, normal)))
    wanted = held
    if speed > 0.0:
        give = _give(touching, yielding, c, scale(slip, 1.0 / speed), joined)
        if give > 0.0:
            wanted = add(held, scale(slip, -1.0 / give))
    size = np.sqrt(dot(wanted, wanted))
    if size > most:
        wanted = scale(wanted, most / size)
    step = add(wanted, scale(held, -1.0))
    _push(touching, yielding, c, step, impulse, velocity, spin, joined)
    return np.sqrt(dot(step, step))


@elementwise
def _sliding(touching, c, velocity, spin, joined):
    """The velocity of the first at contact c relative to the second, m/s."""
    i, j = touching.first[c], touching.second[c]
    here = add(_row(velocity, i), _cross(_row(spin, i), _row(touching.arms, c)))
    if j < 0:
        slip = add(here, scale(_row(touching.prescribed, c), -1.0))
    else:
        there = add(_row(velocity, j), _cross(_row(spin, j), _row(touching.other_arms, c)))
        slip = add(here, scale(there, -1.0))
    for k in range(len(joined.borne)):
        slip = add(slip, scale(_column(joined.near, c, k), -joined.borne[k]))
    return slip


@elementwise
def _give(touching, yielding, c, way, joined):
    """By how much both give way along a unit vector, 1/kg; 0 where joints hold them."""
    i, j = touching.first[c], touching.second[c]
    given = _give_of(yielding, i, _row(touching.arms, c), way)
    if j >= 0:
        given += _give_of(yielding, j, _row(touching.other_arms, c), way)
    left = given
    for k in range(len(joined.borne)):
        left -= dot(way, _column(joined.near, c, k)) * dot(_row(joined.answer[c], k), way)
    return left if left > HELD * given else 0.0


@elementwise
def _give_of(yielding, row, arm, way):
    twist = _cross(arm, way)
    slid = dot(way, multiply(_row(yielding.sliding, row), way))
    return slid + dot(twist, _turned(yielding.turning, row, twist))


@elementwise
def _push(touching, yielding, c, push, impulse, velocity, spin, joined):
    """Let an impulse act at contact c."""
    i, j = touching.first[c], touching.second[c]
    _shove(yielding, i, _row(touching.arms, c), push, velocity, spin)
    if j >= 0:
        _shove(yielding, j, _row(touching.other_arms, c), scale(push, -1.0), velocity, spin)
    for d in range(3):
        impulse[c, d] += push[d]
    for k in range(len(joined.borne)):
        joined.borne[k] += dot(_row(joined.answer[c], k), push)


@elementwise
def _shove(yielding, row, arm, push, velocity, spin):
    turn = _turned(yielding.turning, row, _cross(arm, push))
    for d in range(3):
        velocity[row, d] += yielding.sliding[row, d] * push[d]
        spin[row, d] += turn[d]


@elementwise
def _row(rows, k):
    return rows[k, 0], rows[k, 1], rows[k, 2]


@elementwise
def _column(rows, c, k):
    return rows[c, 0, k], rows[c, 1, k], rows[c, 2, k]


@elementwise
def _cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@elementwise
def _turned(turns, k, a):
    return (
        turns[k, 0, 0] * a[0] + turns[k, 0, 1] * a[1] + turns[k, 0, 2] * a[2],
        turns[k, 1, 0] * a[0] + turns[k, 1, 1] * a[1] + turns[k, 1, 2] * a[2],
        turns[k, 2, 0] * a[0] + turns[k, 2, 1] * a[1] + turns[k, 2, 2] * a[2],
    )
