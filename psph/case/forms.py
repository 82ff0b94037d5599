"""The forms that a case draws by numbers alone."""

from typing import Annotated, ClassVar, Self

from pydantic import Strict, model_validator
from pydantic_core import PydanticCustomError

from psph.case.keys import Axis, Table, Vector, key
from psph.case.placing import FlatFace


class Box(Table):
    """An interval, rectangle or block along the axes."""

    lower: Vector = key("corner with the smallest coordinates", unit="m")
    upper: Vector = key("corner with the largest coordinates", unit="m")

    @model_validator(mode="after")
    def _has_an_inside(self) -> Self:
        if any(low >= up for low, up in zip(self.lower, self.upper)):
            raise PydanticCustomError(
                "psph", "has no inside; let every number of 'upper' exceed that of 'lower'"
            )
        return self


class Disc(Table):
    """A disc, in 2D."""

    only_in: ClassVar[int] = 2
    center: Vector = key("centre", unit="m")
    radius: float = key("radius", unit="m", gt=0)


class Ball(Table):
    """A ball, in 3D."""

    only_in: ClassVar[int] = 3
    center: Vector = key("centre", unit="m")
    radius: float = key("radius", unit="m", gt=0)


class Cylinder(Table):
    """A cylinder, in 3D."""

    only_in: ClassVar[int] = 3
    center: Vector = key("middle of the cylinder", unit="m")
    axis: Axis | Vector = key("direction of its axis, by name or as a vector")
    radius: float = key("radius", unit="m", gt=0)
    height: float = key("length along the axis", unit="m", gt=0)

    @model_validator(mode="after")
    def _has_a_direction(self) -> Self:
        return with_direction(self)


class Cone(Table):
    """A cone, or a piece of one, between two points, in 3D; with equal radii a cylinder."""

    only_in: ClassVar[int] = 3
    begin: Vector = key("middle of its base", unit="m")
    end: Vector = key("its tip, or the middle of its other end", unit="m")
    radius: float = key("radius of its base", unit="m", gt=0)
    end_radius: float = key("radius of its other end", 0.0, unit="m", ge=0)

    @model_validator(mode="after")
    def _has_an_inside(self) -> Self:
        if self.begin == self.end:
            raise PydanticCustomError("psph", "has no length; let 'end' differ from 'begin'")
        return self


class Polygon(Table):
    """A polygon, in 2D; it closes itself and may turn either way."""

    only_in: ClassVar[int] = 2
    points: Annotated[tuple[Vector, ...], Strict(False)] = key(
        "corners in order around it", unit="m", min_length=3
    )


class HalfSpace(FlatFace):
    """All that lies behind a plane; another shape must bound it."""


def with_direction(table):
    """The table, if its ``axis`` says a direction."""
    if not any(table.axis):
        raise PydanticCustomError("psph", 'an axis of zeros has no direction; give "z", or [0, 0, 1]')
    return table
