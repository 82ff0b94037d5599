"""Messages, sums, slabs and shares past 2^31, with counts that only pretend to be there."""

from types import SimpleNamespace

import numpy as np
import pytest
from mpi4py import MPI
from stores import store_of

from psph.parallel.halo import _slice_type
from psph.parallel.migration import _each
from psph.parallel.reductions import exact_sums
from psph.parallel.slabs import Prices, partition, rebalanced
from psph.runs.setup import create_particles


@pytest.mark.parametrize("n", [2**31 - 1, 2**31, 2**33 + 5])
def test_a_halo_message_of_more_than_2_31_numbers(n):
    data = SimpleNamespace(strides=(2**45, 8), itemsize=8)
    message = _slice_type(data, [0, 3], 2**34, n)
    assert message.Get_size() == 2 * 8 * n
    low, extent = message.Get_true_extent()
    assert low == 8 * 2**34 and low + extent == 3 * 2**45 + 8 * 2**34 + 8 * n
    message.Free()


def test_a_parcel_of_more_than_2_31_numbers():
    """The rows of a parcel that does not exist: where they begin, and how many bytes go."""
    rows = np.broadcast_to(np.zeros(23), (2**31 + 7, 23))
    sent = []

    def transfer(message, rank):
        part, count, kind = message
        sent.append((rank, part.shape[0], count * kind.Get_size()))

    counts = np.array([0, 2**31 + 2, 0, 5])
    assert len(list(_each(transfer, rows, counts))) == 2
    assert sent == [(1, 2**31 + 2, 8 * 23 * (2**31 + 2)), (3, 5, 8 * 23 * 5)]


class Crowd:
    """As if so many ranks had the very same numbers as this one."""

    def __init__(self, size):
        self.size = size

    def Allreduce(self, _, values, operation):
        """Of equal numbers."""
        if operation == MPI.SUM:
            values *= self.size


def test_a_sum_over_more_than_2_31_particles_is_exact():
    terms = np.array([[1.0, 1e-3, -0.7], [2.0, 1e-3, 0.1]])
    sums = exact_sums(Crowd(2**33), terms)
    assert sums == pytest.approx(2**33 * terms.sum(axis=0), rel=1e-8)
    assert (exact_sums(Crowd(2**33), terms[::-1]) == sums).all()


def test_slabs_of_a_million_million_particles():
    histogram = np.full(40_000, 10**12 // 40_000)
    bounds = partition(histogram * 1024, 16_384)
    assert set(np.diff(bounds)) == {2, 3}
    prices = Prices(16_384)
    prices.learn(histogram, bounds, np.diff(bounds) * 10**9)
    assert set(prices.each) <= {1023, 1024}
    costs = prices.of_planes(histogram, bounds)
    assert costs.min() > 0 and rebalanced(costs, bounds, 16_384) is bounds


class Asked(Exception):
    """What a scene was asked for."""


def test_shares_of_more_than_2_31_particles_and_their_ids():
    """16,384 ranks, 2^33 particles in each plane of the lattice."""

    def particles(first, last, first_id):
        raise Asked(first, last, first_id)

    scene = SimpleNamespace(
        layout=SimpleNamespace(planes=32_768),
        census=SimpleNamespace(counts=np.full(32_768, 2**33)),
        particles=particles,
    )
    for rank in (0, 9000, 16_383):
        with pytest.raises(Asked) as asked:
            create_particles(scene, None, SimpleNamespace(rank=rank, size=16_384))
        first = 2 * rank
        assert asked.value.args == (first, first + 2, first * 2**33)


@pytest.mark.mpi(min_size=2)
@pytest.mark.parametrize("base", [2**31, 2**40, 2**62])
def test_ids_past_2_31_migrate_as_they_are(base):
    """The bits of an id travel among floating-point numbers."""
    from psph.parallel.migration import migrate

    comm = MPI.COMM_WORLD
    store = store_of(1, ("position",))
    ids = base + np.arange(6) + 10 * comm.rank
    store.append(ids, np.zeros(6, np.uint8), np.zeros((1, 6)))
    assert migrate(comm, store, np.full(6, (comm.rank + 1) % comm.size))
    before = (comm.rank - 1) % comm.size
    assert store.owned_rows("id").tolist() == (base + np.arange(6) + 10 * before).tolist()
