"""Numbers of several particles side by side: a register of each number behind one another, over and over.

A loop over all of them needs one address, where one array for each number would need as many.
"""

import numpy as np

from psph.engine.jit import inside, overload, register_jitable, tuple_of, unrolled
from psph.engine.simd import consecutive, put_consecutive, width_of
from psph.particles.lanes import LANES

EACH = np.uint64(LANES)
"""From a number of a particle to its next one."""


def block_for(count: int, numbers: int) -> np.ndarray:
    """Room for so many ``numbers`` each of a ``count`` of particles, a multiple of ``LANES``."""
    return np.zeros(count * numbers, np.float32)


@register_jitable
def place_of(numbers, n):
    """Where the first number of particle ``n`` of a block stands; each has as many as ``numbers`` are."""
    return n + n // EACH * (EACH * np.uint64(len(numbers) - 1))


def one_of(numbers, block, place):
    """The numbers, as many as there are ``numbers``, of the particle at this place."""
    return tuple(block[place + np.uint64(d * LANES)] for d in range(len(numbers)))


@overload(one_of)
def _typed_one_of(numbers, block, place):
    each = (f"block[place + np.uint64({d * LANES})]" for d in range(len(numbers)))
    return unrolled("numbers, block, place", f"return {tuple_of(each)}", np=np)


def all_of(numbers, block, place):
    """The same of as many particles as a register holds, from the one at this place on: lanes."""
    return one_of(numbers, block, place)


@overload(all_of)
def _typed_all_of(numbers, block, place):
    each = (f"consecutive(block, place + np.uint64({d * LANES}))" for d in range(len(numbers)))
    returned = f"return {tuple_of(each)}"
    return unrolled("numbers, block, place", returned, consecutive=consecutive, np=np)


@inside
def pack(numbers, end, block):
    """Write the first ``end`` particles to a block, of whose numbers each has an array among ``numbers``."""
    for d in range(len(numbers)):
        one = numbers[d]
        for n in range(np.uint64(0), np.uint64(end), width_of(block)):
            put_consecutive(block, place_of(numbers, n) + EACH * np.uint64(d), consecutive(one, n))
