"""Slabs and order-independent sums."""

import numpy as np
import pytest
from mpi4py import MPI

from psph.parallel.reductions import exact_sums
from psph.parallel.slabs import TooManyRanks, fullest, partition, rebalanced


def test_equal_planes_are_shared_equally():
    assert partition(np.full(12, 7), 4).tolist() == [0, 3, 6, 9, 12]


def test_every_rank_gets_a_plane():
    histogram = np.array([1000, 0, 0, 0, 0, 1])
    bounds = partition(histogram, 5)
    assert (np.diff(bounds) >= 1).all() and bounds[0] == 0 and bounds[-1] == 6


def test_balance_follows_the_particles():
    histogram = np.random.default_rng(0).integers(0, 100, 200)
    for ranks in (2, 3, 7):
        load = fullest(histogram, partition(histogram, ranks))
        assert load <= histogram.sum() / ranks + histogram.max()


def test_too_many_ranks_names_the_largest_number():
    with pytest.raises(TooManyRanks, match="at most 3 ranks"):
        partition(np.ones(3), 4)


def test_slabs_move_only_when_it_pays():
    old = np.array([0, 5, 10])
    assert rebalanced(np.full(10, 100), old, 2) is old
    slightly = np.array([100] * 5 + [104] * 5)
    assert rebalanced(slightly, old, 2) is old
    assert rebalanced(np.array([300] * 5 + [100] * 5), old, 2).tolist() == [0, 3, 10]


def test_a_sum_does_not_depend_on_the_order():
    rng = np.random.default_rng(3)
    terms = rng.normal(size=(1000, 2)) * 10.0 ** rng.uniform(-12, 3, (1000, 2))
    sums = [exact_sums(MPI.COMM_SELF, terms[rng.permutation(1000)]) for _ in range(5)]
    assert all((s == sums[0]).all() for s in sums)
    assert sums[0] == pytest.approx(terms.sum(axis=0), rel=1e-12)
    assert len({terms[rng.permutation(1000), 0].cumsum()[-1] for _ in range(5)}) > 1  # the control


def test_opposite_momenta_cancel_exactly():
    v = np.random.default_rng(1).normal(size=(500, 1)) * 1e-7
    assert exact_sums(MPI.COMM_SELF, np.concatenate([v, -v]))[0] == 0.0


def test_a_sum_of_nothing_and_of_nonsense():
    assert exact_sums(MPI.COMM_SELF, np.zeros((0, 2))).tolist() == [0.0, 0.0]
    assert np.isnan(exact_sums(MPI.COMM_SELF, np.array([[np.nan, 1.0]]))).tolist() == [True, False]


@pytest.mark.mpi(min_size=2)
def test_a_sum_does_not_depend_on_the_ranks():
    comm = MPI.COMM_WORLD
    terms = np.random.default_rng(7).normal(size=(999, 3)) ** 5
    alone = exact_sums(MPI.COMM_SELF, terms)
    together = exact_sums(comm, terms[comm.rank :: comm.size])
    assert (alone == together).all()
