"""The state in which the parts of a scene start, and what their particles are.  The fourth value of a
scene."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from psph.case.study import EXACT
from psph.kinds import in_case
from psph.scene.census import Census
from psph.scene.layout import Layout
from psph.scene.parts import Known
from psph.scene.species import Species, Start
from psph.scene.speeds import Speeds
from psph.theory.solutions.setting import Setting


@dataclass(frozen=True, eq=False)
class Starts:
    """The state of the parts before the first step: it follows from their ``speeds`` and the census."""

    speeds: Speeds

    @property
    def census(self) -> Census:
        """Of the speeds."""
        return self.speeds.census

    @property
    def layout(self) -> Layout:
        """Of the census."""
        return self.speeds.layout

    @cached_property
    def setting(self) -> Setting:
        """What the exact solution needs of the scene, the speed of sound with it."""
        return Setting(**vars(self.layout.surroundings), sound_speed=self.speeds.sound_speed)

    @cached_property
    def materials(self) -> dict[str, Any]:
        """What kinds of matter are made of, by their names (psph.kinds)."""
        made = ((kind.name, kind.materials(self.speeds)) for kind in in_case(self.layout.case))
        return {name: one for name, one in made if one is not None}

    @cached_property
    def rheologies(self) -> tuple[Any, ...]:
        """The laws of viscosities that depend on the rate of strain (psph.physics.fluid.rheology)."""
        laws = (part.rheology for part in self.layout.parts)
        return tuple(dict.fromkeys(law for law in laws if law is not None))

    @cached_property
    def strengths(self) -> tuple[Any, ...]:
        """The different laws that bound an evolved stress (psph.physics.stress.strength)."""
        laws = (part.strength(self.layout.gravity) for part in self.layout.parts)
        return tuple(dict.fromkeys(law for law in laws if law is not None))

    @cached_property
    def layers(self) -> dict[int, Any]:
        """How each part starts that is under its own weight, by its number (psph.kinds)."""
        found: dict[int, Any] = {}
        for kind in in_case(self.layout.case):
            found |= kind.layers(self.census)
        return found

    @cached_property
    def states(self) -> tuple[Start, ...]:
        """The state of each part before the first step; a wall's is that of its fluid."""
        return tuple(self._start(part.source) for part in self.layout.parts)

    @cached_property
    def species(self) -> tuple[Species, ...]:
        """What the particles of each part are."""
        layout, volume = self.layout, self.layout.spacing**self.layout.dimensions
        known = Known(
            self.speeds.sound_speed,
            self.rheologies,
            self.strengths,
            tuple(part.wave_modulus for part in layout.parts if part.keeps_neighbours),
            self.census.lowest,
            self.census.highest,
            layout.gravity,
            layout.spacing,
        )
        return tuple(
            Species(
                name=part.name,
                motion=motion,
                mass=part.particle_mass(start.mass(volume), layout),
                one_mass=part.one_mass,
                cell_count=part.finer**layout.dimensions,
                law=start.law,
                loaded=part.loaded,
                solid=part.solid,
                bonded=part.bonded,
                **layout.parts[part.source].shown(known),
                **part.own(known),
            )
            for part, motion, start in zip(layout.parts, self.census.motions, self.states)
        )

    @cached_property
    def has_free_surface(self) -> bool:
        """Whether a fluid has a free surface at the start, or can have one (psph.kinds)."""
        return any(kind.has_free_surface(self.census) for kind in in_case(self.layout.case))

    @property
    def lowest_pressure(self) -> float:
        """The lowest pressure of a fluid at the start, Pa."""
        return min(lowest for lowest, _ in self._pressures)

    @cached_property
    def standing_tension(self) -> float:
        """Pa by which a fluid lacks pressure at the start everywhere: what its own flow does not explain.

        Of a fluid whose pressure follows from a flow (an exact solution), its highest pressure below zero;
        of others the lowest.
        """
        borne = (
            highest if start.exact else lowest
            for start, (lowest, highest) in zip(self.states, self._pressures)
        )
        return max(0.0, -min(borne))

    @cached_property
    def fullness(self) -> tuple[float, float]:
        """Smallest and largest m/(ρ dx^d) of a fluid at the start, with 1 among them.

        Equal masses do not fill the lattice where the pressure differs from place to place.
        """
        filled, volume = [1.0], self.layout.spacing**self.layout.dimensions
        flowing = (part.number for part in self.layout.parts if part.flows)
        for fluid, pressures in zip(flowing, self._pressures):
            start, mass = self.states[fluid], self.species[fluid].mass
            for pressure in pressures:
                rho = start.law.density(np.float64(pressure), start.rest_density, start.sound_speed)
                filled.append(mass / volume / float(rho))
        return min(filled), max(filled)

    def _start(self, number: int) -> Start:
        """The state of a part that others have too."""
        part = self.layout.parts[number]
        pressure = part.table.pressure
        return Start(
            law=part.law(self.layout.case),
            rest_density=part.table.density,
            sound_speed=part.own_sound_speed or self.speeds.sound_speed,
            pressure=0.0 if isinstance(pressure, str) else pressure,
            exact=(lambda x: self.layout.exact.pressure(x, 0.0, self.setting)) if pressure == EXACT else None,
            layer=self.layers.get(number),
        )

    @cached_property
    def _pressures(self) -> tuple[tuple[float, float], ...]:
        """The lowest and the highest pressure of each fluid at the start, Pa."""
        return tuple(self._range_of_pressure(part.number) for part in self.layout.parts if part.flows)

    def _range_of_pressure(self, fluid: int) -> tuple[float, float]:
        start, layout = self.states[fluid], self.layout
        if start.layer:
            return start.pressure, start.layer.highest
        if not start.exact:
            return start.pressure, start.pressure
        found = []
        for first, last in layout.lattice.chunks():
            held = layout.materials(first, last) == fluid
            grid = layout.lattice.grid(first, last)
            found.append(np.stack([np.broadcast_to(x, held.shape)[held] for x in grid], axis=1))
        pressure = start.exact(np.concatenate(found))
        return float(pressure.min()), float(pressure.max())
