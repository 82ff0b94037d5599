"""Which walls have fluid in reach: decided by the places of each step."""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import compiled, elementwise
from psph.vectors import at, dot, nearest_image, subtract


class DryRows(NamedTuple):
    """Of the lists of each particle the whole ``lengths``, and whether it may ``rest`` while it is dry."""

    lengths: np.ndarray
    rest: np.ndarray


WETTING = 0.95
"""Part of the kernel's support within which fluid makes a wall wet; it stays so up to the whole support.
W there is 1e-4 of that of a neighbour a spacing away, or less: no force tells one distance from the other."""

DRY, BESIDE_OTHERS, WET = 0.0, 0.5, 1.0
"""Without fluid in reach; with fluids alone that the wall does not serve with its own pressure; with one that
it serves."""


@elementwise
def mark_wet(first, last, walls, low, lists, rows, support, periods, position, group, serves, fluid, wet):
    """``wet`` of the columns that the entries ``first`` to ``last`` of ``walls`` name: DRY in a wall without
    fluid in reach, else BESIDE_OTHERS or WET.

    A wall becomes wet where fluid comes within the part WETTING of the kernel's ``support``, m, and dry
    where it leaves the support: between the two it stays what it was, so that water that trembles does not
    make a wall at the edge of its reach lose its pressure again and again.  ``lists`` are
    :class:`psph.particles.neighbours.Neighbours` of the particles from column ``low`` on, whose row becomes
    empty in a dry wall that :class:`DryRows` let rest; ``fluid`` a number from 1 on in a fluid, else 0.
    ``serves`` says of the group of a wall and the number of a fluid whether the wall shows it a pressure of
    its own; particles of a group that serves none stay dry.
    """
    for w in range(np.uint64(first), np.uint64(last)):
        k = np.uint64(walls[w])
        row, own = k - np.uint64(low), serves[group[k]]
        found = WET if fluid[k] > 0.0 else DRY
        reach = support if wet[k] >= WET else WETTING * support
        others = support if wet[k] > DRY else WETTING * support
        n, end = lists.begin[row], lists.begin[row] + np.uint64(rows.lengths[row])
        bears = own.any()
        while found < WET and bears and n < end:
            j = np.uint64(lists.lists[n])
            x = nearest_image(subtract(at(position, k), at(position, j)), periods)
            if own[np.uint64(fluid[j])] and dot(x, x) < reach * reach:
                found = WET
            elif fluid[j] > 0.0 and dot(x, x) < others * others:
                found = BESIDE_OTHERS
            n += np.uint64(1)
        wet[k] = found
        if rows.rest[row]:
            lists.lengths[row] = rows.lengths[row] if found > DRY else 0


@elementwise
def find_undecided(first, last, low, lists, reach, periods, listed, group, serves, fluid, wet, undecided):
    """Which of the columns ``first`` to ``last`` :func:`mark_wet` may change while the lists last.

    ``undecided`` of a row is True in a wall that bears a pressure, but where it is wet and a fluid that it
    ``serves`` stood nearer than ``reach``, m, at the ``listed`` places when the lists were made, where others
    stood so near and it lists none that it serves, and where it is dry and none is listed.  ``reach`` is the
    support without the skin by which two particles may have parted since.
    """
    for k in range(np.uint64(first), np.uint64(last)):
        row, own = k - np.uint64(low), serves[group[k]]
        held = beside = served = some = False
        n, end = lists.begin[row], lists.begin[row] + np.uint64(lists.lengths[row])
        bears = fluid[k] == 0.0 and own.any()
        while bears and not held and n < end:
            j = np.uint64(lists.lists[n])
            if fluid[j] > 0.0:  # most of what a dry wall lists is wall
                x = nearest_image(subtract(at(listed, k), at(listed, j)), periods)
                near = reach > 0.0 and dot(x, x) < reach * reach
                serves_it = own[np.uint64(fluid[j])]
                some, served = True, served or serves_it
                held = near and serves_it and wet[k] >= WET
                beside = beside or near
            n += np.uint64(1)
        held = held or beside and not served and wet[k] == BESIDE_OTHERS
        undecided[row] = bears and not held and (some or wet[k] > DRY)


@compiled
def find_resting(first, last, low, lists, group, free, rest):
    """``rest`` of the rows of the columns ``first`` to ``last``: whether nothing has to be summed while dry.

    That is so in a wall and in a rigid body: groups from number ``free`` on, which forces do not move.
    """
    for k in range(np.uint64(first), np.uint64(last)):
        rest[k - np.uint64(low)] = group[k] >= free


@compiled
def find_beside_fluid(first, last, low, lists, loaded, group, is_fluid, beside):
    """``beside`` of the rows of columns ``first`` to ``last``: whether ``loaded`` groups list fluid there."""
    for k in range(np.uint64(first), np.uint64(last)):
        row = k - np.uint64(low)
        n, end = lists.begin[row], lists.begin[row] + np.uint64(lists.lengths[row])
        found = False
        while loaded[group[k]] and not found and n < end:
            found = is_fluid[np.uint64(lists.lists[n])] > 0.0
            n += np.uint64(1)
        beside[row] = found


@elementwise
def find_felt(first, last, walls, low, lists, lengths, support, periods, position, is_fluid, felt):
    """``felt`` of the entries ``first`` to ``last`` of the columns ``walls``: whether fluid of their rows, of
    whole ``lengths``, is now within the kernel's ``support``, m.  An image in a mirror is farther."""
    for w in range(np.uint64(first), np.uint64(last)):
        k = np.uint64(walls[w])
        row = k - np.uint64(low)
        n, end = lists.begin[row], lists.begin[row] + np.uint64(lengths[row])
        found = False
        while not found and n < end:
            j = np.uint64(lists.lists[n])
            x = nearest_image(subtract(at(position, k), at(position, j)), periods)
            found = is_fluid[j] > 0.0 and dot(x, x) <= support * support
            n += np.uint64(1)
        felt[w] = found
