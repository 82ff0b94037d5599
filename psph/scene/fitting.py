"""Parts whose particles stand along their faces, and where these are.

How they come to stand there says psph.simulation.fitting.
"""

import numpy as np

from psph.composition.reflections import BELOW
from psph.scene.faces import FAR, form_in, within_mirrors
from psph.scene.forms.form import Faces, Room
from psph.scene.forms.joined import Common
from psph.scene.forms.plain import Boxed
from psph.scene.layout import Layout

BEYOND = 0.25
"""Spacings beyond a face where what another part fills has no face there."""


def fitted_parts(layout: Layout) -> list[int]:
    """The numbers of the parts that are fitted."""
    return [part.number for part in layout.parts if part.fitted]


def near_faces(layout: Layout, parts: list[int], points: np.ndarray) -> np.ndarray:
    """Which points (n, dim) are near the faces of some ``parts``, outside of these."""
    near = np.zeros(len(points), bool)
    for number in parts:
        near |= np.abs(form_in(layout, number).away(points)) < layout.support
    return near


def beyond(layout: Layout, parts: list[int], points: np.ndarray) -> np.ndarray:
    """Which part of the volume of sites at some points (n, dim) is beyond the faces of all ``parts`` (n,)."""
    away = np.min([FacesOf(layout, number).all(points).away for number in parts], axis=0)
    return np.clip(0.5 + away / layout.spacing, 0.0, 1.0)


class FacesOf:
    """The faces of a part of a ``layout``, as it was drawn."""

    def __init__(self, layout: Layout, number: int):
        self._form = Common([form_in(layout, number), Boxed(*corners_of(layout))])
        self._room = tuple(within_mirrors(layout))
        others = (one.number for one in layout.parts if not one.flows and one.number != number)
        self._others = [form_in(layout, one) for one in others]
        self._beyond = BEYOND * layout.spacing

    def all(self, points: np.ndarray) -> Faces:
        """All faces beside points (n, dim)."""
        return self._form.faces(points, self._room)

    def bare(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The signed distance of points (n, dim) from the next face (n,), m, and the normal out of it
        (n, dim); minus infinity and zeros where another part lies behind that."""
        away, normal = self.all(points)
        there = points + np.where(np.isfinite(away), self._beyond - away, 0.0)[:, None] * normal
        joined = ~np.isfinite(away)
        for one in self._others:
            joined |= one.away(there) < 0.0
        return np.where(joined, -np.inf, away), np.where(joined[:, None], 0.0, normal)


def corners_of(layout: Layout) -> Room:
    """The corners of the domain, m, far out where it repeats or a mirror ends it: no site is beyond it."""
    ends = np.array([layout.lower, layout.upper], float)
    for d, period in enumerate(layout.periods):
        if period is not None:
            ends[:, d] = -FAR, FAR
    for plane in layout.mirror_planes:
        ends[int(plane.side != BELOW), plane.axis] = -FAR if plane.side == BELOW else FAR
    return ends[0], ends[1]
