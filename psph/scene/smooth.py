"""The drawn faces of walls along which soils and updated Lagrangian solids slide."""

from collections.abc import Sequence
from itertools import product

import numpy as np

from psph.fields import WALL
from psph.physics.stress.faces import is_smooth
from psph.scene.distance import nearest_faces
from psph.scene.scene import Scene

HALVINGS = 12
"""Of the way out of a wall, until its face is known."""

DIGITS = 9
"""To which heights are alike, in spacings."""


def smooth_faces(scene: Scene, species: np.ndarray, position: np.ndarray) -> np.ndarray:
    """Of particles of these ``species`` (n,) that begin at ``position`` (n, dim) the unit normals (n, dim) of
    the faces before them, in walls without friction, and zeros in all else.

    That face is the one that the way to the nearest site outside of all walls that move alike goes through:
    where walls touch, and at the ends of a period, there is none.  Of several as near the lowest counts, and
    of the faces at a corner the lower one: so they turn as the scene does.
    """
    normal, walls = np.zeros_like(position), {n for n, one in enumerate(scene.species) if one.kind == WALL}
    for motion in {scene.species[n].motion for n in walls}:
        alike = sorted(n for n in walls if scene.species[n].motion == motion)
        smooth = [n for n in alike if is_smooth(scene.species[n])]
        rows = np.flatnonzero(np.isin(species, smooth))
        if len(rows):
            normal[rows] = _before(scene, alike, position[rows])
    return normal


def _before(scene: Scene, alike: Sequence[int], place: np.ndarray) -> np.ndarray:
    """The normals (n, dim) of the faces before particles at ``place`` (n, dim) of the walls ``alike``."""
    shapes = [scene.layout.parts[n].shape for n in alike]
    way = _way_out(scene, alike, place)
    inner, outer = np.zeros((len(place), 1)), np.ones((len(place), 1))
    for _ in range(HALVINGS):
        middle = 0.5 * (inner + outer)
        within = nearest_faces(shapes, place + middle * way).away[:, None] <= 0.0
        inner, outer = np.where(within, middle, inner), np.where(within, outer, middle)
    lower = np.abs(way).max(initial=0.0) * 0.5**HALVINGS * np.array(scene.layout.up)
    return nearest_faces(shapes, place + outer * way - lower).normal


def _way_out(scene: Scene, alike: Sequence[int], place: np.ndarray) -> np.ndarray:
    """From each of ``place`` (n, dim) to the nearest site without a wall ``alike`` within reach, m: the
    lowest of several; zeros where there is none."""
    most = scene.layout.wall_reach
    offsets = np.array(list(product(range(-most, most + 1), repeat=scene.dimensions)))
    length, height = (offsets**2).sum(axis=1), np.round(offsets @ np.array(scene.layout.up), DIGITS)
    order = np.lexsort((height, length))
    way, left = np.zeros_like(place), np.arange(len(place))
    for offset in offsets[order[length[order] <= most**2]]:
        sites = place[left] + scene.spacing * offset
        grid = [scene.layout.folded(d, x.copy()) for d, x in enumerate(sites.T)]
        free = ~np.isin(scene.layout.held(grid, grid[0].shape), alike)
        way[left[free]] = scene.spacing * offset
        left = left[~free]
        if not len(left):
            break
    return way
