"""A dam break half-way through its fall: a coarse one falls, then each particle is split up."""

import itertools
import math
from typing import NamedTuple

import numpy as np
from numpy.random import Generator, Philox

from psph.case import Case
from psph.fields import FLUID, WALL
from psph.lab.bench import lammps_fluid
from psph.lab.bench.tank import GRAVITY, HEIGHT, Tank
from psph.output.interpolation import interpolated
from psph.output.ledger import Ledger
from psph.particles.store import Store
from psph.runs.footprint import slab_planes
from psph.runs.setup import create_particles, lattice_particles, store_of
from psph.scene import Scene
from psph.scene.particles import NUMBERS_PER_COUNT, ParticleSet
from psph.simulation.plan import Plan, make_plan
from psph.simulation.step import Simulation

FALLEN = 1.5
"""T = t √(g/H) at which the column is half-way down."""

COARSEST = {2: 64, 3: 24}
"""Spacings across the largest column that falls: a finer one would take minutes."""

JITTER, SEED = 0.1, 1
"""Random shift in the new spacings (a lattice in each parent flatters), and where it is drawn."""

NEAREST = 0.5
"""A parent nearer to a wall than this, in its own spacings, is split as if it were at this distance, since
a compressed film at a wall would fly apart."""


class Falling(NamedTuple):
    """The refined tank of ``coarse``, ``times`` as many sites along each axis, half-way down."""

    coarse: Tank
    times: int

    peer = lammps_fluid

    @classmethod
    def nearest(cls, dimensions: int, neighbours: int, particles: int) -> "Falling":
        """The one with about so many particles, split by 2, 4, 8... along each axis."""
        times = 1
        while True:
            times *= 2
            fine = Tank.nearest(dimensions, neighbours, particles, times)
            coarse = fine._replace(across=fine.across // times, tall=fine.tall // times)
            if coarse.across <= COARSEST[dimensions]:
                return cls(coarse, times)

    def in_bulk(self, scene, simulation) -> int:
        """Neighbours of a particle in the interior."""
        return self.coarse.neighbours

    def case(self) -> Case:
        """The fine tank with its walls; the water is still a column at rest."""
        return Case.model_validate(self.tables())

    def tables(self) -> dict:
        """The same as the tables of a case."""
        return self.coarse.refined(self.times).tables()

    def create(self, scene, plan: Plan, comm) -> Store:
        """This rank's share of the particles, the same for any number of ranks.  Collective."""
        coarse = Scene(self.coarse.case())
        fallen = fall(coarse, comm)
        walls = lattice_particles(scene, comm)
        walls = _chosen(walls, walls.kind == WALL)
        walls.density[:] = _wall_density(coarse, fallen)[_sites(coarse, walls.position)]
        water = _chosen(fallen, fallen.kind == FLUID)
        shares = len(water.id) * np.arange(comm.size + 1) // comm.size
        mine = water.rows(shares[comm.rank], shares[comm.rank + 1])
        children = self._split(mine, int(shares[comm.rank]), int(scene.census.counts.sum()))
        children.velocity[:] = interpolated(  # else a list would wear at once where parents meet
            water.position, water.velocity, children.position, self.coarse.spacing, coarse.layout.periods
        )
        both = zip(vars(children).values(), vars(walls).values())
        return store_of(scene, plan, ParticleSet(*map(np.concatenate, both)))

    def _split(self, parents: ParticleSet, first: int, first_id: int) -> ParticleSet:
        """The children of some parents, the ``first``-th on, numbered from ``first_id``.

        On a lattice of the new spacing around the parent, and shaken; with the parent's density.
        """
        dimensions, times = self.coarse.dimensions, self.times
        along = (np.arange(times) + 0.5) / times - 0.5
        lattice = np.array(list(itertools.product(along, repeat=dimensions)))
        n, many = len(parents.id), len(lattice)
        source = Philox(key=SEED)
        source.advance(first * many)
        drawn = Generator(source).random((n, many, NUMBERS_PER_COUNT))[..., :dimensions]
        offsets = lattice + (2.0 * drawn - 1.0) * (JITTER / times)
        centres = self._off_the_walls(parents.position)
        made = ParticleSet(*(np.repeat(array, many, axis=0) for array in vars(parents).values()))
        around = offsets * self.coarse.spacing
        made.position[:] = (centres[:, None] + around).reshape(-1, dimensions)
        made.id[:] = first_id + first * many + np.arange(n * many)
        made.mass[:] /= many
        return made

    def _off_the_walls(self, position: np.ndarray) -> np.ndarray:
        """Places of parents, so far inside the tank that no child comes to lie in a wall."""
        dx = self.coarse.spacing
        upper = dx * np.array(self.coarse.hollow, dtype=float)
        upper[-1] = math.inf  # no lid
        return np.clip(position, NEAREST * dx, upper - NEAREST * dx)


def fall(coarse: Scene, comm) -> ParticleSet:
    """All particles of a tank half-way through its fall, by id, on every rank; collective.

    A coarse tank may have fewer planes than there are ranks: the others wait.
    """
    falls = comm.rank < slab_planes(coarse)
    crew = comm.Split(0 if falls else 1, comm.rank)
    state = None
    if falls:
        plan = make_plan(coarse)
        simulation = Simulation(coarse, plan, create_particles(coarse, plan, crew), crew, Ledger())
        end = FALLEN * math.sqrt(HEIGHT / GRAVITY)
        while simulation.time < end:
            simulation.step()
        names = ("id", "kind", "position", "velocity", "density")
        parts = crew.gather([simulation.store.owned_rows(name) for name in names])
        if crew.rank == 0:
            state = [np.concatenate(column) for column in zip(*parts)]
    crew.Free()
    return _by_id(coarse, *comm.bcast(state))


def _by_id(scene: Scene, ids, kind, position, velocity, density) -> ParticleSet:
    """Rows in the order of the lattice; the scene knows their material and mass."""
    order = np.argsort(ids)
    water, tank = range(len(scene.species))
    material = np.where(kind == FLUID, water, tank).astype(np.uint8)
    mass = np.array([m.mass for m in scene.species])[material]
    columns = (ids, kind, material, position, velocity, density, mass)
    return ParticleSet(*(column[order] for column in columns))


def _chosen(particles: ParticleSet, mask: np.ndarray) -> ParticleSet:
    return ParticleSet(*(array[mask] for array in vars(particles).values()))


def _sites(coarse: Scene, position: np.ndarray) -> tuple[np.ndarray, ...]:
    """Place on the coarse lattice, along each axis, of the cell around each position."""
    lattice = coarse.layout.lattice
    cells = np.floor((position - np.array(lattice.origin)) / lattice.spacing).astype(np.int64)
    return tuple((cells - np.array(lattice.first)).T)


def _wall_density(coarse: Scene, fallen: ParticleSet) -> np.ndarray:
    """Density of the coarse walls on their lattice, which the fine walls start with."""
    density = np.full(coarse.layout.lattice.counts, np.nan)
    walls = _chosen(fallen, fallen.kind == WALL)
    density[_sites(coarse, walls.position)] = walls.density
    return density
