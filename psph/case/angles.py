"""Contact angles of walls and bodies: one, or one for lines that advance and one for lines that recede."""

import math
from typing import Annotated, Self

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from psph.case.keys import Table, key

UPRIGHT = 90.0
"""Degrees between a surface and what it meets where nothing else is told."""


class ContactAngles(Table):
    """Angles between which a line of contact stays where it is: drops stick."""

    advancing: float = key(
        "angle at which the heavier fluid advances over the wall", unit="degrees", gt=0, lt=180
    )
    receding: float = key("angle at which it draws back", unit="degrees", gt=0, lt=180)

    @model_validator(mode="after")
    def _in_order(self) -> Self:
        if self.receding > self.advancing:
            raise PydanticCustomError(
                "psph", "receding is above advancing, at which a line moves on; swap them"
            )
        return self


ContactAngle = Annotated[float, Field(gt=0, lt=180)] | ContactAngles

CONTACT_ANGLE = key(
    "angle at which surfaces of fluids meet it, measured through the heavier one: a number, or a table with "
    "one for lines that advance and one for those that recede, so that drops stick; needs a tension",
    None,
    unit="degrees",
    otherwise="90",
)
"""The key of whatever surfaces meet."""


def cosines(told: ContactAngle | None) -> tuple[float, float]:
    """The mean of the cosines of lines that advance and recede, and half of their difference."""
    angles = told if isinstance(told, ContactAngles) else None
    advancing, receding = (angles.advancing, angles.receding) if angles else (told or UPRIGHT,) * 2
    least, most = (math.cos(math.radians(one)) if one != UPRIGHT else 0.0 for one in (advancing, receding))
    return 0.5 * (most + least), 0.5 * (most - least)
