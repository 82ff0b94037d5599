"""What the particles of one cell share: those that may be near any of them, side by side in memory."""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import inside, overload, register_jitable, tuple_of, unrolled
from psph.engine.simd import bits, eight, narrowed, set_bits, width_of
from psph.particles.blocks import all_of, block_for, one_of, pack, place_of
from psph.particles.lanes import LANES, keep_each, keep_entries
from psph.particles.level_ranges import AXES
from psph.particles.near_cell import outside
from psph.vectors import at, dot, nearest_image, subtract

BESIDE = np.float32(1.0 + 1e-5)
"""Squares of distances in single precision are right to this factor, generously."""

PARTS = 3
"""Candidates of coarser levels, of a cell's own, and of finer ones: each part begins with a register."""


class Candidates(NamedTuple):
    """Those that may be near a cell's particles, in the order of the grids.

    ``numbers`` are the components of their places from the middle of the cell, m, and the squares of how far
    they reach, m², less what rounding may add to the former, all in single precision.  ``columns`` are
    theirs, and a ``block`` has their numbers side by side.  Registers are filled up with places that are
    NaN, near nobody.
    """

    numbers: tuple
    columns: np.ndarray
    block: np.ndarray


class Gathered(NamedTuple):
    """How many candidates there are until ``end``, fillings counted; which of them, from ``first`` to
    ``last``, are of the cell's own level, and the place ``itself`` of the cell's first particle."""

    end: int
    first: int
    last: int
    itself: int


def room_for(groups: int, dimensions: int) -> Candidates:
    """Room for so many ``groups`` of candidates."""
    count = (groups + 2 * PARTS) * LANES
    numbers = tuple(np.zeros(count, np.float32) for _ in range(dimensions + 1))
    return Candidates(numbers, np.zeros(count, np.uint32), block_for(count, dimensions + 1))


def box_around(low, high, middle, origin, periods):
    """The ``middle`` of a cell (dim,), m; middle and half the width (dim,), m, of a box from ``low`` to
    ``high`` seen from there; all three (3,), m from the ``origin``."""
    axes = range(AXES - len(periods), AXES)
    place = tuple(0.5 * (low[a] + high[a]) - middle[a] for a in axes)
    return tuple(origin[a] + middle[a] for a in axes), place, tuple(0.5 * (high[a] - low[a]) for a in axes)


@overload(box_around)
def _typed_box_around(low, high, middle, origin, periods):
    axes = range(AXES - len(periods), AXES)
    parts = (
        "origin[{0}] + middle[{0}]",
        "0.5 * (low[{0}] + high[{0}]) - middle[{0}]",
        "0.5 * (high[{0}] - low[{0}])",
    )
    found = ", ".join(tuple_of(part.format(a) for a in axes) for part in parts)
    return unrolled("low, high, middle, origin, periods", f"return {found}")


def numbers_of(grids, middle, narrower, m):
    """Where particle ``m`` of the grids is from the ``middle`` of a cell (dim,), m, its nearest image, and
    the square of its reach times ``narrower``, in single precision; lanes in compiled code."""
    x = nearest_image(subtract(at(grids.position, m), middle), grids.periods)
    return *map(np.float32, x), np.float32(grids.within2[m] * narrower)


@overload(numbers_of)
def _typed_numbers_of(grids, middle, narrower, m):
    dimensions = len(middle)
    return unrolled(
        "grids, middle, narrower, m",
        f"x = {tuple_of(f'eight(grids.position[{d}], m)' for d in range(dimensions))}",
        "x = nearest_image(subtract(x, middle), grids.periods)",
        f"return {tuple_of(f'narrowed(x[{d}])' for d in range(dimensions))} + "
        "(narrowed(eight(grids.within2, m) * narrower),)",
        eight=eight,
        narrowed=narrowed,
        nearest_image=nearest_image,
        subtract=subtract,
    )


