"""A guest: a wall that oscillates, x = X + A sin(2πft), about where it stood at the start."""

import math
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from psph.fields import WALL
from psph.physics.catalogue import Catalogue, Entry
from psph.vectors import add, scale


class Swinging(NamedTuple):
    """The wall swings to and fro along a line."""

    amplitude: Annotated[
        tuple[float, ...],
        Field(min_length=1, description="A, one number per axis", json_schema_extra={"unit": "m"}),
    ]
    frequency: Annotated[float, Field(gt=0, description="f", json_schema_extra={"unit": "Hz"})]

    kind = WALL

    def place(self, anchor, time):
        """x, m."""
        return add(anchor, scale(self.amplitude, np.sin(2.0 * math.pi * self.frequency * time)))

    def velocity(self, anchor, time):
        """dx/dt, m/s."""
        turn = 2.0 * math.pi * self.frequency
        return scale(self.amplitude, turn * np.cos(turn * time))


CATALOGUE = Catalogue(motions=(Entry("walls.*.motion.swinging", Swinging),))
