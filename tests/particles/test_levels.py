"""Neighbours among particles of many sizes, against all pairs."""

import numpy as np
import pytest

from psph.particles import levels
from psph.particles.cell_order import in_cells
from psph.particles.level_grids import Slab
from psph.particles.level_ranges import BITS, FARTHEST
from psph.particles.levels import list_by_levels
from psph.particles.neighbours import empty
from psph.particles.sizes import GROWTH, Sizes, TooLarge

SIZES = Sizes(2.0, 0.02, "smoothing_length", "listed_length")


def cloud(dimensions, ratio, count=400, seed=5):
    """Places, m (dim, n), and smoothing lengths, m, of which one in ten is up to ``ratio`` times the others."""
    rng = np.random.default_rng(seed)
    position = rng.uniform(0.0, 1.0, (dimensions, count))
    length = 0.12 / ratio * np.where(rng.uniform(size=count) < 0.1, rng.uniform(1.0, ratio, count), 1.0)
    return position, length


def all_pairs(position, length, periods):
    """Who is within the larger reach of both and the skin, by rows."""
    apart = position[:, :, None] - position[:, None]
    for x, period in zip(apart, periods):
        if period:
            x -= period * np.rint(x / period)
    within = np.maximum(length[:, None], length) * (GROWTH + SIZES.skin) * SIZES.support
    near = (apart**2).sum(axis=0) <= within**2
    np.fill_diagonal(near, False)
    return [np.flatnonzero(row) for row in near]