def beside_bits(numbers, box, within2):
    """Bit t says whether the particle t of those with such ``numbers`` is as near the ``box`` as it reaches,
    or as near as the square root of ``within2``, in single precision."""
    away = outside(subtract(numbers[:-1], box[1]), box[2])
    return int(dot(away, away) <= BESIDE * max(within2, numbers[-1]))


@overload(beside_bits)
def _typed_beside_bits(numbers, box, within2):
    def compare(numbers, box, within2):
        away = outside(subtract(numbers[:-1], box[1]), box[2])
        return bits(dot(away, away) <= max(numbers[-1], within2) * BESIDE)

    return compare


def near_bits(i, j):
    """Bit t says whether the candidate t of those with such numbers ``j`` lies within its reach of another
    with the numbers ``i``, or within that of this one."""
    x_ij = subtract(i[:-1], j[:-1])
    return int(dot(x_ij, x_ij) <= max(i[-1], j[-1]))


@overload(near_bits)
def _typed_near_bits(i, j):
    def compare(i, j):
        x_ij = subtract(i[:-1], j[:-1])
        return bits(dot(x_ij, x_ij) <= max(j[-1], i[-1]))

    return compare


@register_jitable
def fill_up(near, end):
    """Fill a register up with what is near nobody; the new end."""
    last = -(-end // LANES) * LANES
    for n in range(end, last):
        near.numbers[0][n] = np.nan
    return last


@inside
def gather(grids, ranges, many, own, cell, box, within2, narrower, near):
    """Write to ``near`` those in the first ``many`` of the ``ranges`` that are as near the ``box`` around the
    particles ``cell[0]`` to ``cell[1]`` as they reach themselves, or as the square root of ``within2``, m²;
    in single precision squares of reaches are ``narrower`` by this factor.

    Ranges from number ``own[0]`` to before ``own[1]`` are of the cell's own level.
    """
    end, first, itself, one = np.int64(0), np.int64(0), np.int64(0), np.uint64(1)
    last = np.int64(0)
    for r in range(many + 1):
        if r == own[0]:
            end = first = fill_up(near, end)
        if r == own[1]:
            end = last = fill_up(near, end)
        begin, stop = (ranges[r, 0], ranges[r, 1]) if r < many else (np.int64(0), np.int64(0))
        while begin < stop:
            # The cell's own particles come one after another: their place is where the first of them goes.
            until = cell[0] if begin < cell[0] < stop else stop
            if begin == cell[0]:
                itself = end
            for m in range(np.uint64(begin), np.uint64(until), width_of(near.block)):
                others = (one << min(np.uint64(LANES), np.uint64(until) - m)) - one
                numbers, place = numbers_of(grids, box[0], narrower, m), np.uint64(end)
                chosen = beside_bits(numbers, box, within2) & others
                keep_each(near.numbers, place, numbers, chosen)
                keep_entries(near.columns, place, grids.columns, m, chosen, near.block)
                end += np.int64(set_bits(chosen))
            begin = until
    end = fill_up(near, end)
    pack(near.numbers, end, near.block)
    return Gathered(end, first, last, itself)


@inside
def append_row(entries, end, itself, own, near, first, last):
    """Write the columns of the neighbours of the candidate ``itself`` behind ``end``, of those from ``first``
    to ``last``; returns the new end.  ``own`` is 1 where it looks as far as it reaches itself, else 0."""
    here = place_of(near.numbers, np.uint64(itself))
    numbers = one_of(near.numbers, near.block, here)
    i = numbers[:-1] + (numbers[-1] * np.float32(own),)
    near.block[here] = np.nan  # not its own neighbour
    for n in range(np.uint64(first), np.uint64(last), width_of(near.block)):
        chosen = near_bits(i, all_of(near.numbers, near.block, place_of(near.numbers, n)))
        keep_entries(entries, end, near.columns, n, chosen, near.block)
        end += set_bits(chosen)
    near.block[here] = numbers[0]
    return end
