"""The domain on 2 ranks and more: ghosts, order, migration, p⁻ across the boundary."""

import numpy as np
import pytest
from mpi4py import MPI
from particles.test_neighbours import brute_force, domain_of, neighbours_by_id

COMM = MPI.COMM_WORLD
pytestmark = pytest.mark.mpi(min_size=2)


def scattered(dim, periodic, n=400, axis=0, seed=8):
    positions = np.random.default_rng(seed).uniform(0, 1, (n, dim))
    periods = tuple(1.0 if periodic else None for _ in range(dim))
    mine = np.arange(n)[COMM.rank :: COMM.size]
    domain = domain_of(positions, 0.12, (0,) * dim, (1,) * dim, periods, axis, COMM, mine)
    return positions, periods, domain


def everywhere(local: dict) -> dict:
    return {key: value for part in COMM.allgather(local) for key, value in part.items()}


@pytest.mark.parametrize("dim", (1, 2, 3))
@pytest.mark.parametrize("periodic", (False, True))
def test_lists_and_their_order_are_those_of_one_rank(dim, periodic):
    positions, periods, domain = scattered(dim, periodic, axis=dim - 1)
    together = everywhere(neighbours_by_id(domain))
    alone = domain_of(positions, 0.12, (0,) * dim, (1,) * dim, periods, dim - 1)
    assert together == neighbours_by_id(alone)
    assert {i: set(r) for i, r in together.items()} == brute_force(positions, 0.12, periods)


def test_ranks_hold_the_global_order_one_after_another():
    positions, _, domain = scattered(2, False)
    ids = np.concatenate(COMM.allgather(domain.store.id[domain.store.inner]))
    alone = domain_of(positions, 0.12, (0, 0), (1, 1), (None, None))
    assert (ids == alone.store.id[alone.store.inner]).all()


def test_a_refresh_brings_exactly_the_owners_values():
    _, _, domain = scattered(2, True)
    store = domain.store
    density = store["density"]
    density[store.inner] = 1000.0 * COMM.rank + store.id[store.inner]
    density[: store.low] = density[store.low + store.owned : store.total] = -1.0
    domain.halo.refresh(("density",))
    owner = everywhere({int(i): COMM.rank for i in store.id[store.inner]})
    ghosts = np.r_[0 : store.low, store.low + store.owned : store.total]
    assert len(ghosts) > 0
    for value in density[ghosts]:
        rank, particle = divmod(int(value), 1000)
        assert owner[particle] == rank != (COMM.rank if COMM.size > 2 else -1)


def test_bytes_of_a_refresh_are_counted():
    _, _, domain = scattered(2, False)
    store = domain.store
    received = 8 * 2 * (store.low + store.high)
    sent = domain.halo.bytes(("position",))
    assert COMM.allreduce(sent) == COMM.allreduce(received) > 0
    assert domain.halo.bytes(("position", "density")) == sent * 3 // 2


def test_a_fast_particle_crosses_several_slabs_at_once():
    positions, periods, domain = scattered(2, False)
    store = domain.store
    here = np.flatnonzero(store.id[store.inner] == 17)
    target = np.array([0.999, 0.5]) if positions[17, 0] < 0.5 else np.array([0.001, 0.5])
    for d, x in enumerate(store["position"]):
        x[store.low + here] = target[d]
    domain.rebuild()
    holders = [r for r, n in enumerate(COMM.allgather(int((store.id[store.inner] == 17).sum()))) if n]
    assert holders == [COMM.size - 1 if target[0] > 0.5 else 0]
    positions[17] = target
    assert {i: set(r) for i, r in everywhere(neighbours_by_id(domain)).items()} == brute_force(
        positions, 0.12, periods
    )
    assert COMM.allreduce(store.owned) == 400


def test_a_particle_that_leaves_a_periodic_domain_comes_back_on_the_other_side():
    _, _, domain = scattered(2, True)
    store = domain.store
    store["position"][0][store.inner] += 0.95
    store["position"][1][store.inner] -= 2.3
    domain.rebuild()
    for x in store["position"]:
        assert (x[store.inner] >= 0).all() and (x[store.inner] < 1).all()
    assert COMM.allreduce(store.owned) == 400


def test_slabs_follow_the_particles():
    _, _, domain = scattered(2, False, n=2000)
    store = domain.store
    before = domain.bounds.copy()
    store["position"][0][store.inner] **= 3  # crowd at the low end
    domain.rebuild()
    counts = COMM.allgather(store.owned)
    assert (domain.bounds != before).any() and sum(counts) == 2000
    assert max(counts) < 1.5 * 2000 / COMM.size
