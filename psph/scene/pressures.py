"""Between which pressures a fluid starts."""

import math

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


def weight_above(scene, fluid: int, gravity, census) -> float:
    """Pressure of the still fluids that rest on this one, Pa, where ``gravity`` (dim,) m/s² is oblique to the
    axes: those that begin where it ends, or higher, over some of its ground.

    ``census`` has their ends against this gravity.  Where layers that are drawn along a slope meet, these are
    within half a spacing of the slope: the steps of the lattice fit into each other.
    """
    total, pull = 0.0, math.hypot(*gravity)
    level = [d for d, g in enumerate(gravity) if abs(g) < 0.5 * pull]
    for other in range(scene.layout.fluids):
        apart = (census.lowest[other] > census.highest[fluid]) | (
            census.highest[other] < census.lowest[fluid]
        )
        bottom = float(census.bottom[other])
        higher = bottom > float(census.top[fluid]) - 0.5 * scene.spacing and other != fluid
        if higher and not apart[level].any() and scene.parts[other].pressure == "hydrostatic":
            total += scene.parts[other].density * pull * (float(census.top[other]) - bottom)
    return total
