"""Which particle a kick or a shift is meant for."""

import math

import numpy as np


def nearest_fluid_site(scene, point: tuple[float, ...]) -> tuple[int, int]:
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
