"""Contact of solids, a pair at a time: a push that is the derivative of an energy, damping and friction."""

from typing import Any, NamedTuple

import numpy as np
import pytest

from psph.composition.pair import Pair
from psph.physics.solid.contact import Rubbing, Touching, dashpot, pressing, spring

DX = 0.01


class Particle(NamedTuple):
    """What contacts read of a particle."""

    solid: Any
    mass: Any
    wave_modulus: Any


RUBBER, STEEL = Particle(2.0, 0.12, 2e7), Particle(3.0, 0.79, 3e11)


def pair_of(x, u=(0.0, 0.0)):
    x, u = np.array(x, float), np.array(u, float)
    r = np.linalg.norm(x)
    return Pair(x_ij=tuple(x), u_ij=tuple(u), r2=r * r, r=r, inverse_r=1.0 / r, u_dot_x=float(u @ x))


def contact(kind=Touching, damping=0.0, friction=0.0):
    return kind(1.0, damping, friction, DX, 0.0)


def force(effect, i, j, x, u=(0.0, 0.0)):
    """On i, N."""
    pair = pair_of(x, u)
    found = effect.radial(i, j, pair) * np.array(x)
    if hasattr(effect, "shear"):
        found = found + effect.shear(i, j, pair) * np.array(u)
    return i.mass * found


def test_the_push_is_the_derivative_of_the_energy_and_that_of_both_the_same():
    effect, step = contact(), 1e-7
    for x in ((0.7 * DX, 0.2 * DX), (1.1 * DX, -1.2 * DX), (0.0, 1.9 * DX)):
        found = force(effect, RUBBER, STEEL, x)
        for d in (0, 1):
            ends = []
            for sign in (1.0, -1.0):
                moved = np.array(x)
                moved[d] += sign * step
                pair = pair_of(moved)
                both = ((RUBBER, STEEL), (STEEL, RUBBER))
                ends.append(sum(effect.gather(0.0, i, j, pair) for i, j in both))
            assert found[d] == pytest.approx(-(ends[0] - ends[1]) / (2.0 * step), rel=1e-5, abs=1e-4)
        assert force(effect, STEEL, RUBBER, -np.array(x)) == pytest.approx(-found, rel=1e-14)
        assert pressing(effect, RUBBER, STEEL, pair_of(x)) == pressing(
            effect, STEEL, RUBBER, pair_of(-np.array(x))
        )
    assert spring(effect, RUBBER, STEEL) == pytest.approx(2.0 * 2e7, rel=1e-3)  # as soft as the softer one


def test_beyond_two_spacings_and_within_one_solid_nothing_is_felt():
    effect = contact(Rubbing, 0.5, 0.3)
    apart = force(effect, RUBBER, STEEL, (2.001 * DX, 0.0), (-3.0, 5.0))
    within = force(effect, RUBBER, RUBBER._replace(mass=0.2), (0.5 * DX, 0.0), (-3.0, 5.0))
    assert not apart.any() and not within.any()


def test_damping_slows_what_comes_and_never_holds_what_goes():
    calm, damped = contact(), contact(damping=0.5)
    x = (DX, 0.0)
    still, coming, going = (force(damped, RUBBER, STEEL, x, (u, 0.0))[0] for u in (0.0, -2.0, 2.0))
    assert still == force(calm, RUBBER, STEEL, x)[0] and coming > still > going >= 0.0
    assert coming - still == pytest.approx(dashpot(calm, RUBBER, STEEL) * 0.5 * 1.0 * 2.0)
    assert force(damped, RUBBER, STEEL, x, (1e6, 0.0))[0] == 0.0


def test_friction_is_coulombs_and_stops_what_slides_slowly():
    effect = contact(Rubbing, friction=0.3)
    x = (1.2 * DX, 0.0)
    push = force(effect, RUBBER, STEEL, x)[0]
    fast, reverse, slow = (force(effect, RUBBER, STEEL, x, (0.0, u)) for u in (50.0, -50.0, 1e-6))
    assert fast == pytest.approx([push, -0.3 * push]) and reverse == pytest.approx([push, 0.3 * push])
    assert slow == pytest.approx([push, -dashpot(effect, RUBBER, STEEL) * 1e-6])
    coming = force(effect, RUBBER, STEEL, x, (-5.0, 0.0))  # no part of u along x_ij rubs
    assert coming == pytest.approx([push, 0.0])
