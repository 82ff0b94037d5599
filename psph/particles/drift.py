"""How far particles have moved against each other since the lists were made."""

import numpy as np

from psph.jit import compiled

LOW, HIGH = -1e300, 1e300
"""No number of a particle lies outside."""


@compiled
def bounding_boxes(data, position, listed, velocity, starts, planes, counts, reach):
    """Ranges of displacement and velocity in blocks of cells about as wide as the cutoff.

    ``position``, ``listed`` and ``velocity`` are rows of ``data``, one a dimension; the other
    arguments as in psph.particles.neighbours.  Returns (lines, blocks, dim, 4): lowest and highest
    x − x_listed, lowest and highest v of each block of each line of cells, ghosts included; an
    empty block has its lowest above its highest.
    """
    columns = counts[2]
    wide = max(reach, 1)
    blocks = max(columns // wide, 1)
    lines = (planes + 2) * counts[1]
    boxes = np.empty((lines, blocks, len(position), 4))
    for line in range(lines):
        for block in range(blocks):
            end = columns if block == blocks - 1 else (block + 1) * wide
            first = np.uint64(starts[line * columns + block * wide])
            last = np.uint64(starts[line * columns + end])
            for d in range(len(position)):
                low, high, v_low, v_high = HIGH, LOW, HIGH, LOW
                for k in range(first, last):
                    moved = data[position[d], k] - data[listed[d], k]
                    v = data[velocity[d], k]
                    low, high = min(low, moved), max(high, moved)
                    v_low, v_high = min(v_low, v), max(v_high, v)
                boxes[line, block, d, 0], boxes[line, block, d, 1] = low, high
                boxes[line, block, d, 2], boxes[line, block, d, 3] = v_low, v_high
    return boxes


@compiled
def largest_differences(boxes, planes, rows, axes, periodic):
    """Bounds over all pairs that matter: |Δ(x − x_listed)|² and |Δv|²; and the largest
    |x − x_listed|².

    A list reaches no farther than the next block: ranges of neighbouring blocks bound every pair
    in it.  Particles that move together stay neighbours, however fast they are.  Of pairs with one
    block between them, a cutoff wide at the least, none is listed: they count by how far they have
    come nearer across it.  ``axes``: those of planes, of rows and of columns.
    """
    blocks = boxes.shape[1]
    apart2 = closing2 = drifted2 = 0.0
    for line in range(len(boxes)):
        plane, row = divmod(line, rows)
        for block in range(blocks):
            own = boxes[line, block]
            if own[0, 0] > own[0, 1]:
                continue
            drifted2 = max(drifted2, reach2(own))
            # Half of the blocks around, and itself: the others look here.
            for p in range(plane, min(plane + 3, planes + 2)):
                for r in range(row - 2 if p > plane else row, row + 3):
                    if not (0 <= r < rows or periodic[1]):
                        continue
                    for b in range(block - 2, block + 3):
                        if not (0 <= b < blocks or periodic[2]):
                            continue
                        other = boxes[p * rows + r % rows, b % blocks]
                        if other[0, 0] > other[0, 1]:
                            continue
                        if p - plane == 2:
                            moved2, fast2 = approaches2(own, other, axes[0])
                        elif r - row == 2:
                            moved2, fast2 = approaches2(own, other, axes[1])
                        elif row - r == 2:
                            moved2, fast2 = approaches2(other, own, axes[1])
                        elif b - block == 2:
                            moved2, fast2 = approaches2(own, other, axes[2])
                        elif block - b == 2:
                            moved2, fast2 = approaches2(other, own, axes[2])
                        else:
                            moved2, fast2 = span2(own, other, 0), span2(own, other, 2)
                        apart2, closing2 = max(apart2, moved2), max(closing2, fast2)
    return apart2, closing2, drifted2


@compiled
def approaches2(a, b, d):
    """Squares of how far box ``a`` may have come nearer to box ``b``, ahead along axis ``d``, and
    of how fast it does."""
    moved, fast = max(a[d, 1] - b[d, 0], 0.0), max(a[d, 3] - b[d, 2], 0.0)
    return moved * moved, fast * fast


@compiled
def span2(a, b, first):
    """Square of the longest vector between a point of box ``a`` and one of box ``b``."""
    total = 0.0
    for d in range(len(a)):
        longest = max(a[d, first + 1] - b[d, first], b[d, first + 1] - a[d, first])
        total += longest * longest
    return total


@compiled
def reach2(a):
    """Square of the longest displacement in box ``a``."""
    total = 0.0
    for d in range(len(a)):
        longest = max(a[d, 1], -a[d, 0])
        total += longest * longest
    return total
