"""How far particles have moved against each other since the lists were made."""

import functools

import numpy as np

from psph.engine.jit import elementwise

LOW, HIGH = -1e150, 1e150
"""No number of a particle lies outside, and their squares are numbers still."""

AXES = 3
"""Axes of a box; in 1D and 2D the boxes have no extent along the others."""

MOVED, VELOCITY, DRIFTED = 0, 1, 2
"""What a box is of; and the largest there is of the first."""


NONE = np.zeros(0, np.int64)
"""No rows."""

MARGIN = 2
"""Blocks before and behind each line, empty or periodic images: the farthest that count."""


def bounding_boxes(data, position, listed, velocity, starts, planes, counts, reach, periodic, coming=NONE):
    """Ranges of displacement and velocity in blocks of cells about as wide as the cutoff.

    ``position``, ``listed`` and ``velocity`` are rows of ``data``, one a dimension; the other
    arguments as in psph.particles.neighbours.  Returns two arrays (2, lines, AXES, blocks and
    margins), the lowest and the highest x − x_listed and v of each block of each line of cells,
    ghosts included; an empty block has its lowest above its highest.
    """
    wide = max(reach, 1)
    blocks = int(max(counts[2] // wide, 1))
    shape = (2 if len(velocity) else 1, (planes + 2) * counts[1], AXES, blocks + 2 * MARGIN)
    low, high = np.zeros(shape), np.zeros(shape)
    low[:, :, : len(position)], high[:, :, : len(position)] = HIGH, LOW
    fill_boxes(data, position, listed, coming, velocity, starts, counts[2], wide, blocks, low, high)
    # Along a line the margins repeat its ends; across lines the comparison itself wraps round.
    if periodic[2]:
        margins, images = images_of_margins(blocks)
        for ends in (low, high):
            ends[..., margins] = ends[..., images]
    return low, high


@functools.cache
def images_of_margins(blocks: int) -> tuple[np.ndarray, np.ndarray]:
    """Places of the margins of a line of so many ``blocks`` that repeats itself, and of what they show."""
    margins = np.r_[:MARGIN, blocks + MARGIN : blocks + 2 * MARGIN]
    return margins, (margins - MARGIN) % blocks + MARGIN


@elementwise
def fill_boxes(data, position, listed, coming, velocity, starts, columns, wide, blocks, low, high):
    """Fill in the blocks that are not in the margins."""
    for line in range(low.shape[1]):
        for block in range(blocks):
            end = columns if block == blocks - 1 else (block + 1) * wide
            first = np.uint64(starts[line * columns + block * wide])
            last = np.uint64(starts[line * columns + end])
            n = block + MARGIN
            for d in range(len(position)):
                least, most = HIGH, LOW
                for k in range(first, last):
                    moved = data[position[d], k] - data[listed[d], k]
                    if d < len(coming):
                        moved += data[coming[d], k]
                    least, most = min(least, moved), max(most, moved)
                low[MOVED, line, d, n], high[MOVED, line, d, n] = least, most
            for d in range(len(velocity)):
                least, most = HIGH, LOW
                for k in range(first, last):
                    v = data[velocity[d], k]
                    least, most = min(least, v), max(most, v)
                low[VELOCITY, line, d, n], high[VELOCITY, line, d, n] = least, most


def largest_differences(low, high, planes, rows, axes, periodic):
    """Bounds over all pairs that matter: |Δ(x − x_listed)|² and |Δv|²; and the largest
    |x − x_listed|².

    A list reaches no farther than the next block: ranges of neighbouring blocks bound every pair
    in it.  Particles that move together stay neighbours, however fast they are.  Of pairs with one
    block between them, a cutoff wide at the least, none is listed: they count by how far they have
    come nearer across it.  ``axes``: those of planes, of rows and of columns.
    """
    return compare_boxes(low, high, planes, rows, axes, periodic).max(axis=1)


@elementwise
def compare_boxes(low, high, planes, rows, axes, periodic):
    """These numbers by place in a line, (3, blocks)."""
    lines, blocks = low.shape[1], low.shape[3] - 2 * MARGIN
    largest2 = np.zeros((3, blocks))
    for line in range(np.uint64(lines)):
        plane, row = divmod(np.int64(line), rows)
        raise_reaches(largest2[DRIFTED], low, high, line)
        # Half of the blocks around, and itself: the others look here.
        for p in range(plane, min(plane + 3, planes + 2)):
            for r in range(row - 2 if p > plane else row, row + 3):
                if not (0 <= r < rows or periodic[1]):
                    continue
                other = np.uint64(p * rows + r % rows)
                for what in range(np.uint64(low.shape[0])):
                    best = largest2[what]
                    if p - plane == 2:
                        raise_approaches(best, low, high, what, line, other, axes[0])
                    elif r - row == 2:
                        raise_approaches(best, low, high, what, line, other, axes[1])
                    elif row - r == 2:
                        raise_approaches(best, low, high, what, other, line, axes[1])
                    else:
                        raise_spans(best, low, high, what, line, other, axes[2])
    return largest2


# Several blocks of a line go in a register: no branches, and no minimum or maximum that asks for NaN.


@elementwise
def raise_spans(best, low, high, what, line, other, axis):
    """Raise ``best`` to the squares of the longest vectors between points of the boxes of two lines
    side by side; across a block by how far they come nearer along ``axis``, that of the lines."""
    along, own = np.uint64(axis), np.uint64(MARGIN)
    for n in range(np.uint64(len(best))):
        largest = best[n]
        for b in range(np.uint64(1), np.uint64(2 * MARGIN)):
            total = 0.0
            for d in range(np.uint64(AXES)):
                one = high[what, line, d, n + own] - low[what, other, d, n + b]
                reverse = high[what, other, d, n + b] - low[what, line, d, n + own]
                longest = one if one > reverse else reverse
                longest = longest if longest > 0.0 else 0.0  # beside an empty one
                total += longest * longest
            largest = total if total > largest else largest
        ahead = high[what, line, along, n + own] - low[what, other, along, n + own + own]
        behind = high[what, other, along, n] - low[what, line, along, n + own]
        nearer = ahead if ahead > behind else behind
        nearer = nearer if nearer > 0.0 else 0.0
        best[n] = nearer * nearer if nearer * nearer > largest else largest


@elementwise
def raise_approaches(best, low, high, what, behind, ahead, axis):
    """Raise ``best`` to the squares of how far boxes have come nearer, or of how fast they do, to
    those of a line ``ahead`` of theirs along an axis."""
    along, own = np.uint64(axis), np.uint64(MARGIN)
    for n in range(np.uint64(len(best))):
        first = low[what, ahead, along, n]
        for b in range(np.uint64(1), np.uint64(2 * MARGIN + 1)):
            one = low[what, ahead, along, n + b]
            first = one if one < first else first
        nearer = high[what, behind, along, n + own] - first
        nearer = nearer if nearer > 0.0 else 0.0
        best[n] = nearer * nearer if nearer * nearer > best[n] else best[n]


@elementwise
def raise_reaches(best, low, high, line):
    """Raise ``best`` to the squares of the longest displacements in the boxes of a line."""
    for n in range(np.uint64(len(best))):
        total = 0.0
        for d in range(np.uint64(AXES)):
            up = high[MOVED, line, d, n + np.uint64(MARGIN)]
            down = -low[MOVED, line, d, n + np.uint64(MARGIN)]
            longest = up if up > down else down
            longest = longest if longest > 0.0 else 0.0
            total += longest * longest
        best[n] = total if total > best[n] else best[n]
