"""Lists where particles are of several levels of sizes: pairs of one level, and who is followed."""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import compiled, register_jitable
from psph.particles.neighbours import Neighbours, entries_for
from psph.vectors import at, dot, nearest_image, subtract


class Membership(NamedTuple):
    """Of each column its ``level``, whether it ``follows`` and whether it ``leads``; its ``position``, m, and
    up to which squared distance it is seen, ``within2``, m²; ``periods`` in m or None."""

    level: np.ndarray
    follows: np.ndarray
    leads: np.ndarray
    position: tuple
    within2: np.ndarray
    periods: tuple


def part_levels(lists: Neighbours, low: int, owned: int, of: Membership, lanes: int) -> Neighbours:
    """Leave in the rows of ``owned`` particles those of their own level; returned are rows of those that lead
    on other levels, of whoever follows, in the same order."""
    lengths = np.zeros(len(lists.lengths), np.uint32)
    count_led(owned, low, lists, of, lengths)
    ends = np.cumsum(lengths, dtype=np.uint64)
    led = Neighbours(ends - lengths, lengths, entries_for(int(ends[-1]) if len(ends) else 0))
    move_led(owned, low, lists, of, led, lanes)
    return led


@register_jitable
def is_led(of, k, j):
    """Whether the column ``j`` leads ``k`` on another level, near enough."""
    if not of.leads[j] or of.level[j] == of.level[k]:
        return False
    x_jk = nearest_image(subtract(at(of.position, j), at(of.position, k)), of.periods)
    return dot(x_jk, x_jk) < of.within2[j]


@compiled
def count_led(owned, low, lists, of, lengths):
    """How many entries of each row are of those who lead it."""
    for row in range(np.uint64(owned)):
        k = row + np.uint64(low)
        if of.follows[k]:
            begin = lists.begin[row]
            for n in range(begin, begin + np.uint64(lists.lengths[row])):
                j = np.uint64(lists.lists[n])
                lengths[row] += np.uint32(is_led(of, k, j))


@compiled
def move_led(owned, low, lists, of, led, lanes):
    """Move these entries to the rows of ``led``; what is left of each row ends with the particle itself."""
    one = np.uint64(1)
    for row in range(np.uint64(owned)):
        k, begin = row + np.uint64(low), lists.begin[row]
        end, kept, moved = begin + np.uint64(lists.lengths[row]), begin, led.begin[row]
        for n in range(begin, end):
            j = np.uint64(lists.lists[n])
            if of.level[j] == of.level[k]:
                lists.lists[kept] = j
                kept += one
            elif of.follows[k] and is_led(of, k, j):
                led.lists[moved] = j
                moved += one
        for n in range(kept, end):
            lists.lists[n] = k
        lists.lengths[row] = kept - begin
