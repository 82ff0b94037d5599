"""Fluids and walls: what they are made of, which sites they hold, and their state at the start."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import reduce
from typing import Any, NamedTuple

import numpy as np

from psph.case.shapes import Shape
from psph.fields import FLUID, WALL
from psph.physics.motion import is_free
from psph.physics.walls.conditions import BEARING, DYNAMIC, EXTRAPOLATED, PENALTY, REPULSIVE
from psph.scene.lattice import TOLERANCE, Lattice
from psph.scene.shapes import Grid, inside

NONE = 255
"""In place of a material: a site without a particle."""

FIRST_BODY = 2
"""Number of a first rigid body or elastic solid among solids: 0 is no solid, 1 a wall."""


class Species(NamedTuple):
    """What the particles of a named group of a case, a fluid or a wall, have in common.

    ``motion`` is how they move (psph.physics.motion); ``density`` at zero pressure in kg/m³;
    kinematic ``viscosity`` in m²/s; ``mass`` of a particle in kg (per m of depth in 2D, per m² in
    1D); ``law`` is the equation of state (psph.physics.fluid.state).  A wall takes these from the fluid
    it continues; ``no_slip`` if that fluid sticks to it; ``condition`` is what it sets to the fluid before it
    (psph.physics.walls.conditions); ``loaded`` where the fluid's push on it is asked for;
    ``rheology`` is the number of the law of its viscosity among those of the scene from 1 on, 0 where that is
    constant; ``solid`` is 0 for a fluid, 1 for a wall, and the number of a rigid body or elastic solid from 2
    on; ``elastic`` is the number of the elastic solid that it is of, or None; ``shear_modulus`` in Pa that of
    matter whose deviatoric stress evolves (psph.physics.stress), else 0; ``strength`` the number of the law
    that bounds this stress among those of the scene from 1 on, 0 where none does, and ``cone_tip`` in Pa the
    mean tension that leaves it no strength; ``wave_modulus`` in Pa is
    the P-wave modulus of an elastic solid, beside solids of a wall the largest of theirs, else 0;
    ``wave_speed`` in m/s is that of pressure waves in matter whose deviatoric stress evolves, else the
    numerical one; ``stress_diffusion`` and ``rest_coefficient`` K₀ are those of a soil, 0 and 1 else.
    """

    name: str
    motion: Any
    density: float
    viscosity: float
    mass: float
    law: Any
    no_slip: bool = False
    condition: str = DYNAMIC
    loaded: bool = False
    solid: int = 0
    rheology: int = 0
    elastic: int | None = None
    shear_modulus: float = 0.0
    strength: int = 0
    cone_tip: float = 0.0
    wave_modulus: float = 0.0
    wave_speed: float = 0.0
    stress_diffusion: float = 0.0
    rest_coefficient: float = 1.0

    @property
    def kind(self) -> int:
        """What frames tell them by: psph.fields."""
        return self.motion.kind

    @property
    def is_fluid(self) -> bool:
        """Whether it is a fluid."""
        return self.kind == FLUID

    @property
    def rubs(self) -> bool:
        """Whether it takes part in the friction of fluids: one with a viscosity, or a wall, which has that of
        the fluid before it.  On elastic solids, and on soils, a fluid slips."""
        return bool(self.viscosity or self.rheology) if self.is_fluid else self.kind == WALL

    @property
    def bearing(self) -> bool:
        """Whether its particles bear a pressure."""
        return self.condition in BEARING

    @property
    def extrapolated(self) -> bool:
        """Whether it is a wall whose pressure is that of the fluid before it."""
        return self.condition == EXTRAPOLATED

    @property
    def repulsive(self) -> bool:
        """Whether it is a wall whose particles repel the fluid."""
        return self.condition == REPULSIVE

    @property
    def penalty(self) -> bool:
        """Whether it is a wall that pushes back what comes too near."""
        return self.condition == PENALTY

    @property
    def mobile(self) -> bool:
        """Whether forces move it."""
        return is_free(self.motion)


class Start(NamedTuple):
    """State of a material before the first step.

    p = ``pressure`` everywhere, or ``exact`` of the positions (n, dim), or that of a ``layer`` under its own
    weight, of a fluid (psph.scene.still) or a soil (psph.scene.stressed).  ``law`` is the equation of state.
    """

    law: Any
    rest_density: float
    sound_speed: float
    pressure: float
    exact: Callable[[np.ndarray], np.ndarray] | None = None
    layer: Any = None

    def density(self, position: np.ndarray) -> np.ndarray:
        """ρ (n,) in kg/m³ at ``position`` (n, dim); NaN where the state knows none."""
        if self.exact:
            return self._density(self.exact(position))
        if self.layer:
            return self._density(self.layer.pressure(position))
        return np.full(len(position), self._density(np.float64(self.pressure)))

    def mass(self, volume: float) -> float:
        """Mass in kg of a particle of ``volume`` = dx^d.

        ρ(p) dx^d under a uniform pressure.  Where pressure differs from place to place ρ₀ dx^d:
        equal masses are what a fluid keeps when it moves.
        """
        if self.layer or self.exact:
            return self.rest_density * volume
        return float(self._density(np.float64(self.pressure))) * volume

    def _density(self, pressure):
        with np.errstate(invalid="ignore"):
            return self.law.density(pressure, self.rest_density, self.sound_speed)


@dataclass(frozen=True)
class Layout:
    """Which material holds which site: fluids first, then elastic solids, their clamped parts, walls, and
    bodies, in the order of the case.

    ``bodies`` of them, the last, take the place of fluids where both are, and so do the walls
    ``displacing``, by their numbers.  ``clamps`` has the number of the material that each clamped
    part belongs to.
    """

    lattice: Lattice
    shapes: tuple[Shape, ...]
    fluids: int
    bodies: int = 0
    solids: int = 0
    clamps: tuple[int, ...] = ()
    displacing: tuple[int, ...] = ()

    @property
    def movers(self) -> int:
        """How many materials move freely: these come first."""
        return self.fluids + self.solids

    @property
    def first_wall(self) -> int:
        """The number of the first wall."""
        return self.movers + len(self.clamps)

    def elastic_of(self, material: int) -> int | None:
        """The number of the elastic solid that a material is of, or None."""
        if not self.fluids <= material < self.first_wall:
            return None
        whole = material if material < self.movers else self.clamps[material - self.movers]
        return whole - self.fluids if whole >= self.fluids else None

    @property
    def first_body(self) -> int:
        """The number of the first body."""
        return len(self.shapes) - self.bodies

    def solid_of(self, material: int) -> int:
        """0 for a fluid, 1 for a wall, and another number for each elastic solid, or each body.

        Beside elastic solids bodies have that of walls: what is rigid feels its like by impulses alone.
        """
        if material < self.fluids:
            return 0
        if (elastic := self.elastic_of(material)) is not None:
            return elastic + FIRST_BODY
        if self.solids:
            return WALL
        return max(1, material - self.first_body + FIRST_BODY)

    def masks(self, grid: Grid, shape: tuple[int, ...]) -> list[np.ndarray]:
        """For each material, True at the sites that it claims."""
        tolerance = TOLERANCE * self.lattice.spacing
        masks = [np.broadcast_to(inside(s, grid, tolerance), shape) for s in self.shapes]
        for clamp, of in enumerate(self.clamps, self.movers):
            whole = masks[of]
            masks[clamp] = masks[clamp] & whole
            masks[of] = whole & ~masks[clamp]
        taking = [*(masks[wall] for wall in self.displacing), *masks[self.first_body :]]
        if not taking:
            return masks
        taken = reduce(np.logical_or, taking)
        return [mask & ~taken for mask in masks[: self.fluids]] + masks[self.fluids :]

    def materials(self, first: int, last: int) -> np.ndarray:
        """Material of each site of some planes, uint8; the first that claims a site has it."""
        return self.held(self.lattice.grid(first, last), self.lattice.shape(first, last))

    def held(self, grid: Grid, shape: tuple[int, ...]) -> np.ndarray:
        """Material at any points, their coordinates broadcast to ``shape``; uint8."""
        return _first_claim(self.masks(grid, shape), shape)

    def near(self, material: int, first: int, last: int, reach: int) -> np.ndarray:
        """True at the sites of some planes with a site of ``material`` at most ``reach`` away.

        Counted along each axis, in sites.
        """
        begin, end = max(first - reach, 0), min(last + reach, self.lattice.planes)
        found = self.materials(begin, end) == material
        for axis in range(found.ndim):
            found = _spread(np.moveaxis(found, axis, 0), reach)
            found = np.moveaxis(found, 0, axis)
        return found[first - begin : last - begin]

    def touching(self, material: int, first: int, last: int) -> np.ndarray:
        """True at the sites of some planes that are of ``material``, or beside such a site along an axis."""
        begin, end = max(first - 1, 0), min(last + 1, self.lattice.planes)
        held = self.materials(begin, end) == material
        ways = (np.moveaxis(_spread(np.moveaxis(held, axis, 0), 1), 0, axis) for axis in range(held.ndim))
        return np.logical_or.reduce([*ways])[first - begin : last - begin]


def _spread(held: np.ndarray, reach: int) -> np.ndarray:
    """True along the first axis wherever True is at most ``reach`` places away."""
    spread = held.copy()
    for step in range(1, min(reach, len(held) - 1) + 1):
        spread[step:] |= held[:-step]
        spread[:-step] |= held[step:]
    return spread


def _first_claim(masks: Sequence[np.ndarray], shape: tuple[int, ...]) -> np.ndarray:
    found = np.full(shape, NONE, np.uint8)
    for material in reversed(range(len(masks))):
        found[masks[material]] = material
    return found


@dataclass
class Census:
    """What one look at every site tells.  Materials in the order of :class:`Layout`.

    ``counts`` (planes,) particles; ``sizes`` (materials,) sites inside each shape; ``lowest``,
    ``highest`` (materials, dim) their extreme coordinates, m; ``bottom``, ``top`` (materials,) the
    same along the upward direction; ``clashes``: pairs of materials that claim the same site, with
    one such site.
    """

    counts: np.ndarray
    sizes: np.ndarray
    lowest: np.ndarray
    highest: np.ndarray
    bottom: np.ndarray
    top: np.ndarray
    clashes: dict[tuple[int, int], tuple[float, ...]] = field(default_factory=dict)


def take_census(layout: Layout, up: Sequence[float]) -> Census:
    """Look at every site, chunk by chunk; ``up`` is the unit vector against gravity or zeros."""
    lattice, n, dimensions = layout.lattice, len(layout.shapes), len(layout.lattice.counts)
    census = Census(
        np.zeros(lattice.planes, np.int64),
        np.zeros(n, np.int64),
        np.full((n, dimensions), np.inf),
        np.full((n, dimensions), -np.inf),
        np.full(n, np.inf),
        np.full(n, -np.inf),
    )
    for first, last in lattice.chunks():
        grid, shape = lattice.grid(first, last), lattice.shape(first, last)
        masks = layout.masks(grid, shape)
        held = reduce(np.logical_or, masks)
        census.counts[first:last] = np.count_nonzero(held.reshape(last - first, -1), axis=1)
        height = np.broadcast_to(sum(x * u for x, u in zip(grid, up)), shape)
        for material, mask in enumerate(masks):
            if mask.any():
                _measure(census, material, mask, lattice, grid, height)
                _find_clashes(census, material, masks, grid)
    return census


def _measure(census, material, mask, lattice, grid, height) -> None:
    census.sizes[material] += np.count_nonzero(mask)
    for place, d in enumerate(lattice.axes):
        others = tuple(k for k in range(mask.ndim) if k != place)
        x = grid[d].ravel()[mask.any(axis=others)]
        census.lowest[material, d] = min(census.lowest[material, d], x[0])
        census.highest[material, d] = max(census.highest[material, d], x[-1])
    heights = height[mask]
    census.bottom[material] = min(census.bottom[material], heights.min())
    census.top[material] = max(census.top[material], heights.max())


def _find_clashes(census, material, masks, grid) -> None:
    for other in range(material):
        if (other, material) not in census.clashes:
            both = masks[other] & masks[material]
            if both.any():
                site = np.unravel_index(np.argmax(both), both.shape)
                census.clashes[other, material] = tuple(
                    float(np.broadcast_to(x, both.shape)[site]) for x in grid
                )
