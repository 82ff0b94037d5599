"""How far particles of many sizes have moved against each other since lists were made, over their sizes."""

import numpy as np

from psph.engine.jit import elementwise
from psph.particles.drift import AXES, MARGIN, MOVED, bounding_boxes

FARTHEST = 2
"""Blocks apart at which particles count still: as in psph.particles.drift, none comes from farther."""


def shares_moved(data, rows, length, starts, planes, grid) -> tuple[np.ndarray, float]:
    """Bounds on |Δ(x − x_listed)| over the larger h of a pair: for each column of pairs with those in its
    block or the next ones; and the largest of pairs with a block between them, of which some rank sees each.

    ``rows`` are those of position, of listed position and of any vector in ``data``; ``length`` (columns,)
    the h by which lists were made, m; ``starts`` the first columns of cells, as in psph.particles.neighbours.
    """
    low, high = bounding_boxes(data, *rows, starts, planes, grid.counts, grid.reach, grid.periodic)
    blocks, wide = low.shape[3] - 2 * MARGIN, max(grid.reach, 1)
    margins = np.r_[:MARGIN, blocks + MARGIN : blocks + 2 * MARGIN]
    images = (margins - MARGIN) % blocks + MARGIN
    size = np.full((low.shape[1], low.shape[3]), np.inf)
    share2, found = np.zeros_like(size), np.zeros(len(length))
    fill_sizes(length, starts, grid.counts[2], wide, blocks, size)
    if grid.periodic[2]:
        size[:, margins] = size[:, images]
    axes = np.array(grid.of_counts, np.int64)
    across2 = compare_by_size(low, high, size, planes, grid.counts[1], axes, grid.periodic[1], share2)
    if grid.periodic[2]:
        for n, image in zip(margins, images):
            share2[:, image] = np.maximum(share2[:, image], share2[:, n])
    tell_columns(np.sqrt(share2), starts, grid.counts[2], wide, blocks, found)
    return found, float(np.sqrt(across2))


@elementwise
def stray(first, last, position, listed, length, drift, support, low, share):
    """How far the columns ``first`` to ``last`` are from where they were ``listed``, as a ``share`` (owned,)
    of their support, so many times their ``length``, less the ``drift`` (dim,) m of all.  Owned ones begin at
    ``low``; without room for shares, None, they are not told.

    Returns the largest square of such a way, drift and all, m², and the largest share; infinite where one is
    not a number.
    """
    apart2_max, most2 = 0.0, 0.0
    for k in range(np.uint64(first), np.uint64(last)):
        apart2, strayed2, reach = 0.0, 0.0, support * length[k]
        for d in range(len(position)):
            way = position[d][k] - listed[d][k]
            apart2 += way**2
            strayed2 += (way - drift[d]) ** 2
        own2 = strayed2 / reach**2
        if share is not None:
            share[k - np.uint64(low)] = np.sqrt(own2)
        apart2_max, most2 = max(apart2_max, apart2), max(most2, own2 if own2 < np.inf else np.inf)
    return apart2_max, np.sqrt(most2)


@elementwise
def tell_columns(share, starts, columns, wide, blocks, found):
    """Write the ``share`` of each block to its columns."""
    for line in range(len(share)):
        for block in range(blocks):
            end = columns if block == blocks - 1 else (block + 1) * wide
            for k in range(starts[line * columns + block * wide], starts[line * columns + end]):
                found[k] = share[line, block + MARGIN]


@elementwise
def fill_sizes(length, starts, columns, wide, blocks, size):
    """The smallest h of each block, m."""
    for line in range(len(size)):
        for block in range(blocks):
            end = columns if block == blocks - 1 else (block + 1) * wide
            least = np.inf
            for k in range(starts[line * columns + block * wide], starts[line * columns + end]):
                least = min(least, length[k])
            size[line, block + MARGIN] = least


@elementwise
def compare_by_size(low, high, size, planes, rows, axes, goes_round, share2):
    """Raise ``share2`` to the square of that bound for each block, by the longest vector between points of
    its box and those side by side; the largest square of blocks with one between them, by how far they have
    come nearer across it."""
    across2, blocks = 0.0, low.shape[3] - 2 * MARGIN
    for line in range(low.shape[1]):
        plane, row = divmod(line, rows)
        for p in range(plane, min(plane + FARTHEST, planes + 1) + 1):
            for r in range(row - FARTHEST, row + FARTHEST + 1):
                if not (0 <= r < rows or goes_round):
                    continue
                other = p * rows + r % rows
                for n in range(MARGIN, blocks + MARGIN):
                    for b in range(n - FARTHEST, n + FARTHEST + 1):
                        larger = max(size[line, n], size[other, b])
                        apart = p - plane, r - row, b - n
                        far, nearer = -1, 0.0
                        for one in range(AXES):
                            far = one if abs(apart[one]) == FARTHEST else far
                        if far < 0:
                            found = longest2(low, high, line, n, other, b) / (larger * larger)
                            share2[line, n] = max(share2[line, n], found)
                            share2[other, b] = max(share2[other, b], found)
                            continue
                        d = axes[far]
                        if apart[far] > 0:
                            nearer = high[MOVED, line, d, n] - low[MOVED, other, d, b]
                        else:
                            nearer = high[MOVED, other, d, b] - low[MOVED, line, d, n]
                        across2 = max(across2, (max(nearer, 0.0) / larger) ** 2)
    return across2


@elementwise
def longest2(low, high, line, n, other, b):
    """The square of the longest vector between points of two boxes, 0 beside an empty one, m²."""
    total = 0.0
    for d in range(AXES):
        one = high[MOVED, line, d, n] - low[MOVED, other, d, b]
        reverse = high[MOVED, other, d, b] - low[MOVED, line, d, n]
        longest = max(max(one, reverse), 0.0)
        total += longest * longest
    return total
