"""Fluids and walls: what they are made of, which sites they hold, and their state at the start."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from psph.fields import WALL
from psph.physics.motion import ends_fluid, flows, follows, is_free
from psph.physics.walls.conditions import BEARING, DYNAMIC, EXTRAPOLATED, PENALTY, REPULSIVE


class Species(NamedTuple):
    """What the particles of a named group of a case, a fluid or a wall, have in common.

    ``motion`` is how they move (psph.physics.motion); ``density`` at zero pressure in kg/m³;
    kinematic ``viscosity`` in m²/s; ``mass`` of a particle in kg (per m of depth in 2D, per m² in
    1D), the mean where they have not ``one_mass``; ``law`` is the equation of state
    (psph.physics.fluid.state).  A wall takes these from the fluid
    it continues; ``no_slip`` if that fluid sticks to it; ``condition`` is what it sets to the fluid before it
    (psph.physics.walls.conditions); ``loaded`` where the fluid's push on it is asked for;
    ``rheology`` is the number of the law of its viscosity among those of the scene from 1 on, 0 where that is
    constant; ``solid`` is 0 for a fluid, 1 for a wall, and the number of a rigid body or elastic solid from 2
    on; ``bonded`` is the number of the elastic solid that it is of, or None; ``shear_modulus`` in Pa that of
    matter whose deviatoric stress evolves (psph.physics.stress), else 0; ``strength`` the number of the law
    that bounds this stress among those of the scene from 1 on, 0 where none does, and ``cone_tip`` in Pa the
    mean tension that leaves it no strength; ``wave_modulus`` in Pa is
    the P-wave modulus of an elastic solid, beside solids of a wall the largest of theirs, else 0;
    ``wave_speed`` in m/s is that of pressure waves in matter whose deviatoric stress evolves, else the
    numerical one; ``own_mass`` in kg that of a particle of an elastic solid, which shows a fluid another one;
    ``stress_diffusion`` and ``rest_coefficient`` K₀ are those of a soil, 0 and 1 else; ``cell_count`` is the
    number of particles that fill a cell of the lattice, more than 1 in a solid of a finer spacing;
    ``sound_speed`` in m/s is the numerical one; ``fluid`` is the number of a fluid among those of the case
    from 1 on, 0 of what is none, and ``tensions`` in N/m are first its surface tension and then those between
    it and each fluid, in this order; empty where the case tells none; ``wetting`` is the cosine of the angle
    at which surfaces of fluids meet a wall or a body, the mean of those of lines that advance and recede, and
    ``wetting_range`` half of their difference; ``level`` is that of its size (psph.scene.levels).
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
    bonded: int | None = None
    shear_modulus: float = 0.0
    strength: int = 0
    cone_tip: float = 0.0
    wave_modulus: float = 0.0
    wave_speed: float = 0.0
    stress_diffusion: float = 0.0
    rest_coefficient: float = 1.0
    own_mass: float = 0.0
    cell_count: int = 1
    sound_speed: float = 0.0
    fluid: int = 0
    tensions: tuple[float, ...] = ()
    wetting: float = 0.0
    one_mass: bool = True
    wetting_range: float = 0.0
    level: int = 0

    @property
    def inertia(self) -> float:
        """The true mass of a particle, kg."""
        return self.own_mass or self.mass

    @property
    def kind(self) -> int:
        """What frames tell them by: psph.fields."""
        return self.motion.kind

    @property
    def is_fluid(self) -> bool:
        """Whether it is a fluid, to its neighbours."""
        return flows(self.motion)

    @property
    def rubs(self) -> bool:
        """Whether it takes part in the friction of fluids: one with a viscosity, or a wall, which has that of
        the fluid before it, as an elastic solid has to which the fluid sticks.  On soils a fluid slips."""
        if self.is_fluid:
            return bool(self.viscosity or self.rheology)
        return self.kind == WALL or self.no_slip

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

    @property
    def ends_fluid(self) -> bool:
        """Whether it stands behind an open end."""
        return ends_fluid(self.motion)

    @property
    def follows(self) -> bool:
        """Whether it goes with particles of another size."""
        return follows(self.motion)


class Start(NamedTuple):
    """State of a material before the first step.

    p = ``pressure`` everywhere, or ``exact`` of the positions (n, dim), or that of a ``layer`` under its own
    weight, of a fluid (psph.scene.fluid.still) or a soil (psph.scene.stressed).  ``law`` is the equation of
    state.
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
