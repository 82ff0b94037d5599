"""Threads of a rank: every column once, the same bits, and one line where there are too few cores."""

import os

import numpy as np
import pytest
from simulation.test_precision import box, run

from psph.engine.threads import TooManyThreads, in_threads, threads, use_threads

CORES = len(os.sched_getaffinity(0))


@pytest.fixture
def two():
    if CORES < 2:
        pytest.skip("one core")
    use_threads(2)
    yield
    use_threads(1)


def test_every_column_once(two):
    seen = np.zeros(101, int)

    def loop(first, last, by):
        seen[first:last] += by
        return last - first

    assert sum(in_threads(loop, 1, 100, 2)) == 99
    assert seen[0] == seen[100] == 0 and (seen[1:100] == 2).all()
    assert in_threads(loop, 5, 5, 1) == [0]


def test_a_failure_in_a_thread_is_not_lost(two):
    def loop(first, last):
        if first > 0:
            raise ValueError("here")

    with pytest.raises(ValueError, match="here"):
        in_threads(loop, 0, 10)


@pytest.mark.parametrize("precision", ("double", "mixed"))
def test_same_bits_as_in_one_thread(two, precision):
    case = box(2, precision, True, free_surface=0.9, pressure_gradient="minimum")
    together = run(case, 8)
    use_threads(1)
    for one, other in zip(together, run(case, 8)):
        assert np.array_equal(one, other)


def test_more_threads_than_cores_are_refused():
    with pytest.raises(TooManyThreads, match=f"--threads {CORES + 1}: this rank may use {CORES}"):
        use_threads(CORES + 1)
    with pytest.raises(TooManyThreads, match="--threads 0"):
        use_threads(0)
    assert threads() == 1


def test_lists_are_the_same_in_two_threads(two):
    """Rows stand elsewhere, and hold the same."""
    from particles.test_neighbours import domain_of, neighbours_by_id

    positions = np.random.default_rng(1).uniform(0, 1, (2000, 3))
    positions[:, 0] **= 3  # crowded at one end: the parts need different room
    args = (positions, 0.12, (0,) * 3, (1,) * 3, (None,) * 3)
    together = neighbours_by_id(domain_of(*args))
    use_threads(1)
    assert together == neighbours_by_id(domain_of(*args))
