"""Work of one rank while the others leave their cores free."""

import time
from collections.abc import Callable
from typing import TypeVar

from psph.lab.errors import BenchError

T = TypeVar("T")

NAP = 0.002
"""Seconds between two checks whether rank 0 is done; waiting inside MPI would occupy a core."""


def on_rank_0(comm, work: Callable[[], T]) -> T:
    """The result of ``work()`` on rank 0, for all ranks; collective.

    A BenchError is raised on all ranks, as what it is.
    """
    found = trouble = None
    if comm.rank == 0:
        try:
            found = work()
        except BenchError as error:
            trouble = error
    arrived = comm.Ibarrier()
    while not arrived.Test():
        time.sleep(NAP)
    found, trouble = comm.bcast((found, trouble))
    if trouble:
        raise trouble
    return found
