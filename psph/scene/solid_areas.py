"""The faces of elastic solids that a pressure pushes: by the sites of the lattice that nothing fills."""

import numpy as np

from psph.scene.lattice import TOLERANCE
from psph.scene.layout import Layout
from psph.scene.shapes import inside


def faced(layout: Layout, number: int, load, position: np.ndarray) -> np.ndarray:
    """The area vectors, outwards, of the particles of a solid at ``position`` (n, dim), m, which a ``load``
    of pressure pushes: m² (n, dim), in 2D per metre of depth; zeros for those that its shape leaves out.

    A particle has a face of dx^{d−1} towards each neighbouring site that its solid, of the part ``number``,
    does not fill, if that way is on the side that the load is ``facing``.  The steps of such a surface have
    together the area vector of the one that is drawn: over a closed one they add up to zero.
    """
    part = layout.parts[number]
    own = layout.spacing / part.finer
    picked = inside(load.shape, [*position.T], TOLERANCE * layout.spacing)
    area, low = np.zeros_like(position), np.array(layout.lattice.lower)
    for d in range(layout.dimensions):
        for way in (-1.0, 1.0):
            if load.facing is not None and way * load.facing[d] <= 0.0:
                continue
            beside = position[picked]
            beside[:, d] += way * own
            site = low + (np.floor((beside - low) / layout.spacing) + 0.5) * layout.spacing
            filled = [layout.holds(one, site) for one in layout.parts.of_whole(number)]
            area[picked, d] += np.where(np.any(filled, axis=0), 0.0, way * own ** (layout.dimensions - 1))
    return area
