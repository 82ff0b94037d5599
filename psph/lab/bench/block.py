"""A block of rubber that spins: an elastic solid by total Lagrangian SPH."""

from typing import NamedTuple

from psph.case import Case
from psph.lab.bench import lammps_solid
from psph.particles.store import Store
from psph.runs.setup import create_particles
from psph.scene.sites import sites_within
from psph.simulation.plan import Plan

DENSITY, YOUNG, POISSON, SPIN = 1100.0, 17.0e6, 0.45, 5.0
"""kg/m³, Pa, 1, and 1/s: the rubber that solid codes are usually tried with, in a slow turn."""

JITTER, SEED = 0.1, 1
"""Random shift in spacings (a perfect lattice flatters the caches), and where it is drawn from."""


class Block(NamedTuple):
    """A square or cube of ``sides`` spacings along each axis, 1 m wide."""

    dimensions: int
    sides: int

    peer = lammps_solid

    @classmethod
    def nearest(cls, dimensions: int, neighbours: int, particles: int) -> "Block":
        """The block with about so many particles; their ``neighbours`` are those of every solid."""
        return cls(dimensions, max(1, round(particles ** (1.0 / dimensions))))

    def in_bulk(self, scene, simulation) -> float:
        """Neighbours of a particle in the interior, in the reference."""
        return sites_within(scene, lammps_solid.support(scene, simulation))

    def case(self) -> Case:
        """The block as a case."""
        return Case.model_validate(self.tables())

    def tables(self) -> dict:
        """The same as the tables of a case."""
        d = self.dimensions
        turn = [[0.0] * d for _ in range(d)]
        turn[0][1], turn[1][0] = -SPIN, SPIN
        block = {
            "shape": {"box": {"lower": [-0.5] * d, "upper": [0.5] * d}},
            "density": DENSITY,
            "young": YOUNG,
            "poisson": POISSON,
            "velocity_gradient": turn,
            "jitter": JITTER,
            "seed": SEED,
        }
        return {
            "space": {"dimensions": d, "spacing": 1.0 / self.sides},
            "time": {"end": 1.0},
            "solids": {"block": block},
        }

    def create(self, scene, plan: Plan, comm) -> Store:
        """This rank's share of the particles."""
        return create_particles(scene, plan, comm)
