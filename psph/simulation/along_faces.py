"""Faces on whose one side particles stay while they find their places."""

import numpy as np

from psph.fields import VECTOR, Field
from psph.particles.store import Store
from psph.scene.fitting import FacesOf
from psph.scene.layout import Layout

DEEP = 0.5
"""Spacings from a face to the middle of the first row."""

INSIDE, OUTSIDE = -1, 1

AWAY = Field("away", "m", "signed distance from the next face, where it was looked for")
NORMAL = Field("normal", "1", "out of the shape there", VECTOR)
SEEN = Field("seen", "m", "where a particle was when its face was looked for", VECTOR)

SIDE = (AWAY, NORMAL, SEEN)
"""What particles know of their faces: in between two looks these are planes."""


class Along:
    """The faces of some ``parts`` of a layout: their own particles stay INSIDE of them, those of others
    OUTSIDE, as ``side`` says (psph.simulation.relaxing.Sides)."""

    def __init__(self, layout: Layout, parts: list[int], side: int):
        self._faces = {number: FacesOf(layout, number) for number in parts}
        self._deep, self._side = DEEP * layout.spacing, side

    def look(self, store: Store) -> None:
        """Find the faces beside all particles here; there are none beside what another part fills."""
        whose, points = store["whose"][store.inner], store.owned_rows("position")
        away, normal = np.full(len(whose), self._side * np.inf), np.zeros(points.shape)
        for number, faces in self._faces.items():
            own = np.flatnonzero(whose == number if self._side == INSIDE else whose >= 0.0)
            found, ways = faces.bare(points[own]) if self._side == INSIDE else faces.all(points[own])
            nearer = self._side * found < self._side * away[own]
            away[own[nearer]], normal[own[nearer]] = found[nearer], ways[nearer]
        for array, values in zip((store[AWAY.name], *store[NORMAL.name]), (away, *normal.T)):
            array[store.inner] = values
        for array, values in zip(store[SEEN.name], points.T):
            array[store.inner] = values

    def hold(self, store: Store, step: tuple) -> None:
        """Keep the particles on their side, and take out of their last ``step`` what leads them to the
        other."""
        x, seen, normal = ([one[store.inner] for one in store[n]] for n in ("position", "seen", "normal"))
        away = store[AWAY.name][store.inner] + sum(n * (a - b) for n, a, b in zip(normal, x, seen))
        over = np.maximum(self._deep - self._side * away, 0.0)
        last = [one[store.inner] for one in step]
        out = np.where(
            over > 0.0, np.minimum(self._side * sum(s * n for s, n in zip(last, normal)), 0.0), 0.0
        )
        for place, way, n in zip(x, last, normal):
            place += self._side * over * n
            way -= self._side * out * n
