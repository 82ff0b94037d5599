"""Whether a fluid has a free surface, now or when what encloses it has moved."""

from typing import Any

import numpy as np

from psph.composition.reflections import ABOVE, BELOW
from psph.kinds import in_case
from psph.physics.motion import goes_free, is_rigid, moments
from psph.scene.census import Census
from psph.scene.columns import connected
from psph.scene.lattice import TOLERANCE, sites_between
from psph.scene.moving import moved_on, taken_back
from psph.scene.shapes import inside
from psph.scene.walls import touches_air

AROUND = 2
"""Sites around those of the fluid that are looked at."""

LOOKS, LOOKED_AT = (4, 32), 1 << 24
"""Fewest and most times of a run at which a place for the fluid is looked for, and sites looked at in all."""

LAYERS = 0.5
"""By how many layers of particles on all that moves the place must grow for a free surface to open."""


def has_free_surface(census: Census) -> bool:
    """Whether the fluid has a free surface at the start, or can have one before the end.

    It can where particles vanish, and where the place of the fluid grows or opens: the sites that are
    connected with it, without what fixed walls hold and what walls and bodies hold that move as they are
    told, at some times of the run, all as seen from what touches most of the fluid.  What forces move, rigid
    bodies and elastic solids, is taken for away: it closes nothing in, and takes no place from the fluid.  So
    a lid that is lifted and a piston that is drawn
    back open it, and a drum that turns about its axis, a lid that slides along itself and a paddle wheel
    within do not.
    """
    layout = census.layout
    if touches_air(layout) or any(kind.drains(layout.case) for kind in in_case(layout.case)):
        return True
    motions = (census.motions[part.number] for part in layout.parts if not part.flows)
    return any(goes_free(one) or is_rigid(one) for one in motions) and _opens(census)


def _opens(census: Census) -> bool:
    """Whether the place of the fluid grows, or opens."""
    room = _Room(census)
    before = room.size(0.0)
    if before is None:
        return True
    slack = max(LAYERS * room.faces, 1.0)
    fewest, most = LOOKS
    looks = min(max(LOOKED_AT // room.fluid.size, fewest), most)
    for time in moments(census.layout.case.time.end, looks):
        found = room.size(float(time))
        if found is None or found - before > slack:
            return True
    return False


class _Room:
    """The sites around a fluid, and which of them it can take.

    They are seen from the ``seat``, the motion of what touches most of the fluid, None of what is fixed;
    ``faces`` of them are of the fluid and beside something that moves relative to it.
    """

    def __init__(self, census: Census):
        self.census, self.layout = census, census.layout
        layout, (low, high) = census.layout, census.flow
        self.axes = tuple(range(layout.dimensions))
        self.around = [d for d in self.axes if layout.periods[d] is not None]
        self.mirrored = {(plane.axis, plane.side) for plane in layout.mirror_planes}
        self.grid = self._grid(low, high)
        self.shape = np.broadcast_shapes(*(x.shape for x in self.grid))
        self.points = np.stack([np.broadcast_to(x, self.shape).ravel() for x in self.grid], axis=1)
        self.fluid = layout.flows(layout.held(self.grid, self.shape))
        walls = [n for n in layout.parts.boundaries if not goes_free(self._motion(n))]
        self.moved: dict[Any, list[int]] = {}
        for n in walls:
            self.moved.setdefault(self._motion(n) if is_rigid(self._motion(n)) else None, []).append(n)
        faces = {motion: self._faces(parts) for motion, parts in self.moved.items()}
        self.seat = max(faces, key=faces.__getitem__, default=None)
        self.faces = sum(faces.values()) - faces.get(self.seat, 0)

    def size(self, time: float) -> int | None:
        """How many sites, seen from the seat, the fluid can take at ``time``, s; None if it can get out."""
        shut = self._held(time)
        part = connected([~shut], self.around)
        reached = np.unique(part[self.fluid & ~shut])
        place = np.isin(part, reached)
        for d in (d for d in self.axes if d not in self.around):
            for side, end in ((BELOW, 0), (ABOVE, -1)):
                if (d, side) not in self.mirrored and place.take(end, axis=d).any():
                    return None
        return int(np.count_nonzero(place))

    def _held(self, time: float) -> np.ndarray:
        """True at the sites that something holds which closes the fluid in."""
        dimensions = self.layout.dimensions
        points = self.points if self.seat is None else moved_on(self.seat, self.points, time, dimensions)
        held = np.zeros(self.shape, bool)
        for motion, parts in self.moved.items():
            if motion == self.seat:
                held |= self._inside(parts, self.grid)
                continue
            back = points if motion is None else taken_back(motion, points, time, dimensions)
            folded = [self.layout.folded(d, x).reshape(self.shape) for d, x in enumerate(back.T)]
            held |= self._inside(parts, folded)
        return held

    def _inside(self, parts: list[int], grid) -> np.ndarray:
        tolerance = TOLERANCE * self.layout.spacing
        return np.logical_or.reduce([inside(self.layout.parts[n].shape, grid, tolerance) for n in parts])

    def _faces(self, parts: list[int]) -> int:
        """How many sites of the fluid are beside some parts at the start."""
        held, beside = self._inside(parts, self.grid), np.zeros(self.shape, bool)
        for d in self.axes:
            ahead, behind = ([slice(None)] * len(self.axes) for _ in range(2))
            ahead[d], behind[d] = slice(1, None), slice(None, -1)
            beside[tuple(ahead)] |= held[tuple(behind)]
            beside[tuple(behind)] |= held[tuple(ahead)]
        return int(np.count_nonzero(beside & self.fluid))

    def _grid(self, low: np.ndarray, high: np.ndarray) -> list[np.ndarray]:
        """Coordinates of the sites, m: those of the fluid and some around, within mirrors and periods."""
        lattice, grid = self.layout.lattice, []
        for d in self.axes:
            first, last = sites_between(low[d], high[d] + lattice.spacing, lattice.origin[d], lattice.spacing)
            first, last = first - AROUND, last + AROUND
            if d in self.around:
                first, last = sites_between(
                    self.layout.lower[d], self.layout.upper[d], lattice.origin[d], lattice.spacing
                )
            for plane in (p for p in self.layout.mirror_planes if p.axis == d):
                below, above = sites_between(plane.at, plane.at, lattice.origin[d], lattice.spacing)
                first, last = (max(first, above), last) if plane.side == BELOW else (first, min(last, below))
            x = lattice.origin[d] + (np.arange(first, last) + 0.5) * lattice.spacing
            grid.append(x.reshape([-1 if k == d else 1 for k in self.axes]))
        return grid

    def _motion(self, n: int):
        return self.census.motions[n]
