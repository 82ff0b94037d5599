"""What the particles of some cells share where all reach as far: those that may be near any of them."""

import math
from typing import NamedTuple

import numpy as np

from psph.engine.jit import inside, overload, tuple_of, unrolled
from psph.engine.simd import bits, set_bits, width_of
from psph.particles.blocks import all_of, block_for, one_of, pack, place_of
from psph.particles.lanes import LANES, append_near, consecutive_each, keep_each, keep_entries
from psph.vectors import dot, nearest_image, subtract

MOST = 18
"""Ranges of columns that cells and those around them are at the most."""


class Near(NamedTuple):
    """What makes two particles neighbours: their positions in single precision, m, the periods of the
    axes, m, and the square of the cutoff, m²; positions are wrong by less than ``slack``, m."""

    position: tuple
    periods: tuple
    cutoff2: float
    slack: float


class CellRoom(NamedTuple):
    """Room for candidates: components of their ``position`` and their ``columns``, in the order of these, and
    a ``block`` of the former; for ranges of columns, ``begins`` and ``ends``; for a ``box`` (2, dim), m."""

    position: tuple
    columns: np.ndarray
    block: np.ndarray
    begins: np.ndarray
    ends: np.ndarray
    box: np.ndarray


def room_near(groups: int, dimensions: int) -> CellRoom:
    """Room for so many groups of candidates."""
    count = groups * LANES
    position = tuple(np.zeros(count, np.float32) for _ in range(dimensions))
    ranges, box = np.zeros((2, MOST), np.uint64), np.zeros((2, dimensions), np.float32)
    return CellRoom(position, np.zeros(count, np.uint32), block_for(count, dimensions), *ranges, box)


@inside
def measure_box(near, first, last, box):
    """Write the middle of the ``box`` around the columns from ``first`` to ``last``, and half its width."""
    for d in range(len(near.position)):
        x, least, most = near.position[d], np.float32(np.inf), np.float32(-np.inf)
        for i in range(first, last):
            least, most = min(least, x[i]), max(most, x[i])
        box[0, d], box[1, d] = 0.5 * (least + most), 0.5 * (most - least) + near.slack


def row_of(table, row, like):
    """The first numbers of a row of the ``table``, as many as there are in ``like``."""
    return tuple(table[row, d] for d in range(len(like)))


@overload(row_of)
def _typed_row_of(table, row, like):
    each = (f"table[row, {d}]" for d in range(len(like)))
    return unrolled("table, row, like", f"return {tuple_of(each)}")


def outside(x, half):
    """How far places ``x`` from the middle of a box are beyond its faces, along each axis, m; 0 within."""
    return tuple(max(abs(a) - b, 0.0) for a, b in zip(x, half))


@overload(outside)
def _typed_outside(x, half):
    parts = (f"max(abs(x[{d}]) - half[{d}], 0.0)" for d in range(len(half)))
    return unrolled("x, half", f"return {tuple_of(parts)}")


def far_bits(x, middle, half, near):
    """Bit t says whether the particle t of those at ``x`` is farther than the cutoff from a box of such a
    ``middle`` and ``half`` its width, m."""
    if any(map(math.isnan, (*x, *middle))):
        return 0
    away = outside(nearest_image(subtract(x, middle), near.periods), half)
    return int(dot(away, away) > near.cutoff2)


@overload(far_bits)
def _typed_far_bits(x, middle, half, near):
    def compare(x, middle, half, near):
        away = outside(nearest_image(subtract(x, middle), near.periods), half)
        return bits(dot(away, away) > near.cutoff2)

    return compare


@inside
def gather(near, first, last, ranges, found):
    """Write to ``found`` those in the first ``ranges`` of columns that may be near any of the columns
    ``first`` to ``last``; returns how many groups they are, and the place of the first of these columns.

    Who is at no number is out of nobody's reach, so that these go up one by one.
    """
    lanes, one = width_of(near.position[0]), np.uint64(1)
    end = own = np.uint64(0)
    measure_box(near, first, last, found.box)
    middle, half = row_of(found.box, 0, near.position), row_of(found.box, 1, near.position)
    for q in range(ranges):
        begin, stop = found.begins[q], found.ends[q]
        while begin < stop:
            until = first if begin < first < stop else stop
            if begin == first:
                own = end
            for column in range(begin, until, lanes):
                others = (one << min(lanes, until - column)) - one
                x = consecutive_each(near.position, column)
                chosen = others & ~np.uint64(far_bits(x, middle, half, near))
                keep_each(found.position, end, x, chosen)
                end = append_near(found.columns, end, column, chosen)
            begin = until
    groups = (end + np.uint64(LANES - 1)) // np.uint64(LANES)
    for n in range(end, groups * np.uint64(LANES)):
        found.position[0][n] = np.nan  # near nobody
    pack(found.position, groups * np.uint64(LANES), found.block)
    return groups, own


def near_bits(x_i, near, x_j):
    """Bit t says whether the particle t of those at ``x_j`` is within the cutoff of ``x_i``."""
    if any(map(math.isnan, (*x_i, *x_j))):
        return 0  # plain Python rounds no NaN
    x_ij = nearest_image(subtract(x_i, x_j), near.periods)
    return int(dot(x_ij, x_ij) < near.cutoff2)


@overload(near_bits)
def _typed_near_bits(x_i, near, x_j):
    def compare(x_i, near, x_j):
        x_ij = nearest_image(subtract(x_i, x_j), near.periods)
        return bits(dot(x_ij, x_ij) < near.cutoff2)

    return compare


@inside
def append_row(lists, end, itself, near, found, groups):
    """Write the columns of the neighbours of candidate ``itself`` behind ``end``; returns the new end."""
    here = place_of(found.position, itself)
    x_i = one_of(found.position, found.block, here)
    found.block[here] = np.nan  # not its own neighbour
    for n in range(np.uint64(0), groups * np.uint64(LANES), width_of(found.block)):
        x_j = all_of(found.position, found.block, place_of(found.position, n))
        chosen = near_bits(x_i, near, x_j)
        keep_entries(lists, end, found.columns, n, chosen, found.block)
        end += set_bits(chosen)
    found.block[here] = x_i[0]
    return end
