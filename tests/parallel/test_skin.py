"""How long lists hold: bounds against every listed pair, and the flows that keep or end them."""

import math

import numpy as np
import pytest
from mpi4py import MPI
from stores import store_of

from psph.composition.reflections import ABOVE, BELOW, Plane
from psph.parallel.domain import Domain, Extent, Travels
from psph.parallel.skin import Bounds, Skin
from psph.particles.drift import bounding_boxes, largest_differences

NAMES = ("position", "listed_position", "predicted_velocity")
CUTOFF, WIDE = 0.17, 0.02


def domain_of(n, dim, periodic=(), seed=3, names=NAMES):
    rng = np.random.default_rng(seed)
    store = store_of(dim, names)
    block = np.zeros((len(store.data), n))
    block[list(store.rows["position"])] = rng.uniform(0, 1, (dim, n))
    store.append(np.arange(n), np.zeros(n, np.uint8), block)
    periods = tuple(1.0 if d in periodic else None for d in range(dim))
    extent = Extent(0, (0.0,) * dim, (1.0,) * dim, periods)
    domain = Domain(MPI.COMM_SELF, store, extent, CUTOFF, Travels((), ("position", "predicted_velocity")))
    domain.rebuild()
    return domain


def rows_of(store, name):
    return np.array(store.rows[name], np.int64)


def measured(domain):
    store, grid = domain.store, domain.grid
    boxes = bounding_boxes(
        store.data,
        *(rows_of(store, name) for name in NAMES),
        domain.starts,
        domain.planes,
        grid.counts,
        grid.reach,
        grid.periodic,
    )
    return np.sqrt(largest_differences(*boxes, domain.planes, grid.counts[1], grid.of_counts, grid.periodic))


def over_pairs(domain):
    """The largest true differences over every pair that is listed."""
    store, lists = domain.store, domain.lists
    moved = np.array([x - y for x, y in zip(store["position"], store["listed_position"])])
    v = np.array(store["predicted_velocity"])
    apart = closing = 0.0
    for k in range(store.owned):
        begin = int(lists.begin[k])
        row = lists.lists[begin : begin + int(lists.lengths[k])].astype(int)
        row, i = row[row < store.total], store.low + k
        if len(row):
            apart = max(apart, np.linalg.norm(moved[:, [i]] - moved[:, row], axis=0).max())
            closing = max(closing, np.linalg.norm(v[:, [i]] - v[:, row], axis=0).max())
    drifted = np.linalg.norm(moved[:, store.inner], axis=0).max()
    return np.array([apart, closing, drifted])


@pytest.mark.parametrize("dim", (1, 2, 3))
@pytest.mark.parametrize("everywhere", (False, True))
def test_bounds_hold_for_every_listed_pair(dim, everywhere):
    domain = domain_of(400, dim, tuple(range(dim)) if everywhere else ())
    store, rng = domain.store, np.random.default_rng(8)
    x = np.array(store["listed_position"])
    shift = 0.01 * np.sin(7.0 * x) + rng.uniform(0, 1e-4, x.shape)
    for row, s in zip(store.rows["position"], shift):
        store.data[row, : x.shape[1]] += s
    for row, s in zip(store.rows["predicted_velocity"], shift[::-1]):
        store.data[row, : x.shape[1]] = 5.0 * s
    domain.halo.refresh(domain.refreshed)  # ghosts of a periodic axis
    bounds, true = measured(domain), over_pairs(domain)
    assert (bounds >= true * (1 - 1e-12)).all()
    assert (bounds[:2] <= 8.0 * true[:2]).all()  # and are no blank cheque


def steps_until_over(domain, velocity, dt=1e-3, most=200, beside=False):
    """Steps that the lists last when particles move with ``velocity(x)``, or shift so beside it."""
    store, skin = domain.store, Skin(domain, WIDE)
    inner = store.inner
    v = velocity(np.array(store["position"])[:, inner])
    for row, component in zip(store.rows["predicted_velocity"], v):
        store.data[row, inner] = 0.0 if beside else component
    fastest = float(np.linalg.norm(v, axis=0).max())
    speed, shift = (0.0, fastest) if beside else (fastest, 0.0)
    for step in range(most):
        if not skin.holds(dt, speed, 0.0, shift):
            return step
        for row, component in zip(store.rows["position"], v):
            store.data[row, inner] += dt * component
        apart = over_pairs(domain)[0]
        assert apart < WIDE
    return most


