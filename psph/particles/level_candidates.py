"""What the particles of one cell share: those that may be near any of them, side by side in memory."""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import inside, overload, register_jitable, tuple_of, unrolled
from psph.engine.simd import bits, consecutive, put_consecutive, set_bits, width_of
from psph.particles.lanes import LANES, consecutive_each, keep_entries, keep_lanes
from psph.particles.level_ranges import AXES, WIDER
from psph.vectors import at, dot, nearest_image, subtract

PARTS = 3
"""Candidates of coarser levels, of a cell's own, and of finer ones: each part begins with a register."""


class Candidates(NamedTuple):
    """Those that may be near a cell's particles, in the order of the grids.

    ``position`` are the components of their places from the middle of the cell, m, ``within2`` the squares of
    how far they reach, m², and ``columns`` theirs; registers are filled up with places that are NaN, near
    nobody.  ``rounded`` are places, and squares less what that may add to them, in single precision: behind a
    register of each component one of the squares, so that a loop over all of it needs one address.
    """

    position: tuple
    within2: np.ndarray
    columns: np.ndarray
    rounded: np.ndarray


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
    position = tuple(np.zeros(count) for _ in range(dimensions))
    columns, rounded = np.zeros(count, np.uint32), np.zeros(count * (dimensions + 1), np.float32)
    return Candidates(position, np.zeros(count), columns, rounded)


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


def outside(x, half):
    """How far places ``x`` from the middle of a box are beyond its faces, along each axis, m; 0 within."""
    return tuple(max(abs(a) - b, 0.0) for a, b in zip(x, half))


@overload(outside)
def _typed_outside(x, half):
    parts = (f"max(abs(x[{d}]) - half[{d}], 0.0)" for d in range(len(half)))
    return unrolled("x, half", f"return {tuple_of(parts)}")


def seen_from(grids, middle, m):
    """Where particle ``m`` of the grids is from the ``middle`` of a cell (dim,), m, its nearest image; lanes
    in compiled code."""
    return nearest_image(subtract(at(grids.position, m), middle), grids.periods)


@overload(seen_from)
def _typed_seen_from(grids, middle, m):
    return lambda grids, middle, m: nearest_image(
        subtract(consecutive_each(grids.position, m), middle), grids.periods
    )


def beside_bits(x, box, within2, grids, m):
    """Bit t says whether particle ``m + t`` of the grids, at ``x``, is as near the ``box`` as it reaches, or
    as near as the square root of ``within2``."""
    away = outside(subtract(x, box[1]), box[2])
    return int(dot(away, away) <= WIDER * WIDER * max(within2, grids.within2[m]))


@overload(beside_bits)
def _typed_beside_bits(x, box, within2, grids, m):
    def compare(x, box, within2, grids, m):
        away = outside(subtract(x, box[1]), box[2])
        return bits(dot(away, away) <= max(consecutive(grids.within2, m), within2) * (WIDER * WIDER))

    return compare


@register_jitable
def place_of(near, n):
    """Where candidate ``n`` stands among those in single precision: its first component; the others, and the
    square of its reach, follow by a register each."""
    return n + n // np.uint64(LANES) * np.uint64(LANES * len(near.position))


def one_rounded(position, rounded, place):
    """Place (dim,) and square of the reach of the candidate at ``place``, in single precision; there are as
    many components as those of ``position``."""
    x = tuple(rounded[place + np.uint64(d * LANES)] for d in range(len(position)))
    return x, rounded[place + np.uint64(len(position) * LANES)]


@overload(one_rounded)
def _typed_one_rounded(position, rounded, place):
    each = [f"rounded[place + np.uint64({d * LANES})]" for d in range(len(position) + 1)]
    return unrolled("position, rounded, place", f"return {tuple_of(each[:-1])}, {each[-1]}", np=np)


def all_rounded(position, rounded, place):
    """The same of as many candidates as a register holds, from that at ``place`` on."""
    return one_rounded(position, rounded, place)


