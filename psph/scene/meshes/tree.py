"""Boxes around triangles, and boxes around these: what lies far from a point is left out at once."""

from typing import NamedTuple

import numpy as np

LEAF = 4
"""Triangles in the smallest boxes."""

BITS = 21
"""Of each coordinate in a place along the curve: three of them in 63 bits."""


class Tree(NamedTuple):
    """A full binary tree of boxes: ``boxes`` (2 m, 6), the lower and upper corner of each.

    Box 1 is the root, boxes 2k and 2k + 1 lie in box k; box m + j holds the triangles ``LEAF`` j to LEAF (j
    + 1) − 1 in ``order``.  A box that holds nothing goes from infinity to minus infinity.
    """

    order: np.ndarray
    boxes: np.ndarray


def tree_of(corners: np.ndarray, axes: int = 3) -> Tree:
    """The tree of triangles (n, 3, 3), sorted along a curve that keeps near ones together (Morton 1966).

    Near by the first ``axes`` of their coordinates.
    """
    low, high = corners.min(axis=1), corners.max(axis=1)
    order = np.argsort(_along_curve(0.5 * (low + high)[:, :axes]), kind="stable")
    leaves = 1 << (-(-len(corners) // LEAF) - 1).bit_length()
    boxes = np.empty((2 * leaves, 6))
    boxes[:, :3], boxes[:, 3:] = np.inf, -np.inf
    sides = (slice(0, 3), low, np.min, np.inf), (slice(3, 6), high, np.max, -np.inf)
    for columns, ends, join, nothing in sides:
        padded = np.full((leaves * LEAF, 3), nothing)
        padded[: len(ends)] = ends[order]
        level = join(padded.reshape(leaves, LEAF, 3), axis=1)
        while len(level):
            boxes[len(level) : 2 * len(level), columns] = level
            level = join(level.reshape(-1, 2, 3), axis=1) if len(level) > 1 else level[:0]
    return Tree(order, boxes)


def _along_curve(points: np.ndarray) -> np.ndarray:
    """Places (n,) of points (n, 2 or 3) along a curve through their box: bits of coordinates in turn."""
    low, high = points.min(axis=0), points.max(axis=0)
    width = np.where(high > low, high - low, 1.0)
    steps = ((points - low) / width * (2**BITS - 1)).astype(np.int64)
    place = np.zeros(len(points), np.int64)
    for bit in range(BITS):
        for axis in range(points.shape[1]):
            place |= (steps[:, axis] >> bit & 1) << (points.shape[1] * bit + axis)
    return place
