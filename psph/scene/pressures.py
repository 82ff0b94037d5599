"""Between which pressures a fluid starts."""

import numpy as np


def range_of_pressure(scene, fluid: int) -> tuple[float, float]:
    """The lowest and the highest pressure of a fluid at the start, Pa."""
    start = scene.starts[fluid]
    if not start.exact:
        return start.pressure, start.pressure
    found = []
    for first, last in scene.lattice.chunks():
        held = scene.layout.materials(first, last) == fluid
        grid = scene.lattice.grid(first, last)
        found.append(np.stack([np.broadcast_to(x, held.shape)[held] for x in grid], axis=1))
    pressure = start.exact(np.concatenate(found))
    return float(pressure.min()), float(pressure.max())
