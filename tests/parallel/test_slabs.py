"""Slabs and order-independent sums."""

import math
from fractions import Fraction

import numpy as np
import pytest
from mpi4py import MPI

from psph.parallel.reductions import exact_sums
from psph.parallel.slabs import PAR, TOLERATED, Prices, TooManyRanks, dearest, partition, rebalanced


def test_equal_planes_are_shared_equally():
    assert partition(np.full(12, 7), 4).tolist() == [0, 3, 6, 9, 12]


def test_every_rank_gets_a_plane():
    histogram = np.array([1000, 0, 0, 0, 0, 1])
    bounds = partition(histogram, 5)
    assert (np.diff(bounds) >= 1).all() and bounds[0] == 0 and bounds[-1] == 6


def test_a_cut_lies_where_it_comes_nearest_to_equal_shares():
    """The rule, written rank by rank."""
    rng = np.random.default_rng(6)
    for planes, ranks in ((9, 9), (30, 7), (50, 3), (40, 1)):
        histogram = rng.integers(0, 50, planes) * rng.integers(0, 2, planes)
        reached, bounds = np.concatenate([[0], np.cumsum(histogram)]), [0]
        for r in range(1, ranks):
            distance = np.abs(reached - reached[-1] * (r / ranks))
            cut = int(distance[1:].argmin()) + 1
            bounds.append(min(max(cut, bounds[-1] + 1), planes - ranks + r))
        found = partition(histogram, ranks)
        assert distances(reached, found) == distances(reached, bounds + [planes])
        assert found[0] == 0 and found[-1] == planes and (np.diff(found) >= 1).all()


def distances(reached, bounds):
    """How far each cut is from an equal share (ties may fall either way)."""
    goals = reached[-1] * (np.arange(len(bounds)) / (len(bounds) - 1))
    return np.abs(reached[bounds] - goals).round(9).tolist()


def test_balance_follows_the_particles():
    histogram = np.random.default_rng(0).integers(0, 100, 200)
    for ranks in (2, 3, 7):
        load = dearest(histogram, partition(histogram, ranks))
        assert load <= histogram.sum() / ranks + histogram.max()


def test_too_many_ranks_names_the_largest_number():
    with pytest.raises(TooManyRanks, match="at most 3 ranks"):
        partition(np.ones(3), 4)


def test_a_run_whose_planes_grow_too_few_says_how_to_go_on():
    with pytest.raises(TooManyRanks, match="from 5 planes of cells to 1, fewer than its 2 ranks.* resume it"):
        rebalanced(np.ones(1, np.int64), np.array([0, 2, 5]), 2)
    with pytest.raises(TooManyRanks, match="2 ranks for 1 plane of cells: use at most 1 rank$"):
        rebalanced(np.ones(1, np.int64), None, 2)


def test_slabs_move_only_when_it_pays():
    old = np.array([0, 5, 10])
    assert rebalanced(np.full(10, 100), old, 2) is old
    slightly = np.array([100] * 5 + [104] * 5)
    assert rebalanced(slightly, old, 2) is old
    assert rebalanced(np.array([300] * 5 + [100] * 5), old, 2).tolist() == [0, 3, 10]


def followed(histogram, speeds, rebuilds, noise=0.0, seed=0):
    """Slabs after each of so many rebuilds where rank r computes ``speeds[r]`` particles a ns."""
    rng, speeds = np.random.default_rng(seed), np.array(speeds)
    prices, bounds, history = Prices(len(speeds)), None, []
    for _ in range(rebuilds):
        costs = histogram
        if bounds is not None:
            held = np.add.reduceat(histogram, bounds[:-1])
            spent = 1e4 * held / speeds * rng.normal(1.0, noise, len(speeds))
            prices.learn(histogram, bounds, spent.astype(np.int64))
            costs = prices.of_planes(histogram, bounds)
        bounds = rebalanced(costs, bounds, len(speeds))
        history.append(bounds.tolist())
    return history


@pytest.mark.parametrize("speeds", [(0.5, 1.0), (1.0, 0.5, 1.0, 1.0), (1.0, 1.3, 0.9, 1.1, 0.6)])
def test_a_slow_rank_gets_fewer_planes(speeds):
    """A rebuild at a time the slabs come to take equal times, and then they stay."""
    histogram = np.full(600, 1000)
    history = followed(histogram, speeds, 60)

    def slowest(bounds):
        return max(np.diff(bounds) / np.array(speeds)) * sum(speeds) / 600

    assert slowest(history[0]) > 1.25  # by counts: this is what is to be gained
    assert slowest(history[-1]) < 1.02 * TOLERATED
    assert history[-1] == history[-20]
    changes = sum(a != b for a, b in zip(history, history[1:]))
    assert 1 <= changes <= 20


def test_noise_moves_nothing():
    """Three per cent from interval to interval on every rank: no slab moves, even or not."""
    for seed in range(5):
        history = followed(np.full(64, 1000), [1.0] * 8, 200, 0.03, seed)
        assert history[0] == history[-1] and len(set(map(tuple, history))) == 1
        settled = followed(np.full(600, 1000), (0.5, 1.0, 1.0), 200, 0.03, seed)[60:]
        assert sum(a != b for a, b in zip(settled, settled[1:])) <= 1
    wild = followed(np.full(64, 1000), [1.0] * 8, 200, 0.5)  # the control
    assert len(set(map(tuple, wild))) > 1


def test_an_accident_empties_no_slab():
    prices, bounds = Prices(2), np.array([0, 5, 10])
    prices.learn(np.full(10, 100), bounds, np.array([10**12, 10**6]))
    assert PAR < prices.each[0] < 2 * PAR and PAR // 2 < prices.each[1] < PAR
    unknown = Prices(2)
    unknown.learn(np.full(10, 100), bounds, np.array([900, 100]))  # a microsecond says nothing
    unknown.learn(np.array([0] * 5 + [100] * 5), bounds, np.array([10**9, 10**9]))  # nor no particle
    assert unknown.each[0] == PAR
    with np.errstate(all="raise"):
        unknown.learn(np.zeros(10, int), bounds, np.array([10**9, 10**9]))  # nor an empty scene
    assert unknown.each[0] == PAR


def test_prices_follow_a_grid_that_grows():
    prices, bounds = Prices(2), np.array([0, 5, 10])
    prices.learn(np.full(10, 1000), bounds, np.array([3 * 10**9, 10**9]))
    slow, fast = prices.of_planes(np.ones(12, np.int64), bounds)[[5, 6]]
    assert slow > PAR > fast


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


@pytest.mark.parametrize(("count", "scale"), [(700, 1e-300), (3, 1e290), (40, 1.0)])
def test_a_sum_is_that_of_whole_multiples_of_a_unit(count, scale):
    """The control: the definition, in whole numbers of Python."""
    terms = np.random.default_rng(5).normal(size=(count, 2)) * scale
    for column, total in zip(terms.T, exact_sums(MPI.COMM_SELF, terms)):
        unit = Fraction(2) ** (math.frexp(np.abs(column).max())[1] - (62 - count.bit_length()))
        assert total == float(sum(round(Fraction(x) / unit) for x in column) * unit)


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
