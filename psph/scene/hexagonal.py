"""Sites of the closest packing: triangles in 2D, in 3D layers of these in each other's hollows (hcp)."""

import math
from typing import Any

import numpy as np

from psph.scene.lattice import SITES_AT_ONCE
from psph.scene.shapes import bounds

NEAREST = {2: (2.0 / math.sqrt(3.0)) ** 0.5, 3: 2.0 ** (1.0 / 6.0)}
"""Distance of neighbours where each has a volume of 1."""

RISE = (1.0, math.sqrt(0.75), math.sqrt(2.0 / 3.0))
"""Steps along x in a row, from row to row along y, and from layer to layer along z, over that distance."""

REPEAT = (1, 2, 2)
"""After how many of these steps all is the same."""


def steps_of(layout: Any, spacing: float) -> np.ndarray:
    """The steps along each axis, m, where a particle has the volume ``spacing``^d, m^d: in periods a whole
    number of repeats, so that volumes differ a little from that."""
    found = []
    for rise, repeat, period in zip(RISE, REPEAT, layout.periods):
        step = rise * NEAREST[layout.dimensions] * spacing
        if period is not None:
            step = period / (repeat * max(1, round(period / (repeat * step))))
        found.append(step)
    return np.array(found)


def sites_of(layout: Any, number: int, spacing: float) -> np.ndarray:
    """The sites of a part of a layout (n, dim), m, of the volume ``spacing``^d; in periods they are seamless,
    elsewhere they begin at the origin of the lattice."""
    steps = steps_of(layout, spacing)
    begin = [
        o if p is None else low for o, p, low in zip(layout.case.space.origin, layout.periods, layout.lower)
    ]
    counted = []
    for low, up, first, step in zip(*bounds(layout.parts[number].shape), begin, steps):
        counted.append(np.arange(math.floor((low - first) / step) - 1, math.ceil((up - first) / step) + 1))
    if layout.dimensions == 2:
        counted.append(np.zeros(1, int))
    *plane, last = counted
    whole = max(1, SITES_AT_ONCE // math.prod(map(len, plane)))
    found = []
    for some in np.array_split(last, math.ceil(len(last) / whole)):
        i, j, k = (one.ravel() for one in np.meshgrid(*plane, some, indexing="ij"))
        places = [i + 0.25 + 0.5 * ((j + k) % 2), j + (1.0 + k % 2) / 3.0, k + 0.5]
        if layout.dimensions == 2:
            places = [places[0], j + 0.5]
        x = np.stack(places, axis=1) * steps + begin
        for d, period in enumerate(layout.periods):
            if period is not None:
                x = x[(x[:, d] >= layout.lower[d]) & (x[:, d] < layout.upper[d])]
        found.append(x[layout.holds(number, x)])
    return np.concatenate(found)
