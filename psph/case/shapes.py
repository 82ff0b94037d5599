"""The shapes that a case can draw."""

from typing import Annotated, ClassVar, Self

from pydantic import Strict, model_validator
from pydantic_core import PydanticCustomError

from psph.case.keys import Axis, Table, Vector, key
from psph.case.mesh import Mesh


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
    """A cylinder along an axis, in 3D."""

    only_in: ClassVar[int] = 3
    center: Vector = key("middle of the cylinder", unit="m")
    axis: Axis = key("direction of its axis")
    radius: float = key("radius", unit="m", gt=0)
    height: float = key("length along the axis", unit="m", gt=0)


class Polygon(Table):
    """A polygon, in 2D; it closes itself and may turn either way."""

    only_in: ClassVar[int] = 2
    points: Annotated[tuple[Vector, ...], Strict(False)] = key(
        "corners in order around it", unit="m", min_length=3
    )


class Difference(Table):
    """One shape without others."""

    base: "Shape" = key("the shape to take from", alias="from")
    minus: Annotated[tuple["Shape", ...], Strict(False)] = key("the shapes to take away", min_length=1)


class Shape(Table):
    """A region of space: exactly one of these keys."""

    box: Box | None = key("an interval, rectangle or block along the axes", None)
    disc: Disc | None = key("a disc (2D)", None)
    ball: Ball | None = key("a ball (3D)", None)
    cylinder: Cylinder | None = key("a cylinder along an axis (3D)", None)
    polygon: Polygon | None = key("a polygon (2D)", None)
    mesh: Mesh | None = key("a body, or the shell of one, from a geometry file (3D)", None)
    union: Annotated[tuple["Shape", ...], Strict(False)] | None = key(
        "all that lies in any of these shapes", None, min_length=1
    )
    difference: Difference | None = key("one shape without others", None)

    @property
    def form(self) -> Box | Disc | Ball | Cylinder | Polygon | Mesh | Difference | tuple["Shape", ...]:
        """The one form that this shape has; a tuple of shapes is their union."""
        [form] = (value for _, value in self if value is not None)
        return form

    @model_validator(mode="after")
    def _has_one_form(self) -> Self:
        given = [name for name, value in self if value is not None]
        if not given:
            known = ", ".join(type(self).model_fields)
            raise PydanticCustomError("psph", f"says no shape; give one of {known}")
        if len(given) > 1:
            both = " and ".join(given)
            listed = ", ".join(f"{{ {name} = ... }}" for name in given)
            raise PydanticCustomError("psph", f"{both} in one shape; to join them write union = [{listed}]")
        return self
