"""From the tables of a case to forms."""

from functools import lru_cache
from typing import Any

import numpy as np

from psph.case.forms import Ball, Box, Cone, Cylinder, Disc, HalfSpace, Polygon
from psph.case.height_map import HeightMap
from psph.case.keys import AXES
from psph.case.mesh import Mesh
from psph.case.shapes import Difference, Prism, Revolution, Shape, Shell
from psph.scene.forms import swept
from psph.scene.forms.form import Form
from psph.scene.forms.ground import Ground
from psph.scene.forms.joined import Common, Less, Union
from psph.scene.forms.placed import Map, frame_of, placed, placed_as
from psph.scene.forms.plain import BehindPlane, Boxed, Round
from psph.scene.forms.polygon import Polygonal
from psph.scene.forms.shell import Coat

KEPT = 1024
"""Forms that are remembered."""


@lru_cache(KEPT)
def form_of(shape: Shape) -> Form:
    """What a shape of a case is.  Raises psph.scene.meshes.reading.MeshError where a file draws none."""
    if shape.intersection:
        return placed_as(Common([form_of(one) for one in shape.intersection]), shape)
    return placed_as(_drawn(shape.form), shape)


def _drawn(table: Any) -> Form:
    """A form at the place where it is drawn."""
    match table:
        case tuple():
            return Union([form_of(one) for one in table])
        case Difference(base=base, minus=minus):
            return Less([form_of(one) for one in (base, *minus)])
        case Box(lower=lower, upper=upper):
            return Boxed(lower, upper)
        case Disc(center=center, radius=radius) | Ball(center=center, radius=radius):
            return Round(center, radius)
        case Polygon(points=points):
            return Polygonal(points)
        case HalfSpace(at=at, normal=normal):
            return BehindPlane(at, normal)
        case Cylinder(center=center, axis=axis, radius=radius, height=height):
            return _about(Boxed((0.0, -0.5 * height), (radius, 0.5 * height)), axis, center)
        case Cone(begin=begin, end=end, radius=first, end_radius=last):
            way = np.subtract(end, begin)
            length = float(np.linalg.norm(way))
            corners = dict.fromkeys([(0.0, 0.0), (first, 0.0), (last, length), (0.0, length)])
            return _about(Polygonal([*corners]), tuple(way), begin)
        case Prism(profile=profile, along=along, lower=lower, upper=upper):
            return swept.drawn_out(form_of(profile), AXES.index(along), Boxed((lower,), (upper,)))
        case Revolution(profile=profile, center=center, axis=axis):
            return _about(form_of(profile), axis, center)
        case HeightMap(heights=heights, bottom=bottom):
            return Ground(heights, bottom)
        case Shell(of=of, side=side, thickness=thickness):
            return Coat(form_of(of), thickness, side == "inside")
        case Mesh():
            from psph.scene.forms.of_mesh import OfMesh  # takes a while, and most scenes have none

            return OfMesh(table)
    raise TypeError(f"{table!r} is no form")


def _about(profile: Form, axis, center) -> Form:
    """A profile turned about an axis through a point."""
    return placed(swept.Revolved(profile), Map(1.0, frame_of(axis, AXES), np.array(center)))