@pytest.mark.parametrize("ratio", [1.0, 2.0, 10.0, 100.0])
@pytest.mark.parametrize("dimensions", [1, 2, 3])
@pytest.mark.parametrize("periodic", [False, True])
def test_lists_have_all_neighbours_and_no_others(dimensions, ratio, periodic):
    """Axes across the slab repeat or not; the slab itself has no ghosts."""
    position, length = cloud(dimensions, ratio)
    n = position.shape[1]
    periods = (None, *[1.0 if periodic else None] * (dimensions - 1))
    cutoff = SIZES.reach(length.max())
    slab = Slab(0, 0.0, 1.0, 0, n, 0, periods, (0.0,) * dimensions, cutoff)
    lists, _ = list_by_levels(
        empty(0, 0), tuple(position), length, np.ones(len(length), np.bool_), SIZES, slab, 4
    )
    expected = all_pairs(position, length, periods)
    for k, row in enumerate(expected):
        begin, many = int(lists.begin[k]), int(lists.lengths[k])
        assert np.array_equal(np.sort(lists.lists[begin : begin + many]), row)
        assert (lists.lists[begin + many : begin + -(-many // 4) * 4] == k).all()
    assert sum(map(len, expected)) > n // 2


def test_too_little_room_is_made_larger(monkeypatch):
    """Few groups of candidates, and few entries, at first: the same rows in the end."""
    position, length = cloud(3, 4.0)
    n = position.shape[1]
    slab = Slab(0, 0.0, 1.0, 0, n, 0, (None, 1.0, 1.0), (0.0,) * 3, SIZES.reach(length.max()))

    def rows():
        looks = np.ones(n, np.bool_)
        lists, _ = list_by_levels(empty(0, 0), tuple(position), length, looks, SIZES, slab, 4)
        return [lists.lists[b : b + m].tolist() for b, m in zip(lists.begin[:n], lists.lengths[:n])]

    expected = rows()
    monkeypatch.setattr(levels, "GROUPS", 1)
    monkeypatch.setattr(levels, "SOME", 1)
    assert rows() == expected


@pytest.mark.parametrize("apart", [1, 2**40])
def test_particles_come_by_level_then_cell_then_column(apart):
    """Two levels of sixty in nine cells each, side by side, which are counted, or in the second far apart,
    whose keys are sorted by what does not keep the order of equals."""
    rng = np.random.default_rng(3)
    of = rng.permutation(np.repeat([0, 1], 60))
    key = sum(rng.integers(0, 3, 120) << shift for shift in (0, BITS)) * np.where(of > 0, apart, 1)
    found = in_cells(key, of, 2)
    assert found.columns.tolist() == np.lexsort((key, of)).tolist()
    assert found.base.tolist() == [0, 9, 18]
    in_each = [(of[k], key[k]) for k in found.columns[found.starts[:-1]]]
    assert in_each == sorted({(n, k) for n, k in zip(of, key)})
    assert found.keys.tolist() == [k for _, k in in_each]
    assert found.first.tolist() == [0, 9 if apart == 1 else -1]
    assert found.begun[:10].tolist() == found.starts[:10].tolist()
    assert found.box[0, :, 1:].tolist() == [[-FARTHEST] * 2, [2 - FARTHEST] * 2]


def test_a_cell_ends_with_its_level():
    """The first cell of the finer level has a number by one lower than the last of the coarser."""
    length = np.array([1.0, 0.5]) / SIZES.reach(1.0)
    slab = Slab(0, 0.0, 2.0, 0, 2, 0, (None,), (0.0,), 1.0)
    lists, _ = list_by_levels(
        empty(0, 0), (np.array([1.1, 0.3]),), length, np.ones(2, np.bool_), SIZES, slab, 1
    )
    assert [lists.lists[int(begin)] for begin in lists.begin[:2]] == [1, 0]
    assert lists.lengths[:2].tolist() == [1, 1]


@pytest.mark.parametrize("dimensions", [1, 2, 3])
def test_ghosts_across_a_seam_are_seen_once(dimensions):
    """One rank whose far planes are its ghosts on the other side: as with the nearest image of all."""
    position, length = cloud(dimensions, 4.0)
    periods = (1.0,) * dimensions
    cutoff = SIZES.cutoff(length.max(), periods)
    below, above = (np.flatnonzero(side) for side in (position[0] > 1.0 - cutoff, position[0] < cutoff))
    n = position.shape[1]
    owner = np.concatenate([below, np.arange(n), above])
    slab = Slab(0, 0.0, 1.0, len(below), n, len(above), periods, (0.0,) * dimensions, cutoff)
    lists, _ = list_by_levels(
        empty(0, 0), tuple(position[:, owner]), length[owner], np.ones(len(owner), np.bool_), SIZES, slab, 1
    )
    for k, row in enumerate(all_pairs(position, length, periods)):
        begin, many = int(lists.begin[k]), int(lists.lengths[k])
        assert np.array_equal(np.sort(owner[lists.lists[begin : begin + many]]), row)


def test_a_reach_beyond_a_third_of_a_period_is_told():
    with pytest.raises(
        TooLarge, match=r"space.periodic: y is 1 m long, .* give a longer domain \(space.upper\), a smaller"
    ):
        SIZES.cutoff(0.2, (None, 1.0))


@pytest.mark.parametrize("across", [False, True])
def test_whether_a_row_stays_empty_rests_on_its_own_level_alone(across):
    """Two of a finer level with nobody who is sought around but one coarser; whether a third in their cell looks
    across is known only where it is owned, so that ranks would fill other rows."""
    length = np.array([0.5, 0.5, 0.5, 1.0]) / SIZES.reach(1.0)
    slab = Slab(0, 0.0, 2.0, 0, 2, 2, (None,), (0.0,), 1.0)
    looks = np.array([False, False, across, False])
    sought = np.array([0.0, 0.0, 0.0, 1.0])
    places = (np.array([0.3, 0.32, 0.35, 0.9]),)
    lists, _ = list_by_levels(empty(0, 0), places, length, looks, SIZES, slab, 1, sought)
    assert lists.lengths[:2].tolist() == [0, 0]


WITHIN = SIZES._replace(growth=1.0, across=np.ones(1, np.bool_))
"""Sizes of which each lists its own level, and of others those that reach it."""


@pytest.mark.parametrize("seeking", [False, True])
@pytest.mark.parametrize("periodic", [False, True])
def test_others_are_those_that_reach_a_particle(periodic, seeking):
    """Of its own level all that either reaches, of others those that reach it; who does not look across none,
    nor who names nobody of its own level who is sought, where some are, and is none of them."""
    rng, n = np.random.default_rng(9), 300
    position, level = rng.random((2, n)), rng.integers(0, 3, n)
    length, looks = 0.05 * 0.5**level, rng.random(n) < 0.7
    periods = (None, 1.0 if periodic else None)
    slab = Slab(0, 0.0, 1.0, 0, n, 0, periods, (0.0, 0.0), WITHIN.reach(0.05))
    sought = (rng.random(n) < 0.05).astype(float) if seeking else None
    lists, others = list_by_levels(empty(0, 0), tuple(position), length, looks, WITHIN, slab, 4, sought)
    apart = position[:, :, None] - position[:, None, :]
    if periodic:
        apart[1] -= np.rint(apart[1])
    reached = (apart**2).sum(axis=0) <= WITHIN.reach(length) ** 2
    np.fill_diagonal(reached, False)
    alike = level[:, None] == level
    if seeking:
        named = (sought > 0.0) | (reached & alike & (sought > 0.0)).any(axis=1)
        assert 20 < named.sum() < n - 20
        reached &= named[:, None]
    for k in range(n):
        for found, expected in ((lists, reached & alike), (others, reached & ~alike & looks[:, None])):
            begin, many = int(found.begin[k]), int(found.lengths[k])
            assert np.array_equal(np.sort(found.lists[begin : begin + many]), np.flatnonzero(expected[k]))
        begin, many = int(lists.begin[k]), int(lists.lengths[k])
        assert (lists.lists[begin + many : begin + -(-many // 4) * 4] == k).all()
    assert others.lengths[:n].sum() > 40


def test_a_row_stays_empty_that_names_nobody_who_is_sought():
    """Three in one cell, the last of them sought by the others: only who is near it has a row, and it itself."""
    length, places = np.full(4, 0.5 / SIZES.reach(1.0)), (np.array([0.05, 0.3, 0.9, 1.3]),)
    slab = Slab(0, 0.0, 2.0, 0, 4, 0, (None,), (0.0,), 0.5)
    sought = np.array([0.0, 0.0, 1.0, 0.0])
    lists, _ = list_by_levels(empty(0, 0), places, length, np.ones(4, np.bool_), SIZES, slab, 1, sought)
    assert lists.lengths[:4].tolist() == [0, 0, 1, 1]
    lists, _ = list_by_levels(empty(0, 0), places, length, np.ones(4, np.bool_), SIZES, slab, 1)
    assert lists.lengths[:4].tolist() == [1, 1, 1, 1]


@pytest.mark.parametrize("away", [0.0, 2.0**17])
@pytest.mark.parametrize(("part", "named"), [(1.0 - 1e-5, 1), (1.0 + 1e-8, 0)])
def test_lists_reach_no_farther_than_they_say_and_hardly_less(part, named, away):
    """Pairs of one size in many directions, each with another a fifth of a reach nearer to the other, near the
    corner of the domain and far from it: in single precision."""
    rng, many = np.random.default_rng(4), 40
    way = rng.normal(size=(3, many))
    way /= np.linalg.norm(way, axis=0)
    first = np.stack([np.arange(many) * 5.0 + 2.0, *rng.uniform(1.0, 2.0, (2, many))])
    places = [first + along * way for along in (0.0, 0.2, part - 0.2, part)]
    position = np.stack(places, axis=2).reshape(3, -1) + away
    n, length = 4 * many, np.full(4 * many, 1.0) / SIZES.reach(1.0)
    slab = Slab(0, away, away + 5.0 * many, 0, n, 0, (None,) * 3, (away,) * 3, 1.0)
    lists, _ = list_by_levels(empty(0, 0), tuple(position), length, np.ones(n, np.bool_), SIZES, slab, 1)
    assert lists.lengths[:n].tolist() == [2 + named, 3, 3, 2 + named] * many
