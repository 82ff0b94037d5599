"""Neighbour lists against brute force, on one rank, in every dimension."""

import math

import numpy as np
import pytest
from mpi4py import MPI
from stores import store_of

from psph.composition.space import Metres
from psph.parallel.domain import CELLS_A_PARTICLE, Domain, Extent, Travels

NAMES = ("position", "listed_position", "density")


def domain_of(
    positions, cutoff, lower, upper, periods, axis=0, comm=MPI.COMM_SELF, mine=None, less=0, sought=None
):
    """A rebuilt domain of particles at ``positions`` (n, dim); their density is their id less ``less``."""
    n, dim = positions.shape
    mine = np.arange(n) if mine is None else mine
    store = store_of(dim, NAMES, {"mass": 1.0})
    block = np.zeros((len(store.data), len(mine)))
    block[list(store.rows["position"])] = positions[mine].T
    block[store.rows["density"].start] = mine - less
    store.append(mine, np.zeros(len(mine), np.uint8), block)
    extent = Extent(axis, lower, upper, periods)
    domain = Domain(comm, store, extent, cutoff, Travels(("density",), ("position",), sought))
    domain.rebuild()
    return domain


def neighbours_by_id(domain):
    """{id: ids of its neighbours, in the order of the list}."""
    store, lists = domain.store, domain.lists
    found = {}
    for k in range(store.owned):
        begin = int(lists.begin[k])
        row = lists.lists[begin : begin + int(lists.lengths[k])].astype(int)
        found[int(store.id[store.low + k])] = store["density"][row].astype(int).tolist()
    return found


def brute_force(positions, cutoff, periods):
    """{id: set of ids within the cutoff}."""
    found = {}
    for i, x in enumerate(positions):
        d = x - positions
        for axis, period in enumerate(periods):
            if period is not None:
                d[:, axis] -= period * np.rint(d[:, axis] / period)
        near = np.flatnonzero((d**2).sum(axis=1) < cutoff**2)
        found[i] = set(near.tolist()) - {i}
    return found


CASES = [
    (dim, periodic, axis)
    for dim in (1, 2, 3)
    for axis in range(dim)
    for periodic in [()] + [(d,) for d in range(dim)] + ([tuple(range(dim))] if dim > 1 else [])
]


@pytest.mark.parametrize("dim, periodic, axis", CASES)
def test_lists_are_complete(dim, periodic, axis):
    rng = np.random.default_rng(5)
    size = np.array([1.0, 0.8, 0.9])[:dim]
    positions = rng.uniform(0, 1, (300, dim)) * size
    periods = tuple(size[d] if d in periodic else None for d in range(dim))
    domain = domain_of(positions, 0.17, np.zeros(dim), size, periods, axis)
    expected = brute_force(positions, 0.17, periods)
    found = neighbours_by_id(domain)
    assert {i: set(row) for i, row in found.items()} == expected
    assert all(len(row) == len(set(row)) for row in found.values())


@pytest.mark.parametrize("dim, periodic, axis", CASES)
def test_rows_stay_empty_where_nobody_is_sought(dim, periodic, axis):
    """Of 300 the last 8 are: every row is whole that has one of them, or whose particle is one."""
    rng = np.random.default_rng(6)
    size = np.array([1.0, 0.8, 0.9])[:dim]
    positions = rng.uniform(0, 1, (300, dim)) * size
    positions[-8:] = 0.1 * size * rng.uniform(0, 1, (8, dim))
    periods = tuple(size[d] if d in periodic else None for d in range(dim))
    scene = (positions, 0.12, np.zeros(dim), size, periods, axis)
    whole, found = (
        neighbours_by_id(domain_of(*scene, less=291, sought=sought)) for sought in (None, "density")
    )
    empty = [k for k, row in found.items() if not row and whole[k]]
    assert len(empty) > 50
    assert all(row == whole[k] for k, row in found.items() if k not in empty)
    assert all(k <= 291 and max(whole[k]) <= 0 for k in empty)


@pytest.mark.parametrize("dim", (1, 2, 3))
def test_the_shortest_period(dim):
    """Three cutoffs and hardly more: every cell is a third of the domain."""
    positions = np.random.default_rng(9).uniform(0, 1, (200, dim))
    domain = domain_of(positions, 0.3333, (0,) * dim, (1,) * dim, (1.0,) * dim)
    found = {i: set(row) for i, row in neighbours_by_id(domain).items()}
    assert found == brute_force(positions, 0.3333, (1.0,) * dim)


