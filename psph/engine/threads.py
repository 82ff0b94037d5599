"""Threads of a rank: the columns of a loop in equal parts, the very same compiled code on each.

Compiled loops let go of Python's lock, so plain threads run them side by side.  A loop treats each
column by itself: the bits do not depend on the number of threads.
"""

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

from psph.errors import Refused

_pool: ThreadPoolExecutor | None = None
_count = 1


class TooManyThreads(Refused):
    """A number of threads that this rank cannot run."""


def threads() -> int:
    """Threads that this rank's loops run in."""
    return _count


def use_threads(number: int) -> None:
    """Run loops in so many threads from now on; TooManyThreads where the rank has fewer cores."""
    global _pool, _count
    cores = len(os.sched_getaffinity(0))
    if not 1 <= number <= cores:
        raise TooManyThreads(
            f"--threads {number}: this rank may use {cores} core{'s' * (cores > 1)}; give 1 to "
            f"{cores}, or let mpirun give each rank more (--map-by slot:PE={max(number, 1)})"
        )
    if _pool is not None:
        _pool.shutdown()
    _pool = ThreadPoolExecutor(number - 1) if number > 1 else None
    _count = number


def in_threads(loop, first: int, last: int, *args) -> list:
    """``loop(a, b, *args)`` for parts a to b of the columns ``first`` to ``last``; what each gave."""
    return in_rooms(loop, first, last, [()] * _count, *args)


def in_rooms(loop, first: int, last: int, rooms: Sequence[tuple], *args) -> list:
    """The same of ``loop(a, b, *args, *room)``, where each thread has a room of its own to work in."""
    if _pool is None or last - first < _count:
        return [loop(first, last, *args, *rooms[0])]
    cuts = [first + (last - first) * part // _count for part in range(_count + 1)]
    others = [_pool.submit(loop, a, b, *args, *room) for a, b, room in zip(cuts[1:], cuts[2:], rooms[1:])]
    return [loop(*cuts[:2], *args, *rooms[0]), *(other.result() for other in others)]
