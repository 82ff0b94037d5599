"""A guest: a wall that swings about a point as a whole, θ = A sin(2πft), and is thrown to and fro."""

import math
from typing import Annotated, NamedTuple

from pydantic import Field

from psph.fields import WALL
from psph.physics.catalogue import Catalogue, Entry
from psph.physics.rigid.pose import Pose, in_space, rotation

UPWARDS = (0.0, 0.0, 1.0)


class Rolling(NamedTuple):
    """The wall rolls about a point."""

    amplitude: Annotated[float, Field(description="A", json_schema_extra={"unit": "rad"})]
    frequency: Annotated[float, Field(gt=0, description="f", json_schema_extra={"unit": "Hz"})]
    center: Annotated[tuple[float, ...], Field(description="the point", json_schema_extra={"unit": "m"})]

    kind = WALL

    def pose(self, time):
        """The pose at a time, s."""
        w, center = 2.0 * math.pi * self.frequency, in_space(self.center)
        angle = self.amplitude * math.sin(w * time)
        return Pose(
            reference=center,
            translation=center,
            rotation=rotation(UPWARDS, angle),
            angular_velocity=(0.0, 0.0, self.amplitude * w * math.cos(w * time)),
            angular_acceleration=(0.0, 0.0, -w * w * angle),
        )


CATALOGUE = Catalogue(motions=(Entry("walls.*.motion.rolling", Rolling),))