def test_a_body_that_moves_as_one_keeps_its_lists():
    """For half a cutoff, √2 · 3 m/s · 1 ms a step; the older rule gave half the skin."""
    lasted = steps_until_over(domain_of(300, 2), lambda x: np.ones_like(x) * 3.0)
    assert lasted == int(0.5 * CUTOFF / (math.sqrt(2.0) * 3e-3))


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("away", (0.2, 0.4, 0.55, 0.9))
@pytest.mark.parametrize("slab", (0, 2))
def test_bodies_that_were_far_apart_are_seen_in_time(axis, away, slab):
    """Two particles alone, one flies towards the other: new lists before they feel each other."""
    x = np.full((2, 3), 0.05)
    x[1, axis] += away
    store = store_of(3, NAMES)
    block = np.zeros((len(store.data), 2))
    block[list(store.rows["position"])] = x.T
    store.append(np.arange(2), np.zeros(2, np.uint8), block)
    extent = Extent(slab, (0.0,) * 3, (1.0,) * 3, (None,) * 3)
    domain = Domain(MPI.COMM_SELF, store, extent, CUTOFF, Travels((), ("position", "predicted_velocity")))
    domain.rebuild()
    flying = int(np.argmax(np.array(store["position"])[axis, store.inner]))
    row = store.low + flying
    store.data[store.rows["predicted_velocity"][axis], row] = -1.0
    skin, support = Skin(domain, WIDE), CUTOFF - WIDE
    listed = over_pairs(domain)[1] > 0.0
    far = away
    while skin.holds(1e-3, 1.0, 0.0):
        store.data[store.rows["position"][axis], row] -= 1e-3
        far -= 1e-3
        assert listed or far > support
    assert far < away  # not at once


def test_a_body_that_shears_needs_new_ones_in_time():
    def shear(x):
        return np.stack([3.0 * x[1], 0.0 * x[1]])

    # Neighbours 0.17 m apart part at 0.51 m/s at the most: 39 steps of 1 ms for 0.02 m.
    assert 10 <= steps_until_over(domain_of(300, 2), shear) <= 39


def test_opposing_jets_end_them_as_early_as_the_largest_speed_would():
    def jets(x):
        return np.stack([np.where(x[1] > 0.5, 3.0, -3.0), 0.0 * x[1]])

    assert steps_until_over(domain_of(300, 2), jets) == 3  # 6 m/s, 0.02 m


def test_shifts_beside_the_velocity_count():
    def apart(x):
        return np.stack([np.where(x[1] > 0.5, 3.0, -3.0), 0.0 * x[1]])

    assert steps_until_over(domain_of(300, 2), apart, beside=True) == 3


def test_nobody_strays_too_far_in_a_periodic_domain():
    lasted = steps_until_over(domain_of(300, 2, (1,)), lambda x: np.ones_like(x) * 3.0)
    assert 0 < lasted < 0.25 / 3e-3 + 1


def images_apart(domain, plane):
    """Distances of all particles from the images of all others in ``plane``, and whether each is listed."""
    x = np.array(domain.store["position"])[:, domain.store.inner]
    image = x.copy()
    image[plane.axis] = 2.0 * plane.at - x[plane.axis]
    listed = np.zeros((x.shape[1],) * 2, bool)
    for k in range(x.shape[1]):
        begin, length = int(domain.lists.begin[k]), int(domain.lists.lengths[k])
        listed[k, domain.lists.lists[begin : begin + length].astype(int) - domain.store.low] = True
    away = np.linalg.norm(x[:, :, None] - image[:, None, :], axis=0)
    return away[~np.eye(len(away), dtype=bool)], listed[~np.eye(len(away), dtype=bool)]


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("plane", (Plane(0, BELOW, 0.0), Plane(1, ABOVE, 1.0)))
def test_images_are_listed_while_particles_are_before_the_mirror(plane, seed):
    """Beyond it they come nearer than what is listed: without the plane the lists hold too long."""
    support = CUTOFF - WIDE
    missed = {}
    for planes in ((plane,), ()):
        domain = domain_of(900, 2, seed=seed)
        store, skin = domain.store, Skin(domain, WIDE, planes)
        row, inner = store.rows["position"][plane.axis], store.inner
        store.data[store.rows["predicted_velocity"][plane.axis], inner] = plane.side
        missed[planes] = 0
        while skin.drifted < 0.07 and skin.holds(1e-3, 1.0, 0.0):
            store.data[row, inner] += 1e-3 * plane.side
            away, listed = images_apart(domain, plane)
            missed[planes] = max(missed[planes], np.count_nonzero(~listed & (away < support)))
            assert not planes or missed[planes] == 0
        if planes:
            assert skin.drifted > 0.3 * WIDE  # not at once
    assert missed[()] > 0


