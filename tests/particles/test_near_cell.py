"""Candidates of cells where all particles reach as far: explicit vectors against plain Python and all pairs."""

import numba
import numpy as np
import pytest

from psph.particles.blocks import all_of, block_for, one_of, pack, place_of
from psph.particles.lanes import LANES
from psph.particles.near_cell import Near, append_row, far_bits, gather, near_bits, room_near

CUTOFF = 0.3


@numba.njit
def compared(numbers, block, near, i, n):
    """What eight candidates from number ``n`` on are to candidate ``i``, and to a box around it."""
    x_i = one_of(numbers, block, place_of(numbers, np.uint64(i)))
    x_j = all_of(numbers, block, place_of(numbers, np.uint64(n)))
    return near_bits(x_i, near, x_j), far_bits(x_j, x_i, x_i, near)


@numba.njit
def rows_of(near, first, last, ranges, lists, ends, found):
    groups, own = gather(near, np.uint64(first), np.uint64(last), ranges, found)
    end = np.uint64(0)
    for i in range(last - first):
        end = append_row(lists, end, own + np.uint64(i), near, found, groups)
        ends[i] = end
    return groups


def cloud(periods, many=64):
    rng = np.random.default_rng(2)
    position = tuple(rng.uniform(0, 1, many).astype(np.float32) for _ in periods)
    return Near(position, periods, np.float32(CUTOFF**2), np.float32(1e-6))


PERIODS = [(None,), (1.0,), (None, 1.0), (1.0, None, 1.0)]


@pytest.mark.parametrize("periods", PERIODS)
def test_vectors_against_plain_python(periods):
    near = cloud(periods)
    numbers = near.position
    block, seen = block_for(64, len(numbers)), set()
    pack(numbers, 64, block)
    for i in range(0, 50, 7):
        x_i = one_of(numbers, block, place_of(numbers, np.uint64(i)))
        assert x_i == tuple(x[i] for x in numbers)
        for n in range(0, 64, LANES):
            each = [one_of(numbers, block, place_of(numbers, np.uint64(n + t))) for t in range(LANES)]
            close = sum(near_bits(x_i, near, x_j) << t for t, x_j in enumerate(each))
            far = sum(far_bits(x_j, x_i, x_i, near) << t for t, x_j in enumerate(each))
            assert compared(numbers, block, near, i, n) == (close, far)
            seen |= {close, far}
    assert len(seen) > 6


@pytest.mark.parametrize("lost", [False, True])
@pytest.mark.parametrize("periods", PERIODS)
def test_rows_name_all_that_are_near_in_their_order(periods, lost):
    """Of columns 20 to 31, by ranges of which the second holds them and the first is wide; one of them may be
    at no number."""
    near = cloud(periods)
    if lost:
        near.position[0][25] = np.nan
    found, lists, ends = room_near(16, len(periods)), np.zeros(1000, np.uint32), np.zeros(12, np.int64)
    ranges = [(3, 17), (18, 64)]
    found.begins[:2], found.ends[:2] = zip(*ranges)
    groups = rows_of(near, 20, 32, 2, lists, ends, found)
    x = np.array(near.position, float)
    columns = np.concatenate([np.arange(*one) for one in ranges])
    for i, begin, end in zip(range(20, 32), [0, *ends], ends):
        apart = x[:, [i]] - x[:, columns]
        for d, period in enumerate(periods):
            apart[d] -= np.round(apart[d] / period) * period if period else 0.0
        expected = columns[((apart**2).sum(axis=0) < CUTOFF**2) & (columns != i)]
        assert lists[begin:end].tolist() == expected.tolist()
    assert ends[-1] > 0 and groups <= 9


def test_those_out_of_reach_of_all_are_no_candidates():
    near = Near((np.linspace(0.0, 10.0, 64, dtype=np.float32),), (None,), np.float32(1.0), np.float32(1e-6))
    found = room_near(16, 1)
    found.begins[0], found.ends[0] = 0, 64
    assert rows_of(near, 30, 32, 1, np.zeros(100, np.uint32), np.zeros(2, np.int64), found) == 2
    assert np.nanmin(found.position[0][:16]) >= near.position[0][30] - 1.001
