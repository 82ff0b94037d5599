"""Whether ranks have their cores to themselves: where they share them, all wait for the slowest."""

from collections.abc import Iterator
from time import perf_counter, thread_time

from psph.engine.threads import threads

BUSY = "the machine is busy"
"""How its warning begins."""

PATIENCE = 2.0
"""Seconds of steps before it is said."""

LEAST = 0.75
"""Part of a core that a rank has on a machine where nothing else works; what waits for messages counts, since
it asks for them without pause."""


class Busy:
    """The part of a core that the ranks of a run get, in steps alone: files are waited for besides."""

    def __init__(self, comm):
        self.comm, self.wall, self.cpu = comm, 0.0, 0.0
        self._alone = comm.size == 1 or threads() > 1
        self._told = False

    def step(self, work) -> str:
        """Do the ``work`` of a step; returns a warning, once, as soon as it is due on this rank."""
        if self._alone:
            work()
            return ""
        wall, cpu = perf_counter(), thread_time()  # that of the process takes up to 1 ms to ask for
        work()
        self.wall += perf_counter() - wall
        self.cpu += thread_time() - cpu
        if self._told or self.wall < PATIENCE:
            return ""
        self._told = True
        return self._says(self.cpu / self.wall)

    def summary(self) -> Iterator[str]:
        """The same of the whole run and the rank that got least; collective."""
        if self._alone:
            return
        spent = self.comm.allgather((self.cpu, self.wall))  # on all: each may have waited another time
        if max(wall for _, wall in spent) >= PATIENCE:
            yield from filter(None, [self._says(min(cpu / wall for cpu, wall in spent if wall))])

    def _says(self, share: float) -> str:
        if share >= LEAST:
            return ""
        fewer = max(1, min(round(share * self.comm.size), self.comm.size - 1))
        return (
            f"{BUSY}: a rank gets {share:.0%} of a core, and all wait for the slowest; "
            f"try fewer ranks (mpirun -n {fewer})"
        )