@pytest.mark.parametrize("dim", (1, 2, 3))
def test_images_in_corners_are_listed_too(dim):
    """Two on the diagonal of a corner, a cutoff apart, cross all its planes at once; the image in all of them
    comes nearer by 2 √dim times as far as they are beyond."""
    domain = domain_of(2, dim)
    store, planes = domain.store, [Plane(axis, BELOW, 0.0) for axis in range(dim)]
    rows, inner = list(store.rows["position"]), store.inner
    store.data[rows, inner] = np.array([0.0, 1.001 * CUTOFF / dim**0.5])
    store.data[list(store.rows["predicted_velocity"]), inner] = -1.0
    domain.rebuild()
    assert not domain.lists.lengths[:2].max() > 1  # nobody but themselves
    skin, support = Skin(domain, WIDE, planes), CUTOFF - WIDE
    while skin.holds(1e-4, dim**0.5, 0.0):
        store.data[rows, inner] -= 1e-4
        x = np.array(store["position"])[:, inner]
        assert np.linalg.norm(x[:, 0] + x[:, 1]) >= support
    assert np.linalg.norm(x[:, 0] + x[:, 1]) < support + 0.1 * WIDE  # they hold as long as they can


BOUNDS = Bounds(0.25 * WIDE, 2.0 * WIDE, CUTOFF - WIDE, 2, 1)
"""Between a quarter and twice the width at the start."""


@pytest.mark.parametrize(("speed", "width"), [(300.0, BOUNDS.most), (0.01, BOUNDS.least)])
def test_the_skin_follows_how_long_lists_serve(speed, width):
    """Neighbours that slide past each other fast widen it, and slow ones narrow it; without bounds it stays."""
    domain, fixed = domain_of(300, 2), domain_of(300, 2)
    for one, bounds in ((domain, BOUNDS), (fixed, None)):
        skin = Skin(one, WIDE, (), bounds)
        for row, of_own in zip(one.store.rows["predicted_velocity"], (1.0, -1.0)):
            one.store.data[row] = of_own * speed * (np.arange(one.store.capacity) % 2)
        for _ in range(40):
            steps = 0
            while steps < 2000 and skin.holds(1e-4, speed, 0.0):
                steps += 1
            skin.choose()
            one.rebuild()
            skin.renew()
        assert skin.width == pytest.approx(width if bounds else WIDE)
        assert one.reach - skin.width == pytest.approx(CUTOFF - WIDE)
        other = Skin(domain_of(300, 2), WIDE, (), bounds)
        other.reach_as(skin.state())
        assert other.domain.reach == one.reach  # to the bit: a restart lists the same
    counts = [int(one.lists.lengths[: one.store.owned].sum()) for one in (domain, fixed)]
    assert counts[0] != counts[1] and (counts[0] > counts[1]) == (width > WIDE)


@pytest.mark.parametrize(("dimensions", "wear", "dear"), [(2, 0.02, 1.0), (3, 0.05, 1.0), (2, 0.002, 10.0)])
def test_the_best_width_is_where_lists_and_pairs_cost_least(dimensions, wear, dear):
    """That of (1 + s)^d + dear·wear/s, as long as s is small."""
    bounds = Bounds(1e-6, 1.0, 1.0, dimensions, 1, dear)
    width = 0.05
    for _ in range(60):
        width = bounds.wide_enough(width, width / wear)
    s = np.linspace(0.01, 0.6, 5901)
    costs = (1.0 + s) ** dimensions + dear * wear / s
    assert np.interp(width, s, costs) < 1.01 * costs.min()
    assert np.interp(3.0 * width, s, costs) > 1.03 * costs.min()


def test_a_broken_number_ends_them():
    domain = domain_of(100, 2)
    skin = Skin(domain, WIDE)
    assert skin.holds(1e-3, 1.0, 1.0)
    assert not skin.holds(1e-3, np.nan, np.nan)


class TwoParticles(Skin):
    """A skin between two particles on a line, whose leapfrog is written out here."""

    def __init__(self, width):
        super().__init__(domain_of(20, 1), width)
        self._farthest = math.inf
        self.x = self.half = self.predicted = 0.0

    def _measure(self):
        self._apart, self._closing, self._since = abs(self.x), abs(self.predicted), 0.0


@pytest.mark.parametrize("seed", range(20))
def test_the_bound_holds_at_the_end_of_an_impact(seed):
    """The predicted velocity that is measured still has the acceleration of the step before in it."""
    rng = np.random.default_rng(seed)
    skin, v, a = TwoParticles(0.02), 0.0, 0.0
    for _ in range(400):
        dt = 1e-3 * rng.uniform(0.5, 1.0)
        # One of each pair is accelerated by a, the other against it: relative to each other 2 a.
        if not skin.holds(dt, 0.0, abs(a)):
            skin.x = 0.0
            skin.renew()
        half = v + 0.5 * dt * 2.0 * a
        skin.x += dt * half
        assert abs(skin.x) < skin.width or skin._closing is None
        skin.predicted = half + 0.5 * dt * 2.0 * a
        a = rng.choice([0.0, 0.0, 0.0, 1e4, -1e4]) if abs(v) < 10.0 else -math.copysign(1e4, v)
        v = half + 0.5 * dt * 2.0 * a
