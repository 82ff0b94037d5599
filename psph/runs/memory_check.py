"""Whether a run fits into the memory, told before it takes any."""

import math

from psph.errors import Refused
from psph.kinds import count_of
from psph.parallel.machine import free_memory, ranks_here
from psph.runs.footprint import bytes_of_rank
from psph.simulation.plan import Plan

GIB = 2.0**30


LEAST_BYTES = 300
"""Of a particle, under any scheme: a run never needs less."""


QUICKLY_COUNTED = 1e8
"""So many sites are counted within seconds."""


class TooLittleMemory(Refused):
    """The machine would run out of memory."""


def check_size(scene, comm) -> None:
    """Raise TooLittleMemory on every rank where the particles by their volume alone need too much memory.

    Before the sites are counted, which takes hours where they are too many by far.
    """
    sites = (
        sum(_least_volume(part.shape) for part in scene.layout.parts if part.moves_freely and part.drawn)
        / scene.spacing**scene.dimensions
    )
    free = sum(comm.allgather(free_memory() / ranks_here(comm)))
    if sites > QUICKLY_COUNTED and sites * LEAST_BYTES > free:
        raise TooLittleMemory(
            f"{scene.case.name}: about {sites:.2g} particles need at least "
            f"{sites * LEAST_BYTES / GIB:.3g} GiB, {free / GIB:.1f} GiB are free: use more machines, or a "
            "larger space.spacing"
        )


def _least_volume(shape) -> float:
    """What a shape holds at the least, m^d: of a box its volume; nothing is known of others."""
    box = shape.box
    return math.prod(up - low for low, up in zip(box.lower, box.upper)) if box else 0.0


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
            f"{scene.case.name}: {count_of(scene):,} particles need about "
            f"{needed / GIB:.1f} GiB on one machine, {free / GIB:.1f} GiB are free there: use more "
            "machines, or a larger space.spacing"
        )
