"""A blast in an ideal gas: heat in a ball of a periodic box, whose particles have sizes of their own."""

from typing import NamedTuple

from psph.case import Case
from psph.lab.bench.box import CUTOFFS, FEWEST_SIDES
from psph.lab.bench.resolution import KERNEL, reach, smoothing
from psph.particles.store import Store
from psph.runs.setup import create_particles
from psph.simulation.plan import Plan

JITTER, SEED = 0.25, 1
"""Random shift in spacings (a perfect lattice flatters the caches), and where it is drawn from."""

RADIUS, HOT, COLD = 0.25, 100, 1
"""The radius of the ball, m, and the thermal energy in it and around it, J/kg."""


class Blast(NamedTuple):
    """A box of ``sides`` spacings along each axis, 1 m wide."""

    dimensions: int
    neighbours: int
    sides: int

    peer = None

    @classmethod
    def nearest(cls, dimensions: int, neighbours: int, particles: int) -> "Blast":
        """The box with about so many particles."""
        least = max(FEWEST_SIDES, round(CUTOFFS * reach(neighbours, dimensions)) + 1)
        return cls(dimensions, neighbours, max(least, round(particles ** (1.0 / dimensions))))

    def in_bulk(self, scene, simulation) -> int:
        """Neighbours of a particle where all are of one size."""
        return self.neighbours

    def case(self) -> Case:
        """The blast as a case."""
        return Case.model_validate(self.tables())

    def tables(self) -> dict:
        """The same as the tables of a case."""
        d = self.dimensions
        corners = {"lower": [-0.5] * d, "upper": [0.5] * d}
        gas = {
            "shape": {"box": corners},
            "density": 1.0,
            "thermal_energy": f"{HOT} if r < {RADIUS} else {COLD}",
            "jitter": JITTER,
            "seed": SEED,
        }
        return {
            "space": {
                "dimensions": d,
                "spacing": 1.0 / self.sides,
                "smoothing": smoothing(self.neighbours, d),
                "kernel": KERNEL,
                "periodic": ["x", "y", "z"][:d],
                **corners,
            },
            "time": {"end": 1.0},
            "scheme": "gas",
            "ideal_gases": {"gas": gas},
        }

    def create(self, scene, plan: Plan, comm) -> Store:
        """This rank's share of the particles."""
        return create_particles(scene, plan, comm)
