"""Which particles are kicked or shifted, and by how much."""

import math
from collections.abc import Iterator

import numpy as np


def kicks_of(scene) -> dict[tuple[int, int], np.ndarray]:
    """For the particle at (plane, place in the plane) what is added to its velocity, m/s, and to its
    position, m (2, dim)."""
    kicks: dict[tuple[int, int], np.ndarray] = {}
    for kick in scene.case.perturbations:
        site = _nearest_site(scene, kick.position)
        kicks[site] = kicks.get(site, 0.0) + np.array([kick.velocity, kick.shift])
    return kicks


def kicked_velocities(scene) -> Iterator[np.ndarray]:
    """Velocities (dim,) of the particles that got a kick, m/s."""
    for (plane, place), (kick, _) in scene.kicks.items():
        material = scene.layout.materials(plane, plane + 1).ravel()[place]
        yield kick + np.array(scene.velocities[material])


def _nearest_site(scene, point: tuple[float, ...]) -> tuple[int, int]:
    """(plane, place in the plane) of the site of fluid or solid nearest to ``point``; ties: the first."""
    grid = scene.lattice.grid(0, scene.planes)
    squares = [_squares(scene, d, x, point[d]) for d, x in enumerate(grid)]
    along = squares[scene.axis].ravel()
    best = (math.inf, -1, -1)
    for plane in np.argsort(along, kind="stable").tolist():
        if along[plane] > best[0]:
            break
        squares[scene.axis] = along[plane : plane + 1].reshape(grid[scene.axis][:1].shape)
        fluid = scene.layout.materials(plane, plane + 1) < scene.layout.movers
        distance = np.where(fluid, sum(squares), math.inf).ravel()
        place = int(distance.argmin())
        best = min(best, (float(distance[place]), plane, place))
    return best[1:]


def _squares(scene, d: int, x: np.ndarray, to: float) -> np.ndarray:
    """Squared distances along an axis in spacings, rounded so that ties are ties."""
    away = x - to
    if scene.periods[d] is not None:
        away -= scene.periods[d] * np.rint(away / scene.periods[d])
    return np.round((away / scene.spacing) ** 2, 6)
