"""The shape that a geometry file draws: ``shape.mesh``."""

from typing import Annotated, ClassVar, Literal, Self

from pydantic import Strict, model_validator
from pydantic_core import PydanticCustomError

from psph.case.drawing import Drawing
from psph.case.keys import Text, Vector, key
from psph.case.placing import Turn

Side = Literal["inside", "outside"]


class Mesh(Drawing):
    """The body within the surface of a geometry file, or a shell along that surface, in 3D."""

    only_in: ClassVar[int] = 3
    instead: ClassVar[str] = "a polygon"
    kind: ClassVar[str] = "an STL, OBJ or PLY file"
    endings: ClassVar[tuple[str, ...]] = (".stl", ".obj", ".ply")

    file: Text = key("an STL, OBJ or PLY file in the case's folder or below")
    scale: float = key("metres per unit of the file: 0.001 where it is in mm, 1 where in m", unit="m", gt=0)
    rotate: Annotated[tuple[Turn, ...], Strict(False)] = key(
        "turns of the scaled body, one after the other, each as `{ axis = [0, 0, 1], degrees = 90 }`, by "
        "the right-hand rule",
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
