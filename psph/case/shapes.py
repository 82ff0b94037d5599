"""The shapes that a case can draw."""

from typing import Annotated, Any, ClassVar, Self

from pydantic import Strict, model_validator
from pydantic_core import PydanticCustomError

from psph.case.forms import Ball, Box, Cone, Cylinder, Disc, HalfSpace, Polygon, with_direction
from psph.case.height_map import HeightMap
from psph.case.keys import Axis, Table, Vector, key
from psph.case.mesh import Mesh, Side
from psph.case.placing import Placing

Shapes = Annotated[tuple["Shape", ...], Strict(False)]


class Difference(Table):
    """One shape without others."""

    base: "Shape" = key("the shape to take from", alias="from")
    minus: Shapes = key("the shapes to take away", min_length=1)


class Prism(Table):
    """A shape of two dimensions drawn out along an axis, in 3D."""

    only_in: ClassVar[int] = 3
    flat: ClassVar[str] = "profile"
    profile: "Shape" = key("a shape in 2D; its two numbers are the other coordinates, in their order")
    along: Axis = key("the axis that it is drawn out along")
    lower: float = key("where it begins on that axis", unit="m")
    upper: float = key("where it ends", unit="m")

    @model_validator(mode="after")
    def _has_an_inside(self) -> Self:
        if not self.lower < self.upper:
            raise PydanticCustomError("psph", "has no inside; let 'upper' exceed 'lower'")
        return self


class Revolution(Table):
    """A shape of two dimensions turned about an axis, in 3D."""

    only_in: ClassVar[int] = 3
    flat: ClassVar[str] = "profile"
    profile: "Shape" = key(
        "a shape in 2D; its two numbers are the distance from the axis, above 0, and the height along it"
    )
    center: Vector = key("the point of the axis at height 0", unit="m")
    axis: Axis | Vector = key("direction of the axis, by name or as a vector")

    @model_validator(mode="after")
    def _has_a_direction(self) -> Self:
        return with_direction(self)


class Shell(Table):
    """What is nearer to the surface of a shape than a thickness, on one side of it."""

    of: "Shape" = key("the shape")
    side: Side = key("side of its surface", "outside")
    thickness: float | None = key(
        "how thick it is", None, unit="m", otherwise="as deep as the kernel reaches, in whole spacings", gt=0
    )


class Shape(Placing):
    """A region of space: exactly one form, and where it is placed."""

    box: Box | None = key("an interval, rectangle or block along the axes", None)
    disc: Disc | None = key("a disc (2D)", None)
    ball: Ball | None = key("a ball (3D)", None)
    cylinder: Cylinder | None = key("a cylinder in any direction (3D)", None)
    polygon: Polygon | None = key("a polygon (2D)", None)
    mesh: Mesh | None = key("a body, or the shell of one, from a geometry file (3D)", None)
    union: Shapes | None = key("all that lies in any of these shapes", None, min_length=1)
    difference: Difference | None = key("one shape without others", None)
    intersection: Shapes | None = key("all that lies in each of these shapes", None, min_length=1)
    cone: Cone | None = key("a cone, or a piece of one, in any direction (3D)", None)
    prism: Prism | None = key("a shape in 2D drawn out along an axis (3D)", None)
    revolution: Revolution | None = key("a shape in 2D turned about an axis (3D)", None)
    half_space: HalfSpace | None = key(
        "all that lies behind a plane, within an intersection or taken from a shape", None
    )
    height_map: HeightMap | None = key("all below a ground whose heights stand in a file (2D, 3D)", None)
    shell: Shell | None = key("the surroundings of a shape, or its rim, with the layers of a wall", None)

    @classmethod
    def forms(cls) -> list[str]:
        """The keys of the forms."""
        return [name for name in cls.model_fields if name not in Placing.model_fields]

    @property
    def form(self) -> Any:
        """The one form that this shape has, before it is placed; a tuple of shapes is their union."""
        return getattr(self, self.form_name)

    @property
    def form_name(self) -> str:
        """Its key."""
        return next(name for name in self.forms() if getattr(self, name) is not None)

    @property
    def is_endless(self) -> bool:
        """Whether it goes on without an end."""
        match self.form:
            case tuple() as shapes:
                ask = all if self.intersection else any
                return ask(one.is_endless for one in shapes)
            case Difference(base=one) | Shell(of=one) | Prism(profile=one) | Revolution(profile=one):
                return one.is_endless
            case form:
                return isinstance(form, HalfSpace)

    @model_validator(mode="after")
    def _has_one_form(self) -> Self:
        given = [name for name in self.forms() if getattr(self, name) is not None]
        if not given:
            known = ", ".join(self.forms())
            raise PydanticCustomError("psph", f"says no shape; give one of {known}")
        if len(given) > 1:
            both = " and ".join(given)
            listed = ", ".join(f"{{ {name} = ... }}" for name in given)
            raise PydanticCustomError("psph", f"{both} in one shape; to join them write union = [{listed}]")
        return self
