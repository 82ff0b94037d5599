"""The layout: which part of a case holds which site of the lattice, in which domain.  The first value of a
scene: it follows from the case alone, before any site is looked at."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, reduce
from operator import attrgetter
from typing import Any

import numpy as np

from psph.case import Case
from psph.case.keys import AXES
from psph.case.motion import motion_of
from psph.case.parameters import as_numbers
from psph.case.placed import HardPlane
from psph.moments import normalised
from psph.particles.reach import Reach
from psph.physics.walls.conditions import MIRROR
from psph.scene.lattice import TOLERANCE, Lattice, lattice_around
from psph.scene.meshes.drawn import Drawn, drawn
from psph.scene.mirrors import around, clipped, planes_of
from psph.scene.parts import Part, Parts, parts_of
from psph.scene.parts.order import among
from psph.scene.shapes import Corner, Grid, bounds
from psph.smoothing import kernel
from psph.theory.solutions.catalogue import SOLUTIONS
from psph.theory.solutions.setting import Surroundings

NONE = 255
"""In place of a part: a site without a particle."""


@dataclass(frozen=True, eq=False)
class Layout:
    """Where the parts of a case are at the start: the first that claims a site has it.

    ``parts`` in their order; ``meshes`` the files of shapes; ``lattice`` the sites that may hold a particle;
    ``mirror_planes`` its mirrors; ``lower`` and ``upper`` the corners of the domain in m; ``kernel`` smooths.
    """

    case: Case
    meshes: tuple[Drawn, ...]
    kernel: Any
    parts: Parts
    mirror_planes: tuple[Any, ...]
    lattice: Lattice
    lower: Corner
    upper: Corner

    @property
    def dimensions(self) -> int:
        """Of space."""
        return self.case.space.dimensions

    @property
    def spacing(self) -> float:
        """Of the lattice, m."""
        return self.case.space.spacing

    @property
    def smoothing_length(self) -> float:
        """h, m."""
        return self.case.space.smoothing * self.case.space.spacing

    @property
    def axis(self) -> int:
        """The slab axis."""
        return self.lattice.axis

    @property
    def planes(self) -> int:
        """Of the lattice, across ``axis``."""
        return self.lattice.planes

    @cached_property
    def periods(self) -> tuple[float | None, ...]:
        """A length in m, or None, for each axis."""
        periodic = self.case.space.periodic
        ends = zip(AXES, self.lower, self.upper)
        return tuple(up - low if name in periodic else None for name, low, up in ends)

    @property
    def gravity(self) -> tuple[float, ...]:
        """g in m/s², zeros where the case has none."""
        return gravity_of(self.case)

    @cached_property
    def height_gravity(self) -> tuple[float, ...]:
        """g in m/s² along the axes that do not repeat, else zero: across a period there is no height,
        so a potential energy −m g·x would jump where a particle passes it."""
        return tuple(g if period is None else 0.0 for g, period in zip(self.gravity, self.periods))

    @property
    def driven(self) -> bool:
        """Whether gravity pulls along a periodic axis: what it can do there is not told by a height."""
        return self.gravity != self.height_gravity

    @cached_property
    def up(self) -> tuple[float, ...]:
        """The unit vector against gravity, but for what pulls along a periodic axis; zeros without."""
        pull = math.hypot(*self.height_gravity)
        return tuple(-g / pull if pull else 0.0 for g in self.height_gravity)

    @cached_property
    def frame(self):
        """How the frame of reference moves (psph.physics.rigid.motion.Rigid), or None."""
        return motion_of(self.case.frame.motion)

    @property
    def support(self) -> float:
        """Radius of the kernel, m."""
        return self.kernel.support * self.smoothing_length

    @property
    def reach(self) -> Reach:
        """How far particles feel and see each other: as far as the part that reaches farthest."""
        lists = self.case.neighbours
        whole = Reach.uniform(self.kernel, self.smoothing_length, lists.skin, lists.least_skin)
        contact = self.case.physics.contact is not None
        asked = (part.reach(whole, self.spacing, contact) for part in self.parts)
        return max(filter(None, asked), key=attrgetter("support"))

    @property
    def wall_reach(self) -> int:
        """Depth in sites to which a wall acts on a fluid, and one more."""
        return math.ceil(self.support / self.spacing) + 1

    @property
    def names(self) -> tuple[str, ...]:
        """Of all parts."""
        return tuple(part.name for part in self.parts)

    @cached_property
    def hard_planes(self) -> tuple[tuple[Corner, Corner], ...]:
        """A point in m of each rigid plane that the case has, and the unit vector out of it."""
        tables = (getattr(self.case, name).values() for name in self.case.tables_of(HardPlane))
        return tuple((one.at, one.outward) for table in tables for one in table)

    @cached_property
    def exact(self):
        """The exact solution that the case names, or None."""
        for name, table in self.case.exact:
            if table is not None:
                return SOLUTIONS[name](**as_numbers(table))
        return None

    @property
    def surroundings(self) -> Surroundings:
        """What the exact solution needs of the scene: its first fluid and the domain."""
        first = self.parts[0].table
        return Surroundings(
            dimensions=self.dimensions,
            density=first.density,
            densities=tuple(part.table.density for part in self.parts if part.flows),
            viscosity=first.viscosity,
            surface_tension=getattr(first, "surface_tension", None) or 0.0,
            gravity=self.gravity,
            lower=self.lower,
            upper=self.upper,
            periods=self.periods,
        )

    def folded(self, d: int, x: np.ndarray) -> np.ndarray:
        """Coordinates along axis ``d`` within the period there, m."""
        period, low = self.periods[d], self.lower[d]
        return x if period is None else x - period * np.floor((x - low) / period)

    def flows(self, held: np.ndarray) -> np.ndarray:
        """True where ``held`` is a part that flows."""
        return among(held, [part.number for part in self.parts if part.flows])

    def stands(self, held: np.ndarray) -> np.ndarray:
        """True where ``held`` is a part that does not flow: an elastic solid, a clamp, a wall, a body."""
        return (held != NONE) & ~self.flows(held)

    def masks(self, grid: Grid, shape: tuple[int, ...]) -> list[np.ndarray]:
        """For each part, True at the sites that it claims."""
        return self._masks(self.parts, grid, shape)

    def held_before_ends(self, grid: Grid, shape: tuple[int, ...]) -> np.ndarray:
        """Number of the part at each point as if there were no open ends, as :meth:`held`."""
        return first_claim(self._masks(self.parts[: self.parts.ends.start], grid, shape), shape)

    def _masks(self, parts: Sequence[Part], grid: Grid, shape: tuple[int, ...]) -> list[np.ndarray]:
        tolerance = TOLERANCE * self.spacing
        masks = [np.broadcast_to(part.claimed(self, grid, tolerance), shape) for part in parts]
        for part in (part for part in parts if part.of_another):
            whole = masks[part.whole]
            masks[part.number] = masks[part.number] & whole
            masks[part.whole] = whole & ~masks[part.number]
        taking = [masks[part.number] for part in parts if part.displaces]
        if not taking:
            return masks
        taken = reduce(np.logical_or, taking)
        return [mask & ~taken if part.flows else mask for part, mask in zip(parts, masks)]

    @cached_property
    def cell_counts(self) -> np.ndarray:
        """How many particles a site gets that is held by each part (256,); none where it is held by none."""
        counts = np.zeros(NONE + 1, np.int64)
        on_sites = (part.number not in self.placed for part in self.parts)
        counts[: len(self.parts)] = [
            sited * part.finer**self.dimensions for part, sited in zip(self.parts, on_sites)
        ]
        return counts

    @cached_property
    def placed(self) -> dict[int, np.ndarray]:
        """Where the particles of parts are that are on no sites (n, dim), m, by the numbers of the parts."""
        found = {part.number: part.places(self) for part in self.parts}
        return {number: places for number, places in found.items() if places is not None}

    @cached_property
    def begun(self) -> dict[int, dict[str, np.ndarray]]:
        """What else is told of these particles, fields by name (n, ...), by the numbers of the parts."""
        return {number: self.parts[number].begins(self) for number in self.placed}

    def materials(self, first: int, last: int) -> np.ndarray:
        """Number of the part at each site of some planes, uint8; the first that claims a site has it."""
        return self.held(self.lattice.grid(first, last), self.lattice.shape(first, last))

    def held(self, grid: Grid, shape: tuple[int, ...]) -> np.ndarray:
        """The same at any points, their coordinates broadcast to ``shape``; uint8."""
        return first_claim(self.masks(grid, shape), shape)

    def holds(self, part: int, position: np.ndarray) -> np.ndarray:
        """Whether a part has the points ``position`` (n, dim), m, within the domain; bool (n,)."""
        x = [self.folded(d, along) for d, along in enumerate(position.T)]
        inside = [(a >= low) & (a <= up) for a, low, up in zip(x, self.lower, self.upper)]
        return np.logical_and.reduce([self.held(x, x[0].shape) == part, *inside])

    def near(self, part: int, first: int, last: int, reach: int) -> np.ndarray:
        """True at the sites of some planes with a site of a part at most ``reach`` away.

        Counted along each axis, in sites.
        """
        begin, end = max(first - reach, 0), min(last + reach, self.lattice.planes)
        found = self.materials(begin, end) == part
        for axis in range(found.ndim):
            found = _spread(np.moveaxis(found, axis, 0), reach)
            found = np.moveaxis(found, 0, axis)
        return found[first - begin : last - begin]

    def touching(self, part: int, first: int, last: int) -> np.ndarray:
        """True at the sites of some planes that are of a part, or beside such a site along an axis."""
        begin, end = max(first - 1, 0), min(last + 1, self.lattice.planes)
        held = self.materials(begin, end) == part
        ways = (np.moveaxis(_spread(np.moveaxis(held, axis, 0), 1), 0, axis) for axis in range(held.ndim))
        return np.logical_or.reduce([*ways])[first - begin : last - begin]


def lay_out(case: Case) -> Layout:
    """The layout of a case.  Raises CaseError where a file draws no shape, or a mirror does not fit."""
    space, meshes = case.space, drawn(case)
    smooths = kernel(space.kernel, space.smoothing * space.spacing, space.dimensions)
    if space.normalised:
        smooths = normalised(smooths, space.spacing, space.dimensions)
    parts = parts_of(case, gravity_of(case))
    planes = planes_of(case, parts)
    axis = AXES.index(case.parallel.axis) if case.parallel.axis else None
    boxes = (clipped(bounds(part.shape), planes) for part in parts)
    lattice = lattice_around(boxes, space.origin, space.spacing, axis)
    mirrors = (bounds(wall.shape) for wall in case.walls.values() if wall.condition == MIRROR)
    found = around([(lattice.lower, lattice.upper), *mirrors])
    given = (ends if own is None else own for ends, own in zip(found, (space.lower, space.upper)))
    lower, upper = clipped(tuple(given), planes)
    return Layout(case, meshes, smooths, parts, planes, lattice, lower, upper)


def gravity_of(case: Case) -> tuple[float, ...]:
    """g in m/s², zeros where the case has none."""
    gravity = case.physics.gravity
    return gravity.acceleration if gravity else (0.0,) * case.space.dimensions


def _spread(held: np.ndarray, reach: int) -> np.ndarray:
    """True along the first axis wherever True is at most ``reach`` places away."""
    spread = held.copy()
    for step in range(1, min(reach, len(held) - 1) + 1):
        spread[step:] |= held[:-step]
        spread[:-step] |= held[step:]
    return spread


def first_claim(masks: Sequence[np.ndarray], shape: tuple[int, ...]) -> np.ndarray:
    """Number of the part at each site by the ``masks`` of all parts, uint8: the first that claims it."""
    found = np.full(shape, NONE, np.uint8)
    for part in reversed(range(len(masks))):
        found[masks[part]] = part
    return found
