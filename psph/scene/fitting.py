"""Parts whose particles stand along their faces, and where these are.

How they come to stand there says psph.simulation.fitting.
"""

import numpy as np

from psph.composition.reflections import BELOW
from psph.scene.forms.form import Faces, Form, Room
from psph.scene.forms.joined import Common, Union
from psph.scene.forms.make import form_of
from psph.scene.forms.placed import Map, Moved
from psph.scene.forms.plain import Boxed
from psph.scene.layout import Layout

BEYOND = 0.25
"""Spacings beyond a face where what another part fills has no face there."""

WITHIN = 1e-3
"""Spacings within a mirror to which there are faces."""

FAR = 1e9
"""m, beyond all."""


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
        self._form = Common([form_in(layout, number), Boxed(*domain_of(layout))])
        self._room = room_of(layout)
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


def form_in(layout: Layout, number: int) -> Form:
    """A part of the layout as it was drawn, among its images a period away."""
    ends, still = (np.array(layout.lower), np.array(layout.upper)), Map.none(layout.dimensions)
    form = form_of(layout.parts[number].shape).endless(*ends, layout.periods)
    for step, period in zip(np.eye(layout.dimensions), layout.periods):
        if period is not None:
            form = Union([Moved(form, still._replace(shift=k * period * step)) for k in (-1, 0, 1)])
    return form


def domain_of(layout: Layout) -> Room:
    """The corners of the domain, m, far out where it repeats or a mirror ends it: no site is beyond it."""
    ends = np.array([layout.lower, layout.upper], float)
    for d, period in enumerate(layout.periods):
        if period is not None:
            ends[:, d] = -FAR, FAR
    for plane in layout.mirror_planes:
        ends[int(plane.side != BELOW), plane.axis] = -FAR if plane.side == BELOW else FAR
    return ends[0], ends[1]


def room_of(layout: Layout) -> Room:
    """Where faces are: within mirrors."""
    room = np.full((2, layout.dimensions), ((-FAR,), (FAR,)))
    for plane in layout.mirror_planes:
        room[int(plane.side != BELOW), plane.axis] = plane.at - plane.side * WITHIN * layout.spacing
    return room[0], room[1]
