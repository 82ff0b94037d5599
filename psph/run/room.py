"""Whether a run fits into the memory, told before it takes any."""

from psph.errors import Refused
from psph.parallel.machine import free_memory, ranks_here
from psph.run.explain import bytes_of_rank
from psph.simulation.plan import Plan

GIB = 2.0**30


class TooLittleMemory(Refused):
    """The machine would run out of memory."""


def check_memory(scene, plan: Plan, comm) -> None:
    """Raise TooLittleMemory on every rank where the ranks of one machine need more than is free.

    Else the system would kill a rank in the midst of the run, without a word.
    """
    ranks, free = ranks_here(comm), free_memory()
    needed = ranks * bytes_of_rank(scene, plan, comm.size)
    short = [pair for pair in comm.allgather((needed, free)) if pair[0] > pair[1]]
    if short:
        needed, free = max(short, key=lambda pair: pair[0] - pair[1])
        raise TooLittleMemory(
            f"{scene.case.name}: {int(scene.counts().sum()):,} particles need about "
            f"{needed / GIB:.1f} GiB on one machine, {free / GIB:.1f} GiB are free there: use more "
            "machines, or a larger space.spacing"
        )