def test_particles_outside_the_domain_keep_their_neighbours():
    positions = np.random.default_rng(2).uniform(-9, 9, (400, 2))
    domain = domain_of(positions, 0.9, (0.0, 0.0), (1.0, 1.0), (None, None))
    found = neighbours_by_id(domain)
    assert {i: set(row) for i, row in found.items()} == brute_force(positions, 0.9, (None, None))


def test_rows_are_filled_up_to_whole_registers_with_the_particle_itself():
    domain = domain_of(np.random.default_rng(1).uniform(0, 1, (50, 2)), 0.3, (0, 0), (1, 1), (None,) * 2)
    store, lists = domain.store, domain.lists
    assert lists.lists.dtype == np.uint32 and lists.begin.dtype == np.uint64
    lengths = lists.lengths[: store.owned].astype(int)
    rows = -(-lengths // Metres.lanes) * Metres.lanes
    assert list(np.cumsum([0, *rows[:-1]])) == lists.begin[: store.owned].tolist()
    assert (lengths % Metres.lanes).any()  # some have something to fill up
    for k, (begin, entries, whole) in enumerate(zip(lists.begin.astype(int), lengths, rows)):
        assert (lists.lists[begin + entries : begin + whole] == store.low + k).all()


def test_order_is_by_cell_then_id():
    rng = np.random.default_rng(4)
    positions = rng.uniform(0, 1, (500, 2))
    one = domain_of(positions, 0.1, (0, 0), (1, 1), (None, None))
    two = domain_of(positions, 0.1, (0, 0), (1, 1), (None, None), mine=rng.permutation(500))
    assert (one.store.id[one.store.inner] == two.store.id[two.store.inner]).all()
    assert neighbours_by_id(one) == neighbours_by_id(two)


def test_a_crowd_in_one_cell():
    positions = np.full((600, 3), 0.5) + np.random.default_rng(0).uniform(0, 1e-3, (600, 3))
    domain = domain_of(positions, 0.3, (0, 0, 0), (1, 1, 1), (None,) * 3)
    assert all(len(row) == 599 for row in neighbours_by_id(domain).values())


@pytest.mark.parametrize("dim", (2, 3))
def test_the_grid_follows_jets_within_bounds_and_comes_back(dim):
    """Jets leave a tank through its open sides: cells stay few per particle, and lists complete."""
    rng = np.random.default_rng(dim)
    cutoff = {2: 0.12, 3: 0.25}[dim]
    tank = rng.uniform(0, 1, (600, dim))
    domain = domain_of(tank, cutoff, (0.0,) * dim, (1.0,) * dim, (None,) * dim)
    home, corners = domain.grid, (domain.lower, domain.upper)
    limit = max(math.prod(home.counts), CELLS_A_PARTICLE * len(tank))
    flown = tank.copy()
    flown[:40, -1] += np.linspace(0.1, 3.5, 40)  # up
    flown[40:60, 0] -= np.linspace(0.1, 5.0, 20)  # over the edge
    flown[60, 0] = 40.0  # one far away
    for places in (flown, tank):
        by_id = places[domain.store.id[domain.store.inner]]
        for x, component in zip(domain.store["position"], by_id.T):
            x[domain.store.inner] = component
        domain.rebuild()
        fresh = domain_of(places, cutoff, *corners, (None,) * dim)
        assert domain.grid == fresh.grid  # whatever was before
        assert math.prod(domain.grid.counts) <= limit
        found = {i: set(row) for i, row in neighbours_by_id(domain).items()}
        assert found == brute_force(places, cutoff, (None,) * dim)
        if places is flown:
            assert domain.upper[-1] > 1.2 and domain.grid != home  # it did follow
    assert domain.grid == home


def test_the_grid_knows_nothing_of_how_many_there_were():
    """Particles that were born count as those of the start: a run that is resumed has the same grid."""
    places = np.random.default_rng(3).uniform(0, 1, (600, 2))
    places[:40, 1] += np.linspace(0.1, 3.5, 40)
    extent = (0.12, (0.0, 0.0), (1.0, 1.0), (None, None))
    domain = domain_of(places[:200], *extent)
    born = np.zeros((len(domain.store.data), 400))
    born[list(domain.store.rows["position"])] = places[200:].T
    domain.store.append(np.arange(200, 600), np.zeros(400, np.uint8), born)
    few = domain.grid
    domain.rebuild()
    assert domain.grid == domain_of(places, *extent).grid
    assert domain.grid != few
