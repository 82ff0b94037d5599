"""Forms made of others: all that lies in any, in one and no other, in each."""

from collections.abc import Iterator, Sequence
from functools import reduce

import numpy as np

from psph.scene.forms.form import BESIDE, Faces, Form, Grid, Room, chosen, in_its_box, meeting, room_in

MANY = 8
"""Parts of a union from which on each is looked for only in the box around it."""


class Together(Form):
    """A form made of ``parts``."""

    def __init__(self, parts: Sequence[Form]):
        self.parts = tuple(parts)
        self.dimensions = self.parts[0].dimensions

    def corners(self, apart: float) -> np.ndarray:
        """As psph.scene.forms.form says; those inside other parts among them."""
        return np.concatenate([one.corners(apart) for one in self.parts])

    def straight(self, apart: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        return np.concatenate([one.straight(apart) for one in self.parts])

    def endless(self, lower: np.ndarray, upper: np.ndarray, periods: Sequence[float | None]) -> Form:
        """As psph.scene.forms.form says."""
        return self.each(lambda one: one.endless(lower, upper, periods))

    def each(self, change) -> "Together":
        """The same of changed parts."""
        return type(self)([change(one) for one in self.parts])

    def pieces(self) -> Iterator[Form]:
        """As psph.scene.forms.form says."""
        for one in self.parts:
            yield from one.pieces()

    def outline(self, spacing: float) -> list[np.ndarray]:
        """As psph.scene.forms.form says, of all parts."""
        return [line for one in self.parts for line in one.outline(spacing)]


class Union(Together):
    """All that lies in any of its parts."""

    def holds(self, grid: Grid, by: np.ndarray, slack: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        if len(self.parts) <= MANY:
            return reduce(np.logical_or, [one.holds(grid, by, slack) for one in self.parts])
        held = np.zeros(np.broadcast_shapes(*(np.shape(x) for x in grid)), bool)
        for one in self.parts:
            in_its_box(one, one.holds, grid, by, slack, held)
        return held

    def support(self, way: np.ndarray) -> float:
        """As psph.scene.forms.form says."""
        return max(one.support(way) for one in self.parts)

    def faces(self, points: np.ndarray, room: Room | None = None) -> Faces:
        """As psph.scene.forms.form says: faces that lie within other parts are none."""
        found = [one.faces(points, room) for one in self.parts]
        if len(found) == 1:
            return found[0]
        whole = chosen(found, np.argmin)
        within = np.flatnonzero(whole.away <= 0.0)
        if len(within):
            real = []
            for number, (own, part) in enumerate(zip(self.parts, found)):
                wide = np.subtract(*own.bounds[::-1])
                step = BESIDE * np.max(wide, where=np.isfinite(wide), initial=0.0)
                away = np.where(part.away[within] > 0.0, -np.inf, part.away[within])
                here = np.flatnonzero(np.isfinite(away))
                there = part.normal[within[here]] * (step - away[here, None])
                before, still = [*(points[within[here]] + there).T], np.zeros(self.dimensions)
                for one in (one for k, one in enumerate(self.parts) if k != number and len(here)):
                    away[here[np.broadcast_to(one.holds(before, still, 0.0), len(here))]] = -np.inf
                real.append(Faces(away, part.normal[within]))
            nearest = chosen(real, np.argmax)
            known = np.isfinite(nearest.away)
            whole.away[within[known]], whole.normal[within[known]] = (
                nearest.away[known],
                nearest.normal[known],
            )
        return whole


class Less(Together):
    """The first of its parts without the others."""

    @property
    def base(self) -> Form:
        """The first."""
        return self.parts[0]

    @property
    def minus(self) -> tuple[Form, ...]:
        """The others."""
        return self.parts[1:]

    def holds(self, grid: Grid, by: np.ndarray, slack: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        return self.base.holds(grid, by, slack) & ~Union(self.minus).holds(grid, by, slack)

    def support(self, way: np.ndarray) -> float:
        """As psph.scene.forms.form says."""
        return self.base.support(way)

    def faces(self, points: np.ndarray, room: Room | None = None) -> Faces:
        """As psph.scene.forms.form says; what is taken away has no faces beyond the base."""
        taken = (one.faces(points, room_in(self.base)) for one in self.minus)
        hole = chosen([Faces(-one.away, -one.normal) for one in taken], np.argmax)
        return meeting(self.base.faces(points, room), hole)


class Common(Together):
    """All that lies in each of its parts."""

    def holds(self, grid: Grid, by: np.ndarray, slack: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        held = True
        for one in self.parts:
            held = held & one.holds(grid, by, slack)
        return held

    def support(self, way: np.ndarray) -> float:
        """As psph.scene.forms.form says, or more: that of the part that ends first."""
        return min(one.support(way) for one in self.parts)

    def faces(self, points: np.ndarray, room: Room | None = None) -> Faces:
        """As psph.scene.forms.form says; outside, off the edges of right angles, the distance to a part."""
        return reduce(meeting, [one.faces(points, room) for one in self.parts])
