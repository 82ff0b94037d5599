"""The peak rates of the cores in use: copies and multiply-adds."""

import time
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from psph.engine.jit import compiled
from psph.fields import filled

COPIED = 1 << 24
"""Numbers of an array that is copied, 128 MiB: more than caches hold."""

LINE, ROUNDS = 1024, 2000
"""Numbers that multiply-adds work on (the nearest cache holds them), and rounds of a sample."""

CHAINS, LINKS = 8, 16
"""Independent chains of multiply-adds, and the length of each; `multiply_add` writes them out."""

TERM = -0.5
"""x² + TERM stays small and goes to -0.37."""

SAMPLES = 10
"""Samples of each; the best one counts."""


class Ceiling(NamedTuple):
    """Bytes/s of a copy (read and written) and flops/s of multiply-adds, all ranks at once."""

    bytes_per_second: float
    flops_per_second: float


def measure_ceiling(comm) -> Ceiling:
    """Measure both on all ranks at once; collective."""
    source, target = np.ones(COPIED), np.zeros(COPIED)
    line = np.zeros(LINE)
    multiply_add(line, 1, TERM)  # compiled here, and memory touched
    copying = _best(comm, lambda: np.copyto(target, source))
    adding = _best(comm, lambda: multiply_add(line, ROUNDS, TERM))
    return Ceiling(
        comm.allreduce((source.nbytes + target.nbytes) / copying),
        comm.allreduce(2.0 * CHAINS * LINKS * LINE * ROUNDS / adding),
    )


def _best(comm, work: Callable[[], object]) -> float:
    """Seconds of the fastest sample on this rank, while all ranks work."""
    seconds = []
    for _ in range(SAMPLES):
        comm.Barrier()
        begun = time.perf_counter()
        work()
        seconds.append(time.perf_counter() - begun)
    return min(seconds)


@compiled
def multiply_add(line, rounds, term):
    """``rounds`` times eight chains of sixteen multiply-adds for each number of ``line``.

    Squares, since the compiler would add up chains of x -> factor x + term and compute but one.
    """
    for _ in range(rounds):
        for n in range(np.uint64(len(line))):
            x = line[n]
            a, b, c, d = x, x + 0.1, x + 0.2, x + 0.3
            e, f, g, h = x + 0.4, x + 0.5, x + 0.6, x + 0.7
            for _ in range(16):
                a, b, c, d = a * a + term, b * b + term, c * c + term, d * d + term
                e, f, g, h = e * e + term, f * f + term, g * g + term, h * h + term
            line[n] = 0.125 * ((a + b) + (c + d) + (e + f) + (g + h))


def roof(ceiling: Ceiling) -> dict:
    """The ceiling by the keys of a result."""
    return {
        "copy_bytes_per_second": ceiling.bytes_per_second,
        "multiply_add_flops_per_second": ceiling.flops_per_second,
    }


def shares(simulation, ceiling: Ceiling, pairs: int, entries: int, seconds: float) -> dict:
    """What a pass over the pairs, of ``seconds`` on average, makes of the ceiling.

    ``pairs`` inside the support and ``entries`` of the lists, over all ranks.  Bytes are those
    that must come from memory or go there once a pass: lists, what is read of the particles, and
    what is written; neighbours are taken to be found in a cache.
    """
    plan, store = simulation.plan, simulation.store
    flops = plan.flops_per_pair(simulation.domain.periods)
    view = [x for entry in store.view() for x in (entry if isinstance(entry, tuple) else (entry,))]
    read = sum(isinstance(x, np.ndarray) for x in view)
    written = store.dimensions + 1 + sum(len(filled(e)) for e in plan.reductions)
    begin_and_lengths = 2
    particles = simulation.comm.allreduce(store.owned)
    moved = 4 * entries + 8 * (read + written + begin_and_lengths) * particles
    return {
        "flops_per_pair": flops,
        "flops_per_second": flops * pairs / seconds,
        "flops_share": flops * pairs / seconds / ceiling.flops_per_second,
        "bytes_per_pass": moved,
        "bytes_per_second": moved / seconds,
        "bytes_share": moved / seconds / ceiling.bytes_per_second,
    }
