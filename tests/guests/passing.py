"""A guest: a region where particles vanish, and another where rows of them appear."""

import math
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from psph.physics.catalogue import Catalogue, Entry

Corner = Annotated[tuple[float, ...], Field(min_length=1, json_schema_extra={"unit": "m"})]


class Drain(NamedTuple):
    """Fluid that comes into a box is gone."""

    lower: Corner
    upper: Corner

    def vanish(self, position, velocity, time):
        """True inside the box."""
        return ((position >= self.lower) & (position < self.upper)).all(axis=1)


class Spring(NamedTuple):
    """Rows of particles come in one after the other at a steady speed along x."""

    start: Corner
    end: Corner
    spacing: Annotated[float, Field(gt=0, json_schema_extra={"unit": "m"})]
    speed: Annotated[float, Field(gt=0, json_schema_extra={"unit": "m/s"})]

    def next_time(self, time):
        """The next row, s."""
        return (math.floor(time * self.speed / self.spacing) + 1) * self.spacing / self.speed

    def appear(self, begun, ended):
        """The rows that are due, each where it has come to by now."""
        first = math.floor(begun * self.speed / self.spacing) + 1
        last = math.floor(ended * self.speed / self.spacing)
        start, end = np.array(self.start), np.array(self.end)
        count = max(round(float(np.linalg.norm(end - start)) / self.spacing), 1)
        row = start + (end - start) * ((np.arange(count) + 0.5) / count)[:, None]
        ahead = [self.speed * ended - n * self.spacing for n in range(first, last + 1)]
        along = np.eye(len(start))[0]
        places = [row + along * way for way in ahead] or [np.empty((0, len(start)))]
        position = np.concatenate(places)
        return position, np.tile(self.speed * along, (len(position), 1))


CATALOGUE = Catalogue(regions=(Entry("regions.*.drain", Drain), Entry("regions.*.spring", Spring)))
