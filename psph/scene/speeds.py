"""The speeds of a scene: how fast things are at the start and will be, and so how fast sound has to be.  The
third value of a scene."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from psph.case import CaseError
from psph.case.study import EXACT
from psph.kinds import in_case
from psph.physics.facts import SOUND_OVER_SPEED
from psph.scene.census import Census
from psph.scene.layout import Layout
from psph.scene.moving import falling_speed, fastest_corner, largest_speed
from psph.scene.perturbations import kicked_velocities, kicks_of


@dataclass(frozen=True, eq=False)
class Speeds:
    """How fast the parts of a layout start and move, by its ``census``, m/s."""

    census: Census

    @property
    def layout(self) -> Layout:
        """Of the census."""
        return self.census.layout

    @cached_property
    def velocities(self) -> tuple[tuple[float, ...], ...]:
        """Velocity of each part at the start, m/s; zeros where it differs by place."""
        still = (0.0,) * self.layout.dimensions
        told = (part.table.velocity for part in self.layout.parts)
        return tuple(still if velocity == EXACT else velocity for velocity in told)

    @cached_property
    def kicks(self) -> dict[tuple[int, int], np.ndarray]:
        """For the particle at (plane, place in the plane) what is added to its velocity, m/s, and
        to its position, m (2, dim)."""
        return kicks_of(self.layout)

    @cached_property
    def expected(self) -> float:
        """The largest speed to come as far as it can be told, m/s: the undriven one, and what gravity along
        a periodic axis drives, where no exact solution says how fast that is."""
        kinds = () if self.layout.exact else in_case(self.layout.case)
        return max([self.undriven, *(kind.driven_speed(self.census) for kind in kinds)])

    @cached_property
    def undriven(self) -> float:
        """The largest of √(2gH), free fall over the height of all that moves freely (with the acceleration of
        the frame beside g), and any speed of the start or of what moves as it is told, m/s."""
        return max(falling_speed(self.census), self.starting, largest_speed(self.census))

    @cached_property
    def starting(self) -> float:
        """The largest speed of a fluid, a wall or the exact solution at the start, m/s."""
        exact, parts = self.layout.exact, self.layout.parts
        known = exact.top_speed(self.layout.surroundings) if exact else 0.0
        kicked = kicked_velocities(self.layout, self.kicks, self.velocities)
        moving = (math.hypot(*v) for v in (*self.velocities, *kicked))
        sheared = (fastest_corner(self.census, n, self.velocities[n]) for n in parts.movers)
        return max(known, *moving, *sheared, *(part.fastest for part in parts))

    @cached_property
    def sound_speed(self) -> float:
        """c in m/s: as given, else ten times the expected speed, and enough for a creeping flow and for
        surface tension; no less than the fastest wave of what flows and has moduli; that, or the one of
        solids, where all have some.

        Raises CaseError where nothing moves and nothing falls.
        """
        case = self.layout.case
        movers = [part for part in self.layout.parts if part.moves_freely]
        heard = [part.wave_speed for part in movers if part.flows] or [part.wave_speed for part in movers]
        waves = max(heard)
        if all(heard):
            return waves
        given = case.physics.sound_speed
        creeping = [kind.creeping_speed(self.census) for kind in in_case(case)]
        if given is None and not max(self.expected, *creeping) > 0.0:
            raise CaseError(
                [
                    f"{case.file}: physics.sound_speed: missing, and it cannot be derived since "
                    "nothing moves at the start and there is no gravity; give ten times the largest "
                    "speed that you expect"
                ]
            )
        return max(given or SOUND_OVER_SPEED * max(self.expected, *creeping), waves)
