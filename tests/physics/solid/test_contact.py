"""Contact of solids, a pair at a time: a push along the normal of drawn faces that has no bound, with an energy."""

from typing import Any, NamedTuple

import numpy as np
import pytest

from psph.composition.pair import Pair
from psph.physics.solid.contact import CALMING, SHARES, Rubbing, Touching, dashpot, meeting, modulus

DX = 0.01


class Particle(NamedTuple):
    """What contacts read of a particle."""

    solid: Any
    mass: Any
    wave_modulus: Any
    face: Any
    cover: Any
    face_rate: Any = (0.0, 0.0)
    contact_slip: Any = (0.0, 0.0)


def normal(degrees, length=1.0):
    return length * np.cos(np.radians(degrees)), length * np.sin(np.radians(degrees))


RUBBER = Particle(2.0, 0.12, 2e7, normal(205.0), 0.4)
STEEL = Particle(3.0, 0.79, 3e11, normal(25.0), 0.6)
"""Two flat faces aslant to the lattice, on each other."""


def pair_of(x, u=(0.0, 0.0)):
    x, u = np.array(x, float), np.array(u, float)
    r = np.linalg.norm(x)
    return Pair(x_ij=tuple(x), u_ij=tuple(u), r2=r * r, r=r, inverse_r=1.0 / r, u_dot_x=float(u @ x))


def at(gap, aside=0.0):
    """Where the rubber is whose face is so far from that of the steel, in spacings."""
    out, along = np.array(normal(25.0)), np.array(normal(115.0))
    return (gap + RUBBER.cover + STEEL.cover) * DX * out + aside * DX * along


def contact(kind=Touching, damping=0.0, friction=0.0):
    return kind(1.0, damping, friction, DX, 1.0 / SHARES[1], 0.0)


def force(effect, i, j, x, u=(0.0, 0.0)):
    """On i, N."""
    return i.mass * np.array(effect.push(i, j, pair_of(x, u)))


def turning(effect, i, j, x, u=(0.0, 0.0)):
    """What turns the normal of i, J."""
    return np.array(effect.gather(effect.start(i), i, j, pair_of(x, u))[1:3])


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


@pytest.mark.parametrize("kind", [Touching, Rubbing])
def test_a_face_aslant_pushes_along_its_normal_and_without_bound(kind):
    effect, out = contact(kind), np.array(normal(25.0))
    shallow, deep = (force(effect, RUBBER, STEEL, at(-gap)) for gap in (0.1, 0.9))
    assert shallow / np.linalg.norm(shallow) == pytest.approx(out)
    stiff = modulus(effect, RUBBER, STEEL)
    assert stiff == pytest.approx(2.0 * 2e7, rel=1e-3)  # as soft as the softer one
    share = meeting(effect, RUBBER, STEEL, pair_of(at(-0.1))).share
    assert np.linalg.norm(shallow) == pytest.approx(share * stiff * 0.1 * DX * 1.04)
    assert np.linalg.norm(deep) == pytest.approx(share * stiff * 0.9 * DX * 4.24)
    assert not force(effect, RUBBER, STEEL, at(0.001)).any()
    # Beside each other on the face, a pair pushes less, by the same overlap; far beside not at all.
    beside = meeting(effect, RUBBER, STEEL, pair_of(at(-0.1, 0.8)))
    assert beside.overlap == pytest.approx(0.1 * DX) and 0.0 < beside.share < share
    assert not force(effect, RUBBER, STEEL, at(-0.1, 1.6)).any()


BARE = RUBBER._replace(face=(0.0, 0.0))
ASLANT = RUBBER._replace(face=normal(190.0))
STEEP = RUBBER._replace(face=normal(125.0))
MET = (
    (RUBBER, STEEL, at(-0.3, 0.4)),
    (ASLANT, STEEL, at(-0.4, -0.5)),
    (STEEP, STEEL, at(-0.3, 0.3)),
    (ASLANT, STEEL, at(-1.9, 0.3)),
    (ASLANT._replace(cover=1.3), STEEL._replace(cover=1.3), at(1.1, 0.7)),
    (BARE, STEEL, at(-0.2, 0.3)),
)
"""A particle of rubber and one of steel, and where it is: faces that fit, aslant, at a wide angle, far behind,
at the end of their reach; one at an edge."""


def whole_energy(effect, i, j, x):
    """Of both particles, J."""
    halves = ((i, j, x), (j, i, -x))
    return sum(effect.gather(effect.start(i), i, j, pair_of(x))[0] for i, j, x in halves)


