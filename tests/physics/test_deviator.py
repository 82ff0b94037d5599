"""A deviatoric stress that evolves: its rate in a linear flow, and the force of a pair."""

from types import SimpleNamespace

import numpy as np
import pytest
from physics.pairs import pair_of, sums_of, view

from psph.composition.pair import Pair
from psph.physics.motion import Fixed
from psph.physics.rigid.laws import SteadyRate
from psph.physics.rigid.motion import MotionPart, Rigid
from psph.physics.rigid.schedule import ActingTime
from psph.physics.stress.deviator import CorrectedDeviatoricForce, DeviatoricForce, DeviatorRate, jaumann_rate
from psph.physics.stress.faces import (
    CorrectedSmoothFace,
    OwnPressure,
    SmoothFace,
    StillColumn,
    column_of,
    facing,
    steepness,
)

UPPER = {2: ((0, 0), (0, 1), (1, 1)), 3: ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))}


def full(packed, dim):
    """A symmetric matrix from its rows from the diagonal on."""
    made = np.zeros((dim, dim))
    for value, (a, b) in zip(packed, UPPER[dim]):
        made[a, b] = made[b, a] = value
    return made


def by_matrices(gradient, s, modulus):
    """The rate of Jaumann in three dimensions: plane strain has D and Ω without a third row."""
    dim = len(gradient)
    d, w = 0.5 * (gradient + gradient.T), 0.5 * (gradient - gradient.T)
    return 2 * modulus * (d - np.trace(d) / 3 * np.eye(dim)) + w @ s - s @ w


@pytest.mark.parametrize("dim", (2, 3))
def test_a_linear_flow_gives_the_rate_of_jaumann_in_disorder(dim):
    rng = np.random.default_rng(5)
    gradient = rng.normal(size=(dim, dim)) * 30.0
    p = view(n=40, dim=dim)
    x = np.array(p.position)
    p = p._replace(velocity=tuple(gradient @ x), shear_modulus=np.full(40, 4e4), no_slip=np.zeros(40))
    found = sums_of(DeviatorRate(), p, 0)
    expected = by_matrices(gradient, full([s[0] for s in p.deviator], dim), 4e4)
    assert found == pytest.approx([expected[place] for place in UPPER[dim]], rel=1e-10)


@pytest.mark.parametrize("dim", (2, 3))
def test_a_turn_turns_the_stress_and_keeps_its_invariants(dim):
    s = tuple(np.random.default_rng(1).normal(size=len(UPPER[dim])))
    spin = np.triu(np.ones((dim, dim)), 1)
    rate = full(jaumann_rate(tuple((spin - spin.T).ravel()), s, 4e4, (0.0,) * dim), dim)
    assert np.trace(rate) == pytest.approx(0.0, abs=1e-14)
    assert np.sum(rate * full(s, dim)) == pytest.approx(0.0, abs=1e-14)
    assert np.abs(rate).max() > 0.1


def test_water_and_smooth_walls_do_not_count_in_the_flow_of_what_resists_shear():
    p = view(n=6)
    keep = np.array([1.0, 1.0, 1.0, 1.0, 0.0, 0.0])  # the last two: water, and a wall
    p = p._replace(shear_modulus=4e4 * keep, no_slip=np.zeros(6))
    moved = tuple(v + 7.0 * (1.0 - keep) for v in p.velocity)
    assert sums_of(DeviatorRate(), p, 0) == sums_of(DeviatorRate(), p._replace(velocity=moved), 0)
    rough = p._replace(no_slip=1.0 - keep)
    assert sums_of(DeviatorRate(), rough, 0) != sums_of(DeviatorRate(), p, 0)


@pytest.mark.parametrize("force", (DeviatoricForce(), CorrectedDeviatoricForce()))
@pytest.mark.parametrize("dim", (2, 3))
def test_the_force_is_that_of_both_stresses_and_keeps_momentum(force, dim):
    p = view(dim=dim)._replace(no_slip=np.zeros(2))
    pushes = []
    for a, b in ((0, 1), (1, 0)):
        i, j, pair = pair_of(p, a, b)
        x, total = np.array(pair.x_ij), 0.0
        for one in (i, j):
            more = full(one.gradient_correction, dim) if isinstance(force, CorrectedDeviatoricForce) else 0.0
            total += full(one.deviator, dim) @ (np.eye(dim) + more) @ x * one.specific_volume**2
        expected = j.mass * pair.dw_r * total
        assert force.push(i, j, pair) == pytest.approx(expected, rel=1e-12)
        pushes.append(i.mass * expected)
    assert pushes[0] == pytest.approx(-pushes[1], rel=1e-12)


def test_a_rough_wall_shows_what_stands_before_it_its_own_stress():
    p = view()
    s = tuple(np.array([v[0], 0.0]) for v in p.deviator)  # the wall bears none
    pressed = p._replace(pressure=np.array([2e3, 2e3]), cone_tip=np.array([500.0, 0.0]))
    rough = pressed._replace(deviator=s, no_slip=np.array([0.0, 1.0]))
    smooth = rough._replace(no_slip=np.zeros(2))
    one, two = (DeviatoricForce().push(*pair_of(q, 0, 1)) for q in (smooth, rough))
    assert two == pytest.approx(2.0 * np.array(one), rel=1e-14) and np.abs(one).max() > 0.0
    back = DeviatoricForce().push(*pair_of(rough, 1, 0))
    assert rough.mass[1] * np.array(back) == pytest.approx(-rough.mass[0] * np.array(two), rel=1e-12)
    for wall, steep in ((4500.0, 2.0), (-900.0, 0.2), (9e4, 3.0)):  # (p + tip) of the wall over that of soil
        other = DeviatoricForce().push(*pair_of(rough._replace(pressure=np.array([2e3, wall])), 0, 1))
        assert other == pytest.approx((1.0 + steep) * np.array(one), rel=1e-12)


