"""The drawn faces of walls along which soils and updated Lagrangian solids slide."""

from collections.abc import Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from psph.case.keys import AXES
from psph.fields import WALL
from psph.physics.stress.faces import is_smooth
from psph.scene.distance import nearest_faces
from psph.scene.scene import Scene

HALVINGS = 12
"""Of the way out of a wall, until its face is known."""

LEAST = 0.1
"""Eigenvalue of the mean n nᵀ of faces over its largest from which on they are several: faces that meet at
more than 35°."""


class SmoothFaces(NamedTuple):
    """What psph.physics.stress.faces calls ``normal`` and ``side`` (n, dim) and ``edge`` (n,)."""

    normal: np.ndarray
    side: np.ndarray
    edge: np.ndarray


def smooth_faces(scene: Scene, species: np.ndarray, position: np.ndarray) -> SmoothFaces:
    """The faces before particles of these ``species`` (n,) that begin at ``position`` (n, dim), in walls
    without friction; zeros in all else.

    That face is the one that the way to the nearest site outside of all walls that move alike goes through:
    where walls touch, and at the ends of a period, there is none.  Of as near ones none is chosen, so that
    they turn as the scene does: where two ways go through two faces, both are known by the mean of their
    normals and half their difference; one way through several faces ends in a hollow; what else there is, is
    round.
    """
    found = SmoothFaces(np.zeros_like(position), np.zeros_like(position), np.zeros(len(position)))
    walls = {n for n, one in enumerate(scene.species) if one.kind == WALL}
    for motion in {scene.species[n].motion for n in walls}:
        alike = sorted(n for n in walls if scene.species[n].motion == motion)
        smooth = [n for n in alike if is_smooth(scene.species[n])]
        rows = np.flatnonzero(np.isin(species, smooth))
        if len(rows):
            for whole, part in zip(found, _before(scene, alike, position[rows])):
                whole[rows] = part
    return found


def _before(scene: Scene, alike: Sequence[int], place: np.ndarray) -> SmoothFaces:
    """Those of particles at ``place`` (n, dim) of the walls ``alike``."""
    rows, way = _ways_out(scene, alike, place)
    shapes, start = [scene.layout.parts[n].shape for n in alike], place[rows]
    inner, outer = np.zeros((len(way), 1)), np.ones((len(way), 1))
    for _ in range(HALVINGS):
        middle = 0.5 * (inner + outer)
        within = nearest_faces(shapes, start + middle * way).away[:, None] <= 0.0
        inner, outer = np.where(within, middle, inner), np.where(within, outer, middle)
    # Each way by its own length: what else a rank has is not to count.
    aside, unit = 0.5**HALVINGS * np.abs(way).max(axis=1, keepdims=True), np.eye(scene.dimensions)
    faces = [nearest_faces(shapes, start + outer * way + aside * one).normal for one in (*unit, *-unit)]
    tensor, mean, other = np.zeros((len(place), *unit.shape)), np.zeros_like(place), np.zeros_like(place)
    np.add.at(tensor, rows, sum(n[:, :, None] * n[:, None] for n in faces))
    np.add.at(mean, rows, 0.5 * sum(faces) / len(faces))
    other[rows] = sum(faces) / len(faces)  # of the last way of each
    size, axes = np.linalg.eigh(tensor)
    spanned = (size > LEAST * np.maximum(size[:, -1:], np.finfo(float).tiny)).sum(axis=1)
    ways = np.bincount(rows, minlength=len(place))
    both, several = (spanned > 1) & (ways == 2), (spanned > 1) & (ways != 2)
    along = (axes[:, :, 0] if scene.dimensions == len(AXES) else 0.0 * place) * (spanned == 2)[:, None]
    normal = np.select(
        [(spanned == 1)[:, None], both[:, None], several[:, None]], [axes[:, :, -1], mean, along]
    )
    side = np.where(both[:, None], other - mean, 0.0)
    return SmoothFaces(normal, side, np.where(several, np.where(ways == 1, 1.0, -1.0), 0.0))


def _ways_out(scene: Scene, alike: Sequence[int], place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Whose (m,), and the ways (m, dim), m, from ``place`` (n, dim) to the nearest sites without a wall
    ``alike``: of several as near all, and none where there is none within reach."""
    most = scene.layout.wall_reach
    offsets = np.array(list(product(range(-most, most + 1), repeat=scene.dimensions)))
    length, left = (offsets**2).sum(axis=1), np.arange(len(place))
    rows, ways = [left[:0]], [place[:0]]
    for size in np.unique(length[length <= most**2]):
        reached = np.zeros(len(place), bool)
        for offset in offsets[length == size]:
            sites = place[left] + scene.spacing * offset
            grid = [scene.layout.folded(d, x.copy()) for d, x in enumerate(sites.T)]
            free = left[~np.isin(scene.layout.held(grid, grid[0].shape), alike)]
            rows.append(free)
            ways.append(np.tile(scene.spacing * offset, (len(free), 1)))
            reached[free] = True
        left = left[~reached[left]]
        if not len(left):
            break
    return np.concatenate(rows), np.concatenate(ways)
