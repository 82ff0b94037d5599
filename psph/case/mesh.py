"""The shape that a geometry file draws: ``shape.mesh``."""

from pathlib import Path
from typing import Annotated, ClassVar, Literal, Self

from pydantic import PrivateAttr, Strict, ValidationError, ValidationInfo, model_validator
from pydantic_core import PydanticCustomError

from psph.case.files import Found, Unfit, beside
from psph.case.keys import Table, Text, Vector, key

ENDINGS = (".stl", ".obj", ".ply")

Side = Literal["inside", "outside"]


class Turn(Table):
    """A turn about an axis through the origin, by the right-hand rule."""

    axis: Vector = key("direction of the axis")
    degrees: float = key("angle of the turn", unit="degrees")

    @model_validator(mode="after")
    def _has_a_direction(self) -> Self:
        if not any(self.axis):
            raise PydanticCustomError("psph", "an axis of zeros has no direction; give for example [0, 0, 1]")
        return self


class Mesh(Table):
    """The body within the surface of a geometry file, or a shell along that surface, in 3D."""

    only_in: ClassVar[int] = 3
    instead: ClassVar[str] = "a polygon"
    file: Text = key("an STL, OBJ or PLY file in the case's folder or below")
    scale: float = key("metres per unit of the file: 0.001 where it is in mm, 1 where in m", unit="m", gt=0)
    rotate: Annotated[tuple[Turn, ...], Strict(False)] = key(
        "turns of the scaled body about the origin, one after the other, each as "
        "`{ axis = [0, 0, 1], degrees = 90 }`, by the right-hand rule",
        (),
    )
    move: Vector | None = key(
        "how far the scaled and turned body is moved", None, unit="m", otherwise="zeros"
    )
    fill: bool | None = key(
        "the shape is all that the surface encloses", None, otherwise="true, unless there is a `shell`"
    )
    shell: float | None = key(
        "the shape is what is nearer to the surface than this thickness, on one side of it",
        None,
        unit="m",
        otherwise="no shell: the body is filled",
        gt=0,
    )
    side: Side | None = key(
        "side of a shell: inside the body (behind its faces), or outside", None, otherwise='`"inside"`'
    )

    _found: Found | None = PrivateAttr(None)

    @property
    def found(self) -> Found:
        """The file, and what tells it from another of that name."""
        return self._found

    @model_validator(mode="after")
    def _full_or_hollow(self) -> Self:
        if self.fill and self.shell:
            raise PydanticCustomError(
                "psph", "fill and shell: a body is full or a shell; remove one of the two"
            )
        if self.fill is False and not self.shell:
            raise PydanticCustomError("psph", "fill = false leaves nothing; give shell = its thickness in m")
        if self.side and not self.shell:
            raise PydanticCustomError("psph", "side is that of a shell; give shell = its thickness in m")
        return self

    @model_validator(mode="after")
    def _look_up(self, info: ValidationInfo) -> Self:
        """Find the file; the context of the validation is the folder of the case."""
        if self._found is not None:  # looked at again, as part of another table
            return self
        try:
            self._found = beside(info.context or Path(), self.file, "an STL, OBJ or PLY file", ENDINGS)
        except Unfit as says:
            kind = PydanticCustomError("psph", "{says}", {"says": str(says)})
            fault = {"type": kind, "loc": ("file",), "input": ...}
            raise ValidationError.from_exception_data("mesh", [fault]) from None
        return self
