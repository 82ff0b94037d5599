"""The dam break of the bench: a column of water in a tank, on a lattice of any fineness."""

import math
from typing import NamedTuple

from psph.case import Case
from psph.case.schemes import PLAIN
from psph.lab.bench import lammps_fluid
from psph.lab.bench.resolution import KERNEL, reach, smoothing
from psph.particles.store import Store
from psph.runs.setup import create_particles
from psph.simulation.plan import Plan

HEIGHT, GRAVITY = 1.0, 9.81
"""Height, width and depth of the column, m, and g, m/s²."""

LENGTH, RIM = 3, 1.25
"""Length and height of the tank in column widths: half-way down nothing has met the far wall."""

VISCOSITY = 0.1
"""α of the artificial viscosity."""

FEWEST_ACROSS = 4
"""Spacings across the smallest column."""


class Tank(NamedTuple):
    """A column ``across`` spacings wide, high and (in 3D) deep, in a tank ``tall`` spacings high.

    The tank is as deep as the column; its walls fill the support of ``neighbours`` particles.
    """

    dimensions: int
    neighbours: int
    across: int
    tall: int

    peer = lammps_fluid

    @classmethod
    def nearest(cls, dimensions: int, neighbours: int, particles: int, times: int = 1) -> "Tank":
        """The tank with about so many particles, a multiple of ``times`` sites along each axis."""
        most = max(FEWEST_ACROSS, math.ceil(particles ** (1.0 / dimensions) / times)) + 1
        tanks = [
            cls(dimensions, neighbours, n, math.ceil(RIM * n)).refined(times)
            for n in range(FEWEST_ACROSS, most)
        ]
        return min(tanks, key=lambda tank: abs(tank.particles - particles))

    @property
    def spacing(self) -> float:
        """Distance of neighbouring sites, m."""
        return HEIGHT / self.across

    @property
    def hollow(self) -> tuple[int, ...]:
        """Sites between the walls along each axis."""
        return (LENGTH * self.across, *(self.across,) * (self.dimensions - 2), self.tall)

    @property
    def layers(self) -> int:
        """Layers of a wall."""
        return math.ceil(reach(self.neighbours, self.dimensions))

    @property
    def particles(self) -> int:
        """Water and walls together."""
        *around, tall = self.hollow
        outside = math.prod(n + 2 * self.layers for n in around) * (tall + self.layers)
        return self.across**self.dimensions + outside - math.prod(self.hollow)

    def refined(self, times: int) -> "Tank":
        """The same tank with ``times`` sites in place of one along each axis."""
        return self._replace(across=times * self.across, tall=times * self.tall)

    def in_bulk(self, scene, simulation) -> int:
        """Neighbours of a particle in the interior."""
        return self.neighbours

    def case(self) -> Case:
        """The column at rest, its pressure hydrostatic, at the start of the dam break."""
        return Case.model_validate(self.tables())

    def tables(self) -> dict:
        """The same as the tables of a case."""
        thick, zeros = self.layers * self.spacing, [0.0] * self.dimensions
        upper = [n * self.spacing for n in self.hollow]
        body = {
            "lower": [-thick] * self.dimensions,
            "upper": [*(x + thick for x in upper[:-1]), upper[-1]],
        }
        column = {"lower": zeros, "upper": [HEIGHT] * self.dimensions}
        tank = {"from": {"box": body}, "minus": [{"box": {"lower": zeros, "upper": upper}}]}
        return {
            "space": {
                "dimensions": self.dimensions,
                "spacing": self.spacing,
                "smoothing": smoothing(self.neighbours, self.dimensions),
                "kernel": KERNEL,
            },
            "time": {"end": 1.0},
            "scheme": PLAIN,
            "physics": {
                "gravity": [*zeros[1:], -GRAVITY],
                "artificial_viscosity": VISCOSITY,
            },
            "fluids": {"water": {"shape": {"box": column}, "pressure": "hydrostatic"}},
            "walls": {"tank": {"shape": {"difference": tank}}},
        }

    def create(self, scene, plan: Plan, comm) -> Store:
        """This rank's share of the particles."""
        return create_particles(scene, plan, comm)
