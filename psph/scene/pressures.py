"""Between which pressures a fluid starts."""

import numpy as np


def range_of_pressure(scene, fluid: int) -> tuple[float, float]:
    """The lowest and the highest pressure of a fluid at the start, Pa."""
    start = scene.starts[fluid]
    if start.layer:
        return start.pressure, start.layer.highest
    if not start.exact:
        return start.pressure, start.pressure
    found = []
    for first, last in scene.lattice.chunks():
        held = scene.layout.materials(first, last) == fluid
        grid = scene.lattice.grid(first, last)
        found.append(np.stack([np.broadcast_to(x, held.shape)[held] for x in grid], axis=1))
    pressure = start.exact(np.concatenate(found))
    return float(pressure.min()), float(pressure.max())


def starting_fullness(scene) -> tuple[float, float]:
    """Smallest and largest m/(ρ dx^d) of a fluid at the start, with 1 among them.

    Equal masses do not fill the lattice where the pressure differs from place to place.
    """
    filled = [1.0]
    for fluid in range(scene.layout.fluids):
        start, mass = scene.starts[fluid], scene.species[fluid].mass
        for pressure in range_of_pressure(scene, fluid):
            rho = start.law.density(np.float64(pressure), start.rest_density, start.sound_speed)
            filled.append(mass / scene.spacing**scene.dimensions / float(rho))
    return min(filled), max(filled)
