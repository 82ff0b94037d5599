"""How long the lists of steps in two passes hold: where particles will be against every listed pair."""

import math

import numpy as np
import pytest
from parallel.test_skin import CUTOFF, NAMES, WIDE, domain_of, images_apart, over_pairs

from psph.composition.reflections import ABOVE, BELOW, Plane
from psph.parallel.arrivals import Arrivals
from psph.parallel.skin import Skin

COMING = "coming"


def lists_of(n, dim, periodic=(), planes=(), seed=3):
    domain = domain_of(n, dim, periodic, seed, (*NAMES, COMING))
    return domain, Arrivals(domain, WIDE, planes, None, COMING)


def rows(store, name):
    return list(store.rows[name])


def lasting(domain, skin, way, speed, dt=1e-3, most=400):
    """Steps that lists last when particles go ``way(step, x)`` m in each, as they are told."""
    store = domain.store
    for step in range(most):
        here = store.data[rows(store, "position"), store.inner]
        store.data[rows(store, COMING), store.inner] = going = way(step, here)
        if not skin.holds(dt, speed, 0.0):
            return step
        store.data[rows(store, "position"), store.inner] = here + going
        domain.halo.refresh(("position",))
        assert over_pairs(domain)[0] < WIDE
    return most


def test_a_body_that_moves_as_one_keeps_its_lists():
    lasted = lasting(*lists_of(300, 2), lambda step, x: np.full_like(x, 3e-3), 3.0 * math.sqrt(2.0))
    assert lasted == int(0.5 * CUTOFF / (math.sqrt(2.0) * 3e-3))


def test_jets_end_them_before_two_are_a_skin_apart():
    def jets(step, x):
        return np.stack([np.where(x[1] > 0.5, 3e-3, -3e-3), 0.0 * x[1]])

    assert lasting(*lists_of(300, 2), jets, 3.0) == 3  # 6 mm a step, 20 mm


def test_what_comes_back_ends_no_lists():
    """Particles that step aside and back, each its own way.  The control: a bound by the largest shift."""
    ways = np.random.default_rng(7).uniform(0.0, 2.0 * np.pi, 300)
    asides = 5e-3 * np.stack([np.cos(ways), np.sin(ways)])
    assert lasting(*lists_of(300, 2), lambda step, x: asides * (-1.0) ** step, 5.0, most=60) == 60
    domain = domain_of(300, 2)
    store, bounded, steps = domain.store, Skin(domain, WIDE), 0
    while steps < 60 and bounded.holds(1e-3, 0.0, 0.0, 5.0):
        store.data[rows(store, "position"), store.inner] += asides * (-1.0) ** steps
        steps += 1
    assert steps < 5


@pytest.mark.parametrize("axis", (0, 1, 2))
def test_two_that_meet_across_a_period_are_seen(axis):
    """The owner of a ghost knows its way, the ghost does not: boxes of ghosts are those of their owners."""
    domain, skin = lists_of(400, 3, (axis,))

    def into_the_border(step, x):
        going = np.zeros_like(x)
        going[axis] = np.where(x[axis] > 0.5, 2e-3, -2e-3)
        return np.where((x[axis] < 0.1) | (x[axis] > 0.9), going, 0.0)

    lasted = lasting(domain, skin, into_the_border, 2.0)
    assert 1 < lasted <= 5  # 4 mm a step, 20 mm


@pytest.mark.parametrize("plane", (Plane(0, BELOW, 0.0), Plane(1, ABOVE, 1.0)))
def test_images_are_listed_while_particles_are_before_the_mirror(plane):
    """Without the plane lists hold too long, as a body that moves as one keeps them."""
    missed = {}
    for planes in ((plane,), ()):
        domain, skin = lists_of(900, 2, planes=planes)
        store = domain.store
        row, inner = store.rows["position"][plane.axis], store.inner
        store.data[store.rows[COMING][plane.axis], inner] = 1e-3 * plane.side
        missed[planes] = 0
        while skin.drifted < 0.07 and skin.holds(1e-3, 1.0, 0.0):
            store.data[row, inner] += 1e-3 * plane.side
            away, listed = images_apart(domain, plane)
            missed[planes] = max(missed[planes], np.count_nonzero(~listed & (away < CUTOFF - WIDE)))
            assert not planes or missed[planes] == 0
        if planes:
            assert skin.drifted > 0.3 * WIDE  # not at once
    assert missed[()] > 0


def test_a_broken_number_ends_them():
    _, skin = lists_of(100, 2)
    assert skin.holds(1e-3, 1.0, 1.0)
    assert not skin.holds(1e-3, np.nan, np.nan)
