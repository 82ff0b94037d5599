"""A periodic box of particles at rest, shifted at random from their lattice."""

import math
from typing import NamedTuple

from psph.case import Case
from psph.case.schemes import PLAIN
from psph.lab.bench import lammps_fluid
from psph.lab.bench.resolution import KERNEL, reach, smoothing
from psph.particles.store import Store
from psph.runs.setup import create_particles
from psph.simulation.plan import Plan

JITTER, SEED = 0.25, 1
"""Random shift in spacings (a perfect lattice flatters the caches), and where it is drawn from."""

SPEED, VISCOSITY = 50.0, 0.1
"""c in m/s, and α of the artificial viscosity."""

FEWEST_SIDES, CUTOFFS = 16, 4.0
"""The box is at least this wide in spacings, and in supports: neighbours must not meet twice."""


class FluidBox(NamedTuple):
    """A box of ``sides`` spacings along each axis, 1 m wide."""

    dimensions: int
    neighbours: int
    sides: int

    peer = lammps_fluid

    @classmethod
    def nearest(cls, dimensions: int, neighbours: int, particles: int) -> "FluidBox":
        """The box with about so many particles."""
        least = max(FEWEST_SIDES, math.ceil(CUTOFFS * reach(neighbours, dimensions)))
        return cls(dimensions, neighbours, max(least, round(particles ** (1.0 / dimensions))))

    def in_bulk(self, scene, simulation) -> int:
        """Neighbours of a particle in the interior."""
        return self.neighbours

    def case(self) -> Case:
        """The box as a case."""
        return Case.model_validate(self.tables())

    def tables(self) -> dict:
        """The same as the tables of a case."""
        corners = {"lower": [0.0] * self.dimensions, "upper": [1.0] * self.dimensions}
        return {
            "space": {
                "dimensions": self.dimensions,
                "spacing": 1.0 / self.sides,
                "smoothing": smoothing(self.neighbours, self.dimensions),
                "kernel": KERNEL,
                "periodic": ["x", "y", "z"][: self.dimensions],
                **corners,
            },
            "time": {"end": 1.0},
            "scheme": PLAIN,
            "physics": {"sound_speed": SPEED, "artificial_viscosity": VISCOSITY},
            "fluids": {"water": {"shape": {"box": corners}, "jitter": JITTER, "seed": SEED}},
        }

    def create(self, scene, plan: Plan, comm) -> Store:
        """This rank's share of the particles."""
        return create_particles(scene, plan, comm)