@pytest.mark.parametrize("wall, share", ((-900.0, 1.8 / 3.0), (9e4, 2.0), (None, 0.8)))
def test_the_weight_of_a_still_column_bounds_what_it_shows_by_its_own_pressure(wall, share):
    p = view()
    p = p._replace(cone_tip=np.array([500.0, 0.0]), no_slip=np.array([0.0, 1.0]))
    p = p._replace(rest_coefficient=np.array([0.4, 0.7]), rest_density=np.array([1500.0, 1900.0]))
    p = p._replace(pressure=np.array([2e3, 0.0]))
    i, j, pair = pair_of(p, 0, 1)
    gravity = tuple(-1.0 * np.array(pair.x_ij) / np.dot(pair.x_ij, pair.x_ij))  # the wall is below
    weight = 1500.0 * 1.0  # of soil between both
    p = p._replace(pressure=np.array([2e3, 2e3 + share * weight if wall is None else wall]))
    i, j, pair = pair_of(p, 0, 1)
    assert steepness(StillColumn(gravity), i, j, pair)[1] == pytest.approx(1.0 + share * weight / 2500.0)


@pytest.mark.parametrize("dim", (2, 3))
@pytest.mark.parametrize("effect", (SmoothFace(), CorrectedSmoothFace()))
def test_a_smooth_wall_bears_the_stress_across_its_face_and_no_shear_along_it(effect, dim):
    """s + R s R has no components n, t; the wall is pushed back as hard as it pushes."""
    p, n = view(dim=dim), np.array([0.6, 0.8, 0.0][:dim])
    s = tuple(np.array([v[0], 0.0]) for v in p.deviator)
    none = tuple(np.zeros(2) for _ in p.deviator)
    p = p._replace(deviator=s, pressure=np.array([2e3, 3e3]), cone_tip=np.array([500.0, 0.0]))
    zero = tuple(np.zeros(2) for _ in n)
    p = p._replace(face_normal=tuple(np.array([0.0, one]) for one in n), gradient_correction=none)
    p = p._replace(face_side=zero, face_edge=np.zeros(2))
    i, j, pair = pair_of(p, 0, 1)
    stress, turn = full([v[0] for v in s], dim), np.eye(dim) - 2.0 * np.outer(n, n)
    shown = turn @ stress @ turn * i.specific_volume**2 * 3.5 / 2.5  # (p + tip) of the wall over that of soil
    assert effect.push(i, j, pair) == pytest.approx(shown @ np.array(pair.x_ij) * pair.m_dw_r, rel=1e-12)
    back = np.array(effect.push(*pair_of(p, 1, 0)))
    assert p.mass[1] * back == pytest.approx(-p.mass[0] * np.array(effect.push(i, j, pair)), rel=1e-12)
    free = p._replace(face_normal=zero)
    assert not np.any(effect.push(*pair_of(free, 0, 1)))
    hollow = p._replace(face_normal=zero if dim == 2 else p.face_normal, face_edge=np.array([0.0, 1.0]))
    turn = np.eye(2) if dim == 2 else turn  # along the edge nothing rubs
    shown = turn @ stress @ turn * i.specific_volume**2 * 3.5 / 2.5
    assert effect.push(*pair_of(hollow, 0, 1)) == pytest.approx(shown @ np.array(pair.x_ij) * pair.m_dw_r)


@pytest.mark.parametrize(
    "towards, face", (((1.0, 0.2), 0), ((0.1, -1.0), 1), ((-0.3, -1.0), 1), ((1.0, -1.0), None))
)
def test_of_two_faces_as_near_the_one_before_a_particle_counts(towards, face):
    """Of the lower right corner of a block; as far before both, none."""
    faces = np.array([[1.0, 0.0], [0.0, -1.0]])
    normal, side = faces.mean(axis=0), 0.5 * (faces[0] - faces[1])
    pair = Pair(x_ij=towards, u_ij=(0.3, 0.7), inverse_r=1.0 / np.hypot(*towards))
    found = np.array(facing(tuple(normal), tuple(side), 0.0, pair))
    back = facing(tuple(-normal), tuple(-side), 0.0, pair._replace(x_ij=(-towards[0], -towards[1])))
    assert back == pytest.approx(-found)
    whole = found @ found
    assert whole == pytest.approx(0.0) if face is None else whole > 0.8
    assert face is None or found == pytest.approx(np.sqrt(whole) * faces[face])


def walls(*motions):
    """A scene with walls that move so."""
    species = [SimpleNamespace(solid=1.0, motion=motion) for motion in motions]
    return SimpleNamespace(species=species, gravity=(0.0, -9.81), frame=None)


def steady(speed, spin=0.0, **acting):
    """A steady motion along x, m/s, and turn, rad/s."""
    return Rigid((MotionPart(SteadyRate((speed, 0.0, 0.0, spin)), ActingTime(**acting)),))


def test_walls_that_all_drift_alike_are_as_walls_at_rest():
    still, two = StillColumn((None, -9.81)), steady(2.0)
    assert column_of(walls(Fixed(), Fixed())) == column_of(walls(two, two)) == still
    for others in ((Fixed(), two), (two, steady(3.0)), (steady(2.0, start=1.0),), (steady(2.0, spin=1.0),)):
        assert column_of(walls(*others)) == OwnPressure()
