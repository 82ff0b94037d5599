"""Forces that act on a particle from outside."""

from typing import Annotated, NamedTuple

from pydantic import Field


class Gravity(NamedTuple):
    """A uniform body force on every fluid particle.

    a_i = g.
    """

    acceleration: Annotated[
        tuple[float, ...],
        Field(description="g, one number per dimension", json_schema_extra={"unit": "m/s2"}),
    ]

    def body(self, i):
        """g, m/s²."""
        return self.acceleration
