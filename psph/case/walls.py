"""Walls of a case."""

from typing import Any, ClassVar, Literal, Self

from pydantic import create_model, model_validator
from pydantic_core import PydanticCustomError

from psph.case.angles import CONTACT_ANGLE, ContactAngle
from psph.case.fitted import FITTED
from psph.case.keys import Name, Vector, key
from psph.case.motion import Motions, motions_type
from psph.case.placed import Answering, Placed
from psph.case.shapes import Shape
from psph.physics.catalogue import Catalogue
from psph.physics.walls.conditions import CONDITIONS, DYNAMIC, MIRROR


class Wall(Placed):
    """A wall: particles that stay where they are, or move as they are told."""

    shape: Shape = key("where the wall is")
    velocity: Vector | None = key(
        "velocity at which its surface drags viscous fluid along, as a belt does: the wall itself stays",
        None,
        unit="m/s",
        otherwise="zeros",
    )
    motion: Motions | None = key(
        "how the wall moves: one part, or a list of parts that act one after the other",
        None,
        otherwise="it stays where it is",
    )
    no_slip: bool = key(
        "the fluid has the wall's velocity at the face of the wall; needs a viscosity",
        False,
    )
    condition: Literal[CONDITIONS] = key(
        "dynamic: the density of the wall's particles evolves as that of the fluid; extrapolated: their "
        "pressure is that of the nearby fluid, continued hydrostatically; repulsive: they repel the fluid; "
        "penalty: they push back what is nearer than half a spacing (these two bear no pressure); mirror: "
        "there are no particles, and the fluid is mirrored at a plane: the shape is a box along a whole side "
        "of the fluids, or a box around them minus a box",
        DYNAMIC,
    )
    continues: Name | None = key(
        "the fluid, or soil, whose density and initial pressure the wall has",
        None,
        otherwise="the first fluid, or soil",
    )
    contact_angle: ContactAngle | None = CONTACT_ANGLE
    displaces: bool = key("it replaces fluid and soil where they overlap at the start, as a body does", False)
    fitted: bool = FITTED

    called: ClassVar = "wall"
    rigid: ClassVar = True
    keeps_form: ClassVar = True

    @classmethod
    def with_more(cls, catalogue: Catalogue) -> type[Answering]:
        """With further motions."""
        if not catalogue.motions:
            return cls
        moved = (motions_type(catalogue.motions) | None, cls.model_fields["motion"])
        return create_model("Wall", __base__=cls, __doc__=cls.__doc__, motion=moved)

    @property
    def word(self) -> str:
        """Its condition."""
        return self.condition

    def motions(self) -> dict[tuple, Any]:
        """Its own."""
        return {(): self.motion}

    def said(self, table: str, name: str) -> tuple[tuple, Any]:
        """Its condition."""
        return (table, name, "condition"), self.condition

    @model_validator(mode="after")
    def _has_particles_to_displace(self) -> Self:
        if self.displaces and self.condition == MIRROR:
            raise PydanticCustomError(
                "psph", "displaces is of a wall with particles, which a mirror has not; remove it"
            )
        return self
