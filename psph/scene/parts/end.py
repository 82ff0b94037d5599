"""The buffers of open ends as parts of a scene: fluid behind a plane, a part for each fluid."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from psph.case import Case
from psph.case.ends import OpenEnd
from psph.case.keys import AXES
from psph.case.shapes import Box, Shape
from psph.scene.lattice import TOLERANCE
from psph.scene.parts.part import Known, Part
from psph.scene.shapes import Grid, bounds, inside


@dataclass(frozen=True)
class Behind:
    """The table of a part behind an ``end``, of a ``fluid``: what a part asks of it."""

    end: OpenEnd
    fluid: Any
    shape: Shape
    filled: bool | None
    """Whether the part fills all of its shape: yes, no; None: where its fluid stands in front of it."""

    @property
    def velocity(self) -> Any:
        """Of its fluid at the start."""
        return self.fluid.velocity


@dataclass(frozen=True)
class EndPart(Part):
    """The buffer of an open end, of one fluid, with the ``tensions`` of that."""

    tensions: tuple[float, ...] = ()

    may_be_empty = True
    drawn = False

    @property
    def displaces(self) -> bool:
        """It takes the place of what was drawn through the plane."""
        return True

    @property
    def jitter(self) -> float:
        """Rows stand in order."""
        return 0.0

    def own(self, known: Known) -> dict[str, Any]:
        """The number of its fluid among fluids, and the tensions of that."""
        return {"fluid": 1 + self.source, "tensions": self.tensions}

    def rows(self, case: Case) -> int:
        """Layers of its particles behind the plane."""
        return rows_of(case, self.table.end)

    def claimed(self, layout, grid: Grid, tolerance: float) -> np.ndarray:
        """True at the sites of the box behind the plane that no wall holds, where its fluid stands in front
        of it, or of all of the box."""
        box, end = inside(self.shape, grid, tolerance), self.table.end
        if not np.any(box):
            return box
        box = box & ~layout.stands(layout.held_before_ends(grid, np.shape(box)))
        if self.table.filled is not None:
            return box & self.table.filled
        front = [x if d != end.axis else np.full_like(x, self._front(layout)) for d, x in enumerate(grid)]
        return box & (layout.held_before_ends(front, np.shape(box)) == self.source)

    def _front(self, layout) -> float:
        """The coordinate of the first sites in front of the plane."""
        end, dx = self.table.end, layout.spacing
        first = (end.at - layout.lattice.origin[end.axis]) / dx - 0.5
        site = math.ceil(first - TOLERANCE) if end.sign > 0 else math.floor(first + TOLERANCE)
        return layout.lattice.origin[end.axis] + (site + 0.5) * dx


def rows_of(case: Case, end: OpenEnd) -> int:
    """Rows of particles behind an end."""
    return end.layers or rows_reached(case) + 1


def rows_reached(case: Case) -> int:
    """Rows behind a plane over which the kernel of a particle at the plane reaches."""
    return case.space.layers


def behind(case: Case, end: OpenEnd, parts: Sequence[Part]) -> Shape:
    """The box behind the plane of an end, as wide as it says or as all ``parts`` together."""
    lowest, highest = zip(*(bounds(part.shape) for part in parts))
    lower, upper = list(map(min, zip(*lowest))), list(map(max, zip(*highest)))
    for d, axis in enumerate(AXES[: case.space.dimensions]):
        if (told := getattr(end.span, axis)) is not None:
            lower[d], upper[d] = told
    deep = rows_of(case, end) * case.space.spacing
    lower[end.axis], upper[end.axis] = sorted((end.at, end.at - end.sign * deep))
    return Shape(box=Box(lower=tuple(lower), upper=tuple(upper)))