@overload(all_rounded)
def _typed_all_rounded(position, rounded, place):
    each = [f"consecutive(rounded, place + np.uint64({d * LANES}))" for d in range(len(position) + 1)]
    returned = f"return {tuple_of(each[:-1])}, {each[-1]}"
    return unrolled("position, rounded, place", returned, consecutive=consecutive, np=np)


def near_bits(x_i, within2_i, near, place):
    """Bit t says whether the candidate t behind that at ``place`` lies within its reach of ``x_i``, or within
    that of this one, whose square is ``within2_i``; in single precision."""
    x_j, within2_j = all_rounded(near.position, near.rounded, place)
    x_ij = subtract(x_i, x_j)
    return int(dot(x_ij, x_ij) <= max(within2_i, within2_j))


@overload(near_bits)
def _typed_near_bits(x_i, within2_i, near, place):
    def compare(x_i, within2_i, near, place):
        x_j, within2_j = all_rounded(near.position, near.rounded, place)
        x_ij = subtract(x_i, x_j)
        return bits(dot(x_ij, x_ij) <= max(within2_j, within2_i))

    return compare


def keep_each(into, end, x, chosen):
    """Write each component of those places ``x`` of which a bit is ``chosen`` from ``end`` on."""
    if chosen:
        for kept, component in zip(into, x):
            kept[end] = component


@overload(keep_each)
def _typed_keep_each(into, end, x, chosen):
    lines = (f"keep_lanes(into[{d}], end, x[{d}], chosen)" for d in range(len(into)))
    return unrolled("into, end, x, chosen", *lines, keep_lanes=keep_lanes)


@inside
def round_all(near, end, narrower):
    """Write the first candidates, before ``end``, in single precision, the squares of reaches times
    ``narrower``."""
    squares = np.uint64(len(near.position) * LANES)
    for n in range(np.uint64(0), np.uint64(end), width_of(near.within2)):
        place = place_of(near, n)
        for d in range(len(near.position)):
            put_consecutive(near.rounded, place + np.uint64(d * LANES), consecutive(near.position[d], n))
        put_consecutive(near.rounded, place + squares, consecutive(near.within2, n) * narrower)


@register_jitable
def fill_up(near, end):
    """Fill a register up with what is near nobody; the new end."""
    last = -(-end // LANES) * LANES
    for n in range(end, last):
        near.position[0][n] = np.nan
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
            for m in range(np.uint64(begin), np.uint64(until), width_of(grids.within2)):
                others = (one << min(np.uint64(LANES), np.uint64(until) - m)) - one
                x, place = seen_from(grids, box[0], m), np.uint64(end)
                chosen = beside_bits(x, box, within2, grids, m) & others
                keep_each(near.position, place, x, chosen)
                keep_entries(near.columns, place, grids.columns, m, chosen, grids.within2)
                end = np.int64(keep_lanes(near.within2, place, consecutive(grids.within2, m), chosen))
            begin = until
    end = fill_up(near, end)
    round_all(near, end, narrower)
    return Gathered(end, first, last, itself)


@inside
def append_row(entries, end, itself, own, near, first, last):
    """Write the columns of the neighbours of the candidate ``itself`` behind ``end``, of those from ``first``
    to ``last``; returns the new end.  ``own`` is 1 where it looks as far as it reaches itself, else 0."""
    here = place_of(near, np.uint64(itself))
    x_i, within2_i = one_rounded(near.position, near.rounded, here)
    within2_i *= np.float32(own)
    x = near.rounded[here]
    near.rounded[here] = np.nan  # not its own neighbour
    for n in range(np.uint64(first), np.uint64(last), width_of(near.rounded)):
        chosen = near_bits(x_i, within2_i, near, place_of(near, n))
        keep_entries(entries, end, near.columns, n, chosen, near.rounded)
        end += set_bits(chosen)
    near.rounded[here] = x
    return end
