"""Particles on the sites of the lattice, some planes at a time."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator, Philox

from psph.case.study import EXACT
from psph.scene.layout import NONE
from psph.scene.starts import Starts

NUMBERS_PER_COUNT = 4
"""Philox gives four 64-bit numbers for each count: one count is one particle."""


@dataclass(frozen=True)
class ParticleSet:
    """Particles in the order of the lattice; all arrays have n rows.

    ``id`` int64; ``kind`` uint8 (psph.fields); ``material`` uint8, index into the
    scene's materials; ``position`` (n, dim) m; ``velocity`` (n, dim) m/s; ``density`` (n,) kg/m³;
    ``mass`` (n,) kg.
    """

    id: np.ndarray
    kind: np.ndarray
    material: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    density: np.ndarray
    mass: np.ndarray

    @classmethod
    def empty(cls, n: int, dimensions: int, first_id: int) -> "ParticleSet":
        """``n`` particles that are still to be filled in."""
        return cls(
            first_id + np.arange(n, dtype=np.int64),
            np.empty(n, np.uint8),
            np.empty(n, np.uint8),
            np.empty((n, dimensions)),
            np.empty((n, dimensions)),
            np.empty(n),
            np.empty(n),
        )

    def rows(self, first: int, last: int) -> "ParticleSet":
        """A view of some rows."""
        return ParticleSet(*(array[first:last] for array in vars(self).values()))

    def where(self, holds: np.ndarray) -> "ParticleSet":
        """A copy of the rows where ``holds`` (n,) is true."""
        return ParticleSet(*(array[holds] for array in vars(self).values()))

    def joined(self, other: "ParticleSet") -> "ParticleSet":
        """These particles, and the ``other`` ones behind them."""
        return ParticleSet(*map(np.concatenate, zip(vars(self).values(), vars(other).values())))


def fill(particles: ParticleSet, starts: Starts, first: int, last: int) -> None:
    """Put particles on the held sites of planes ``first`` to ``last - 1`` of the layout."""
    done = 0
    for begin, end in starts.layout.lattice.chunks(first, last):
        held = starts.layout.materials(begin, end)
        sites = np.flatnonzero(held != NONE)
        sites = np.repeat(sites, starts.layout.cell_counts[held.ravel()[sites]])
        chunk = particles.rows(done, done + len(sites))
        _place(chunk, starts, held, sites, begin)
        _part(chunk, starts)
        _start(chunk, starts)
        _dry(chunk, starts, sites, begin, end)
        _kick(chunk, starts, sites, begin, end)
        _shift(chunk, starts)
        _stretch(chunk, starts, (part.number for part in starts.layout.parts if not part.relaxes))
        _flow(chunk, starts)
        _as_exact(chunk, starts)
        done += len(sites)


def settled_at(starts: Starts, ids: np.ndarray, material: np.ndarray, position: np.ndarray) -> ParticleSet:
    """Particles of the parts ``material`` (n,) with these ``ids`` (n,), in the state that the scene has where
    they are, ``position`` (n, dim) m."""
    found = ParticleSet.empty(len(ids), position.shape[1], 0)
    found.id[:], found.material[:], found.position[:] = ids, material, position
    _stretch(found, starts, np.unique(material))
    _start(found, starts)
    _flow(found, starts)
    _as_exact(found, starts)
    return found


def _place(chunk: ParticleSet, starts: Starts, held: np.ndarray, sites: np.ndarray, begin: int) -> None:
    lattice = starts.layout.lattice
    chunk.material[:] = held.ravel()[sites]
    for d, k in zip(lattice.axes, np.unravel_index(sites, held.shape)):
        chunk.position[:, d] = lattice.coordinates(d)[k + begin if d == lattice.axis else k]


def _part(chunk: ParticleSet, starts: Starts) -> None:
    """Spread the particles of a part with a finer spacing over the cells of their sites."""
    for part in starts.layout.parts:
        rows = np.flatnonzero(chunk.material == part.number) if part.finer > 1 else ()
        if len(rows):
            within = starts.layout.lattice.within_cell(part.finer)
            chunk.position[rows] += np.tile(within, (len(rows) // len(within), 1))


def _start(chunk: ParticleSet, starts: Starts) -> None:
    """Kind, velocity, density and mass by material."""
    for index in np.unique(chunk.material):
        material, rows = starts.species[index], chunk.material == index
        chunk.kind[rows] = material.kind
        chunk.velocity[rows] = starts.speeds.velocities[index]
        chunk.density[rows] = starts.states[index].density(chunk.position[rows])
        chunk.mass[rows] = material.mass


def _dry(chunk: ParticleSet, starts: Starts, sites: np.ndarray, begin: int, end: int) -> None:
    """A wall out of reach of the fluid whose hydrostatic pressure it continues starts without.

    It would push away the water that comes to it later.
    """
    layout = starts.layout
    for index, part in enumerate(layout.parts):
        rows = chunk.material == index
        if not part.flows and starts.states[part.source].layer and rows.any():
            wet = layout.near(part.source, begin, end, layout.wall_reach).ravel()[sites]
            chunk.density[rows & ~wet] = starts.species[index].density


def _kick(chunk: ParticleSet, starts: Starts, sites: np.ndarray, begin: int, end: int) -> None:
    for (plane, place), (velocity, shift) in starts.speeds.kicks.items():
        if begin <= plane < end:
            row = np.searchsorted(sites, (plane - begin) * starts.layout.lattice.sites_in_plane + place)
            chunk.velocity[row] += velocity
            chunk.position[row] += shift


def _shift(chunk: ParticleSet, starts: Starts) -> None:
    """Random shifts, the same for a particle wherever it is made: its id places the draw."""
    dimensions = chunk.position.shape[1]
    for index, part in enumerate(starts.layout.parts):
        rows = chunk.material == index
        if part.shake and rows.any():
            source = Philox(key=part.table.seed)
            source.advance(int(chunk.id[0]))
            drawn = Generator(source).random((len(chunk.id), NUMBERS_PER_COUNT))[rows, :dimensions]
            shift = (2.0 * drawn - 1.0) * (part.shake * starts.layout.spacing / part.finer)
            chunk.position[rows] += (
                _within(chunk.position[rows], shift, index, starts) if part.relaxes else shift
            )
    for x, low, period in zip(chunk.position.T, starts.layout.lower, starts.layout.periods):
        if period is not None:
            x -= period * np.floor((x - low) / period)
            x[x >= low + period] = low  # rounding may land on the upper edge


def _within(position: np.ndarray, shift: np.ndarray, part: int, starts: Starts) -> np.ndarray:
    """The ``shift`` (n, dim) m; half of it, or none, where it would leave the shape of the part."""
    for less in (0.5, 0.0):
        shift = np.where(starts.layout.holds(part, position + shift)[:, None], shift, less * shift)
    return shift


def _stretch(chunk: ParticleSet, starts: Starts, parts: Iterable[int]) -> None:
    """Particles of one mass go to where their part, one of some, has its density."""
    for index in parts:
        rows = chunk.material == index
        chunk.position[rows] = starts.layout.parts[index].stretched(chunk.position[rows])


def _flow(chunk: ParticleSet, starts: Starts) -> None:
    """What differs of the velocity at the start, where each particle now is."""
    for index, part in enumerate(starts.layout.parts):
        rows = chunk.material == index
        if rows.any() and (more := part.flow(chunk.position[rows])) is not None:
            chunk.velocity[rows] += more


def _as_exact(chunk: ParticleSet, starts: Starts) -> None:
    """Velocity and density of the exact solution, where each particle now is."""
    for index, part in enumerate(starts.layout.parts):
        rows = chunk.material == index
        if part.table.velocity == EXACT and rows.any():
            chunk.velocity[rows] += starts.layout.exact.velocity(chunk.position[rows], 0.0, starts.setting)
        if starts.states[index].exact:
            chunk.density[rows] = starts.states[index].density(chunk.position[rows])
