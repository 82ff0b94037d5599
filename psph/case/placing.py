"""Where a shape comes to lie: scaled, mirrored, turned, moved, repeated."""

from typing import Annotated, Self

from pydantic import Strict, model_validator
from pydantic_core import PydanticCustomError

from psph.case.keys import Table, Vector, key

MOST_COPIES = 10_000
"""Of a shape, by all its repetitions together."""


class Turn(Table):
    """A turn by the right-hand rule, about an axis in 3D, anticlockwise about a point in 2D."""

    axis: Vector | None = key("in 3D, direction of the axis", None, otherwise="none, in 2D")
    degrees: float = key("angle of the turn", unit="degrees")
    about: Vector | None = key("a point that stays where it is", None, unit="m", otherwise="the origin")

    @model_validator(mode="after")
    def _has_a_direction(self) -> Self:
        if self.axis is not None and not any(self.axis):
            raise PydanticCustomError("psph", "an axis of zeros has no direction; give for example [0, 0, 1]")
        return self


class FlatFace(Table):
    """A plane; in 2D a line, in 1D a point."""

    at: Vector = key("a point of the plane", unit="m")
    normal: Vector = key("direction out of it, of any length", unit="1")

    @model_validator(mode="after")
    def _has_a_direction(self) -> Self:
        if not any(self.normal):
            raise PydanticCustomError("psph", "a normal of zeros has no direction; give for example [0, 1]")
        return self


class Repeat(Table):
    """Copies of a shape in a row, in a circle, or along a screw."""

    count: int = key("how many there are, the first among them", ge=2, le=MOST_COPIES)
    step: Vector | None = key(
        "how far each is moved from the one before", None, unit="m", otherwise="not at all"
    )
    turn: Turn | None = key("how each is turned against the one before", None, otherwise="not at all")

    @model_validator(mode="after")
    def _goes_on(self) -> Self:
        if self.turn is None and not any(self.step or ()):
            raise PydanticCustomError("psph", "all copies lie in one place; give step, turn or both")
        return self


class Placing(Table):
    """How a shape is placed.  The order is scale, mirror, rotate, move, repeat, whatever that of the file."""

    scale: float | None = key(
        "times as large, seen from the origin", None, unit="1", otherwise="as drawn", gt=0
    )
    mirror: FlatFace | None = key(
        "a plane that it is mirrored at, as `{ at = [0, 0], normal = [1, 0] }`", None, otherwise="none"
    )
    rotate: Annotated[tuple[Turn, ...], Strict(False)] = key(
        "turns one after the other, each as `{ axis = [0, 0, 1], degrees = 90, about = [0, 0, 0] }`, in 2D "
        "without an axis",
        (),
    )
    move: Vector | None = key("how far it is moved", None, unit="m", otherwise="zeros")
    repeat: Annotated[tuple[Repeat, ...], Strict(False)] = key(
        "copies of it, as `{ count = 5, step = [1, 0] }` or `{ count = 6, turn = { degrees = 60 } }`; "
        "several make rows of rows",
        (),
    )

    @property
    def copies(self) -> int:
        """How often it is there."""
        count = 1
        for one in self.repeat:
            count *= one.count
        return count

    @property
    def is_placed(self) -> bool:
        """Whether any of these keys is given."""
        return any((self.scale, self.mirror, self.rotate, self.move, self.repeat))

    @property
    def is_endless(self) -> bool:
        """Whether what is placed goes on without an end."""
        return False

    @model_validator(mode="after")
    def _are_few(self) -> Self:
        if self.copies > MOST_COPIES:
            raise PydanticCustomError(
                "psph", f"repeat makes {self.copies:,} copies, and {MOST_COPIES:,} are the most; give fewer"
            )
        return self