@pytest.mark.parametrize(("one", "other", "x"), MET)
def test_the_push_and_what_turns_normals_are_the_derivatives_of_the_energy(one, other, x):
    effect, step = contact(), 1e-7
    push, turned = force(effect, one, other, x), turning(effect, one, other, x)
    assert np.abs(push).max() > 0.0
    for d, way in enumerate(np.eye(2)):
        up, down = (whole_energy(effect, one, other, x + sign * step * DX * way) for sign in (1.0, -1.0))
        assert push[d] == pytest.approx(-(up - down) / (2.0 * step * DX), rel=1e-5, abs=1e-4)
    across = np.array([-one.face[1], one.face[0]])
    ends = [one._replace(face=tuple(one.face + sign * step * across)) for sign in (1.0, -1.0)]
    up, down = (whole_energy(effect, end, other, x) for end in ends)
    assert turned @ across == pytest.approx(-(up - down) / (2.0 * step), rel=1e-5, abs=1e-6)
    assert force(effect, other, one, -x) == pytest.approx(-push, rel=1e-13)


@pytest.mark.parametrize(("one", "other", "x"), MET[:5])
@pytest.mark.parametrize("kind", [Touching, Rubbing])
def test_no_moment_is_left_with_that_on_the_normals(kind, one, other, x):
    """x_ij × f + N_i × T_i + N_j × T_j = 0, with damping and friction."""
    effect, u, slipped = contact(kind, 0.5, 0.3), (-3.0, 5.0), one._replace(contact_slip=(1e-5, 2e-5))
    moments = [cross(x, force(effect, slipped, other, x, u))]
    moments += [cross(slipped.face, turning(effect, slipped, other, x, u))]
    moments += [cross(other.face, turning(effect, other, slipped, -x, tuple(-np.array(u))))]
    assert np.abs(moments).min() > 0.0
    assert sum(moments) == pytest.approx(0.0, abs=1e-12 * np.abs(moments).max())


def test_an_edge_takes_the_normal_of_the_face_that_it_meets():
    edge = RUBBER._replace(face=(0.0, 0.0))
    out = meeting(contact(), edge, STEEL, pair_of(at(-0.1, 0.5))).out
    assert out == pytest.approx(normal(25.0))
    both = meeting(contact(), edge, STEEL._replace(face=(0.0, 0.0)), pair_of((0.3 * DX, 0.4 * DX))).out
    assert both == pytest.approx((0.6, 0.8))


def test_within_one_solid_and_between_faces_that_look_the_same_way_nothing_is_felt():
    effect = contact(Rubbing, 0.5, 0.3)
    within = force(effect, RUBBER, STEEL._replace(solid=2.0), at(-0.5), (-3.0, 5.0))
    alike = force(effect, RUBBER, STEEL._replace(face=RUBBER.face), at(-0.5), (-3.0, 5.0))
    deep = force(effect, RUBBER, STEEL._replace(cover=1.5), at(-0.5), (-3.0, 5.0))
    assert not within.any() and not alike.any() and not deep.any()


def test_damping_slows_what_comes_and_never_holds_what_goes():
    calm, damped, out = contact(), contact(damping=0.5), np.array(normal(25.0))
    x = at(-0.2)
    still, coming, going = (force(damped, RUBBER, STEEL, x, u * out) @ out for u in (0.0, -2.0, 2.0))
    assert still == pytest.approx(force(calm, RUBBER, STEEL, x) @ out) and coming > still > going >= 0.0
    share = meeting(calm, RUBBER, STEEL, pair_of(x)).share
    assert coming - still == pytest.approx(share * dashpot(calm, RUBBER, STEEL) * 0.5 * 2.0)
    assert force(damped, RUBBER, STEEL, x, 1e6 * out) == pytest.approx((0.0, 0.0), abs=1e-6)


def test_friction_is_coulombs_and_holds_what_has_slipped_little():
    effect, out, along = contact(Rubbing, friction=0.3), np.array(normal(25.0)), np.array(normal(115.0))
    x = at(-0.2)
    push = force(effect, RUBBER, STEEL, x) @ out
    fast, slow = (force(effect, RUBBER, STEEL, x, u * along) for u in (50.0, 1e-6))
    assert fast == pytest.approx(push * (out - 0.3 * along))
    share = meeting(effect, RUBBER, STEEL, pair_of(x)).share
    assert slow @ along == pytest.approx(-share * CALMING * dashpot(effect, RUBBER, STEEL) * 1e-6)
    coming = force(effect, RUBBER, STEEL, x, -5.0 * out)  # no part of u along the normal rubs
    assert coming == pytest.approx(push * out)
    little, much = (RUBBER._replace(contact_slip=tuple(s * along)) for s in (1e-7, 1.0))
    held = force(effect, little, STEEL, x) @ along
    assert held == pytest.approx(-share * modulus(effect, RUBBER, STEEL) * 0.5e-7)
    assert force(effect, much, STEEL, x) == pytest.approx(push * (out - 0.3 * along))


def test_what_turns_as_one_does_not_rub():
    effect, spin = contact(Rubbing, friction=0.3), 7.0
    x = at(-0.2)

    def turned(a):
        return -spin * a[1], spin * a[0]

    one, other = (i._replace(face_rate=turned(i.face)) for i in (RUBBER, STEEL))
    still = force(effect, RUBBER, STEEL, x)
    assert force(effect, one, other, x, turned(x)) == pytest.approx(still, rel=1e-12)
    assert force(effect, RUBBER, STEEL, x, turned(x)) != pytest.approx(still, rel=1e-6)
