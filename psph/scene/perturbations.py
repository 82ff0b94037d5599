"""Which particles are kicked or shifted, and by how much."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from psph.scene.layout import Layout
from psph.scene.parts.order import among


def kicks_of(layout: Layout) -> dict[tuple[int, int], np.ndarray]:
    """For the particle at (plane, place in the plane) what is added to its velocity, m/s, and to its
    position, m (2, dim)."""
    kicks: dict[tuple[int, int], np.ndarray] = {}
    for kick in layout.case.perturbations:
        site = _nearest_site(layout, kick.position)
        kicks[site] = kicks.get(site, 0.0) + np.array([kick.velocity, kick.shift])
    return kicks


def kicked_velocities(
    layout: Layout, kicks: dict[tuple[int, int], np.ndarray], velocities: Sequence[tuple[float, ...]]
) -> Iterator[np.ndarray]:
    """Velocities (dim,) of the particles that got a kick, m/s; ``velocities`` are those of the parts."""
    for (plane, place), (kick, _) in kicks.items():
        part = layout.materials(plane, plane + 1).ravel()[place]
        yield kick + np.array(velocities[part])


def _nearest_site(layout: Layout, point: tuple[float, ...]) -> tuple[int, int]:
    """(plane, place in the plane) of the site of fluid or solid nearest to ``point``; ties: the first."""
    grid = layout.lattice.grid(0, layout.planes)
    squares = [_squares(layout, d, x, point[d]) for d, x in enumerate(grid)]
    along = squares[layout.axis].ravel()
    best = (math.inf, -1, -1)
    for plane in np.argsort(along, kind="stable").tolist():
        if along[plane] > best[0]:
            break
        squares[layout.axis] = along[plane : plane + 1].reshape(grid[layout.axis][:1].shape)
        fluid = among(layout.materials(plane, plane + 1), layout.parts.movers)
        distance = np.where(fluid, sum(squares), math.inf).ravel()
        place = int(distance.argmin())
        best = min(best, (float(distance[place]), plane, place))
    return best[1:]


def _squares(layout: Layout, d: int, x: np.ndarray, to: float) -> np.ndarray:
    """Squared distances along an axis in spacings, rounded so that ties are ties."""
    away = x - to
    if layout.periods[d] is not None:
        away -= layout.periods[d] * np.rint(away / layout.periods[d])
    return np.round((away / layout.spacing) ** 2, 6)
