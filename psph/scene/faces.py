"""How thick the parts of a layout are, and the faces that the case draws of them."""

import numpy as np

from psph.composition.reflections import BELOW
from psph.scene.census import Census
from psph.scene.forms.form import Form
from psph.scene.forms.joined import Union
from psph.scene.forms.make import form_of
from psph.scene.forms.placed import Map, Moved
from psph.scene.lattice import TOLERANCE
from psph.scene.layout import Layout

WITHIN = 1e-3
"""Spacings from a mirror, or from an end of the domain, within which a part has no face: it goes on there."""

FAR = 1e9
"""A place beyond all faces, m."""

FLAT = 0.95
"""Length of the mean of the normals half a spacing around a particle from which no edge is near."""

BESIDE = 0.499
"""Spacings to the places around: just less than half, which leads to the middle of a plate of two particles,
where rounding alone says which face is nearer."""


def thinnest(census: Census, material: int) -> tuple[int, int]:
    """The fewest particles that a part that moves freely has along an axis, what is clamped with it, and
    that axis."""
    layout, parts = census.layout, census.layout.parts.of_whole(material)
    low, high = census.lowest[parts].min(axis=0), census.highest[parts].max(axis=0)
    counts = np.rint((high - low) / layout.spacing).astype(int) + 1
    for d, period in enumerate(layout.periods):
        if period is not None and (counts[d] + TOLERANCE) * layout.spacing > period:
            counts[d] = np.iinfo(int).max  # it goes on
    axis = int(counts.argmin())
    return int(counts[axis]), axis


def drawn_faces(layout: Layout, species: np.ndarray, position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of particles of these ``species`` (n,) that begin at ``position`` (n, dim) the normals (n, dim) of the
    drawn faces nearest to them, zeros within half a spacing of an edge, and their depths (n,) below, in
    spacings.

    What cracks gets new faces: its particles have none, and half a spacing of depth.
    """
    normal, depth = np.zeros_like(position), np.full(len(position), 0.5)
    for number in np.unique(species):
        part = layout.parts[number]
        whole = layout.parts[part.whole]
        if part.flows or whole.may_crack:
            continue
        drawn = (whole if whole.keeps_neighbours else part).shape
        ends = np.array(layout.lower), np.array(layout.upper)
        form = form_of(drawn).endless(*ends, layout.periods)
        rows = species == number
        found = form.faces(position[rows])
        mean = np.zeros_like(found.normal)
        for d in range(layout.dimensions):
            for way in (-BESIDE, BESIDE):
                beside = position[rows].copy()
                beside[:, d] += way * layout.spacing
                mean += form.faces(beside).normal / (2.0 * layout.dimensions)
        alike = np.sqrt((mean**2).sum(axis=1))
        normal[rows], depth[rows] = (
            np.where(alike[:, None] > FLAT, found.normal, 0.0),
            -found.away / layout.spacing,
        )
    return normal, depth


def form_in(layout: Layout, number: int, rests: bool = True) -> Form:
    """A part of the layout as it was drawn; one that ``rests`` among its images a period away."""
    ends, still = (np.array(layout.lower), np.array(layout.upper)), Map.none(layout.dimensions)
    form = form_of(layout.parts[number].shape).endless(*ends, layout.periods)
    for step, period in zip(np.eye(layout.dimensions), layout.periods):
        if rests and period is not None:
            form = Union([Moved(form, still._replace(shift=k * period * step)) for k in (-1, 0, 1)])
    return form


def within_mirrors(layout: Layout) -> np.ndarray:
    """The corners (2, dim), m, between which parts have faces: within mirrors."""
    room = np.full((2, layout.dimensions), ((-FAR,), (FAR,)))
    for plane in layout.mirror_planes:
        room[int(plane.side != BELOW), plane.axis] = plane.at - plane.side * WITHIN * layout.spacing
    return room
