"""Forces that act on a particle from outside."""

from typing import Annotated, NamedTuple

from pydantic import Field

from psph.acts import SEAM
from psph.physics.facts import Facts
from psph.physics.walls.conditions import EXTRAPOLATED, MIRROR
from psph.vectors import dot, scale, subtract


class Gravity(NamedTuple):
    """A uniform pull on all that has a mass.

    a_i = g.
    """

    uniform = True

    acceleration: Annotated[
        tuple[float, ...],
        Field(
            min_length=1,
            description="g, one number per dimension",
            json_schema_extra={"unit": "m/s2"},
        ),
    ]

    def body(self, i):
        """g, m/s²."""
        return self.acceleration

    def linear(self, scene: Facts):
        """Linear theory includes it as it is."""
        return None

    def idle(self, scene: Facts, effects):
        """Why it has no influence, or None."""
        if any(self.acceleration):
            return None
        return "physics.gravity is zero along every axis; remove the key"


class CentralForce(NamedTuple):
    """A pull towards a centre that grows with the distance, as that of a spring, on all that has a mass.

    a_i = −B² (x_i − X), with the potential B² |x_i − X|²/2.  Monaghan & Rafiee (2013), Int. J. Numer. Methods
    Fluids 71, 537, whose drop swings in it between two ellipses.
    """

    refuses = {
        SEAM: "it would turn round at the seam of an axis that repeats; take the axis out of space.periodic",
        **dict.fromkeys(
            (MIRROR, EXTRAPOLATED),
            "walls of this condition continue the pressure by the weight alone; take another condition",
        ),
    }

    frequency: Annotated[float, Field(description="B", json_schema_extra={"unit": "rad/s"})]
    center: Annotated[
        tuple[float, ...],
        Field(
            min_length=1,
            description="X, one number per dimension",
            json_schema_extra={"unit": "m"},
        ),
    ]

    def body(self, i):
        """−B² (x − X), m/s²."""
        return scale(subtract(i.position, self.center), -self.frequency * self.frequency)

    def potential(self, i):
        """B² |x − X|²/2, J/kg."""
        away = subtract(i.position, self.center)
        return 0.5 * self.frequency * self.frequency * dot(away, away)
