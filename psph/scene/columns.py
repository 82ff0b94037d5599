"""The lattice seen in columns along gravity: what stands over what."""

from collections.abc import Sequence

import numpy as np

from psph.scene.layout import Layout


def columns(layout: Layout, axis: int) -> np.ndarray:
    """Material of each site of the lattice, uint8, in the order x, y, z but for ``axis``, which is last."""
    lattice = layout.lattice
    held = np.concatenate([layout.materials(*chunk) for chunk in lattice.chunks()])
    return held.transpose([lattice.axes.index(d) for d in order_of(layout.dimensions, axis)])


def order_of(dimensions: int, axis: int) -> list[int]:
    """The axes in their order, ``axis`` last."""
    return [*(d for d in range(dimensions) if d != axis), axis]


def connected(masks: Sequence[np.ndarray], around: Sequence[int]) -> np.ndarray:
    """Numbers from 1 on of the connected parts of some masks, int32; 0 where none of them is True.

    Sites of one mask that share a face are connected, across the ends of the axes ``around`` too.
    """
    from scipy.ndimage import label  # late: most scenes do without
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    part = np.zeros(masks[0].shape, np.int32)
    count = 0
    for mask in masks:
        found, more = label(mask)
        part += np.where(mask, found + count, 0).astype(np.int32)
        count += more
    pairs = [np.empty((2, 0), int)]
    for axis in around:
        ends = [(part.take(end, axis), [mask.take(end, axis) for mask in masks]) for end in (0, -1)]
        for low, high in zip(ends[0][1], ends[1][1]):
            both = low & high
            pairs.append(np.array([ends[0][0][both], ends[1][0][both]]))
    joined = np.concatenate(pairs, axis=1)
    if not joined.size:
        return part
    links = coo_array((np.ones(joined.shape[1]), joined), shape=(count + 1, count + 1))
    numbers = connected_components(links, directed=False)[1]
    return numbers[part].astype(np.int32) - numbers[0]
