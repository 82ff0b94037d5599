"""What two parts of walls that lie in one plane bear along it, at the seam between them."""

from itertools import product
from typing import NamedTuple

import numpy as np

MOST = 16
"""BareFaces, the nearest ones to the next site, among which one that goes on is looked for."""

ALIKE = 0.99
"""Cosine of the angle between two normals from which two faces look in one direction."""

BESIDE = 0.7
"""Spacings from the next site of a face within which a face of another part goes on with it."""

AT_SITE = 0.3
"""Spacings from a site below a face within which a particle is in that row."""


class Particles(NamedTuple):
    """``ids`` (n,) and ``places`` (n, dim), m, of the particles of walls that meet."""

    ids: np.ndarray
    places: np.ndarray


class BareFaces(NamedTuple):
    """Middles (n, dim), m, outward normals (n, dim) and ``groups`` (n,) of faces."""

    middle: np.ndarray
    normal: np.ndarray
    groups: np.ndarray


class Seams(NamedTuple):
    """What passes between parts at their seams, by the ``ids`` (n,) of the particles whose loads tell it.

    By a particle with the load f, N, the ``takers`` (n,) win (−f·n) a and the ``givers`` (n,) lose it: n the
    ``normal`` (n, dim) of its face, a ``along`` (n, dim) it from taker to giver, as long as the share is.
    """

    ids: np.ndarray
    takers: np.ndarray
    givers: np.ndarray
    normal: np.ndarray
    along: np.ndarray

    def won(self, ids: np.ndarray, force: np.ndarray, groups) -> tuple[np.ndarray, np.ndarray]:
        """Rows among particles with these ``ids``, in order, and loads ``force`` (n, dim), N, and what
        ``groups`` win by each, N."""
        side = np.isin(self.takers, groups).astype(float) - np.isin(self.givers, groups)
        row = np.searchsorted(ids, self.ids) % max(len(ids), 1)
        told = np.flatnonzero((ids[row] == self.ids) & (side != 0.0)) if len(ids) else row[:0]
        pressing = -(force[row[told]] * self.normal[told]).sum(axis=1)
        return row[told], (side[told] * pressing)[:, None] * self.along[told]


def seams_of(space, spacing: float, shares, particles: Particles, faces: BareFaces, axes, touch) -> Seams:
    """The seams of ``particles`` between ``faces`` of parts that ``touch`` (groups, groups), whose lattices
    have the ``axes`` (groups, dim, dim) in columns.

    A wall's particle on one side of a seam and fluid on the other side push each other apart along the plane,
    and nothing that faces the same part holds against it.  So each part misses by about p dx/4 for each metre
    of the seam, both together by nothing.  It is a part of what presses the faces beside the seam:
    ``shares`` of it, by the number of rows below that are counted (:func:`psph.moments.seam_shares`).
    """
    frames, joints = axes[faces.groups], []
    for axis, way in product(range(axes.shape[1]), (-1.0, 1.0)):
        joints.append(_joints(space, spacing, faces, way * frames[:, :, axis], touch))
    takers, givers, along = (np.concatenate(part) for part in zip(*joints))
    told = []
    for beside in (takers, givers):
        below, rows = _below(space, spacing, particles.places, faces, beside, len(shares))
        # The upper half of them: behind a thin wall there may be fluid too.
        counted = (rows + 1) // 2
        for row, particle in enumerate(below):
            k = np.flatnonzero(row < counted)
            part = 0.5 * shares[counted[k] - 1, None] * along[k]
            sides = faces.groups[takers[k]], faces.groups[givers[k]]
            told.append((particles.ids[particle[k]], *sides, faces.normal[beside[k]], part))
    return Seams(*(np.concatenate(part) for part in zip(*told)))


def _joints(space, spacing, faces: BareFaces, along, touch):
    """The faces at which another part goes on, those of that part, and the directions ``along`` (n, dim) to
    these; each seam once."""
    middle, normal, groups = faces
    level = np.flatnonzero(np.abs((normal * along).sum(axis=1)) < 0.5)
    if not len(level):
        return level, level, along[level]
    site = space.wrapped(middle[level] + spacing * along[level])
    distance, near = space.nearest(site, middle, MOST, BESIDE * spacing)
    near = np.where(np.isfinite(distance), near, 0)
    alike = (normal[level, None] * normal[near]).sum(axis=2) > ALIKE
    distance = np.where(alike, distance, np.inf)
    best = distance.argmin(axis=1)
    rows = np.arange(len(level))
    other = near[rows, best]
    mine, its = groups[level], groups[other]
    seam = np.isfinite(distance[rows, best]) & (mine < its) & touch[mine, its]
    return level[seam], other[seam], along[level[seam]]


def _below(space, spacing, places, faces: BareFaces, beside, most: int):
    """The particles in ``most`` rows below faces (most, n), and how many rows come before a gap (n,)."""
    middle, normal = faces.middle[beside], faces.normal[beside]
    rows, going, below = np.zeros(len(beside), int), np.ones(len(beside), bool), []
    for row in range(most):
        site = space.wrapped(middle - (row + 0.5) * spacing * normal)
        if len(site):
            distance, particle = (of[:, 0] for of in space.nearest(site, places, 1, AT_SITE * spacing))
            going &= np.isfinite(distance)
        else:
            particle = rows
        rows += going
        below.append(np.where(going, particle, 0))
    return below, rows
