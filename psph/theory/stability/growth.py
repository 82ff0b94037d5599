"""Which disturbance of a uniform lattice grows fastest: over all waves, or in a box of walls."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from psph.theory.stability.couplings import Couplings, couplings
from psph.theory.stability.errors import StabilityError
from psph.theory.stability.lattices import BravaisLattice
from psph.theory.stability.system import System
from psph.theory.stability.uniform import Settings, Uniform

WAVES = {1: 256, 2: 32, 3: 12}
"""Wave vectors along each axis of the initial grid over the zone, by dimensions."""

STARTS, FINEST = 3, 1e-4
"""Number of the best grid points from which the search starts, and its resolution as a part of the zone."""

TINY = 1e-12

MOST = 3000
"""Coordinates of moving particles in a box: its matrix is full."""


class Growth(NamedTuple):
    """The fastest growth: ``rate`` in 1/s, 0 if ``stable``, and its ``wave_vector`` (d,) in rad/m.

    Of a stable lattice, the wave that comes nearest to growing, for its length.
    """

    rate: float
    wave_vector: np.ndarray
    stable: bool


def growth(settings: Settings) -> Growth:
    """The fastest growth on an infinite lattice."""
    return _zone_of(settings).growth()


def is_stable(settings: Settings) -> bool:
    """Whether nothing grows on an infinite lattice: faster than finding the largest growth."""
    zone = _zone_of(settings)
    return not zone.grows(zone.grid) and not zone.grows(zone.softest()[None])


def _zone_of(settings: Settings) -> "Zone":
    uniform = Uniform(settings)
    pairs = couplings(uniform).halved
    return Zone(uniform.lattice, pairs.sites, lambda waves: waves_of(pairs, waves))


class Zone:
    """All waves of a lattice, in parts (n, d) of its reciprocal basis.

    ``sites`` (n, d) are those of neighbours, m; ``system`` gives the motion of many waves (n, d), rad/m.
    """

    def __init__(self, lattice: BravaisLattice, sites: np.ndarray, system: Callable[[np.ndarray], System]):
        self.lattice, self.sites, self.waves = lattice, sites, system
        count = WAVES[self.lattice.dimensions]
        self.grid, self.step = zone_grid(self.lattice, count), 1.0 / count
        self.noise = self._system(self.grid).noise

    def growth(self) -> Growth:
        """The fastest."""
        at, stable = self.steepest()
        rate = 0.0 if stable else float(self.urge(at[None])[0])
        return Growth(rate, self.lattice.shortest(at @ self.lattice.reciprocal), stable)

    def urge(self, parts: np.ndarray) -> np.ndarray:
        """See :meth:`System.urge`, (n,)."""
        return self._system(parts).urge()

    def urge_for_length(self, parts: np.ndarray) -> np.ndarray:
        """The same over the length of the wave vector, so that long waves are not the slowest."""
        phase = parts @ self.lattice.reciprocal @ self.sites.T
        stretch = (1.0 - np.cos(phase)).mean(axis=1)  # k² for small k, but periodic as waves are
        return self.urge(parts) / np.sqrt(stretch + TINY)

    def grows(self, parts: np.ndarray) -> bool:
        """Whether any of these waves grows."""
        return bool((self.urge(parts) > self.noise).any())

    def steepest(self) -> tuple[np.ndarray, bool]:
        """The wave that grows fastest; if none grows, the one nearest to growing, and True."""
        if self.grows(self.grid):
            return _climb(self.urge, self.grid, self.step), False
        soft = self.softest()
        if self.grows(soft[None]):  # a summit between the first looks
            return _climb(self.urge, soft[None], self.step), False
        return soft, True

    def softest(self) -> np.ndarray:
        """The wave that is the nearest to growing for its length, (d,)."""
        return _climb(self.urge_for_length, self.grid, self.step)

    def _system(self, parts: np.ndarray) -> System:
        return self.waves(parts @ self.lattice.reciprocal)


def waves_of(pairs: Couplings, waves: np.ndarray) -> System:
    """Plane waves ξ, iδρ ∝ exp(ik·x) for many k (waves, d), rad/m, with ``halved`` couplings."""
    count, d = waves.shape
    phase = waves @ pairs.sites.T
    still, sines = 1.0 - np.cos(phase), np.sin(phase)
    return System(
        (still @ pairs.stiffness.reshape(-1, d * d)).reshape(count, d, d),
        (still @ pairs.damping.reshape(-1, d * d)).reshape(count, d, d),
        -(sines @ pairs.push)[:, :, None],
        (sines @ pairs.pull)[:, None, :],
        (still @ pairs.diffusion)[:, None, None],
    )


def box_growth(settings: Settings, cells: int) -> Growth:
    """The fastest growth where a block of ``cells``^d particles moves between fixed ones.

    The density of the fixed ones follows the continuity equation, as that of psph's walls.  The
    wave is the one that the growing motion resembles most.  Raises StabilityError: too many.
    """
    uniform = Uniform(settings)
    lattice = uniform.lattice
    if cells < 1:
        raise StabilityError(f"stability --box {cells}: give at least 1 particle along an edge")
    if lattice.dimensions * cells**lattice.dimensions > MOST:
        most = int((MOST / lattice.dimensions) ** (1.0 / lattice.dimensions))
        raise StabilityError(
            f"stability --box {cells}: its matrix would be too large; at most {most} on a "
            f"{settings.lattice} lattice"
        )
    pairs = couplings(uniform)
    system, whole = box_of(pairs, cells, int(np.abs(pairs.whole).max()))
    rate = float(system.urge())
    stable = not rate > system.noise
    mode = system.mode().reshape(-1, lattice.dimensions)
    grid = zone_grid(lattice, WAVES[lattice.dimensions])
    found = np.abs(np.exp(-2j * np.pi * grid @ whole.T) @ mode)
    wave = lattice.shortest(grid[(found**2).sum(axis=1).argmax()] @ lattice.reciprocal)
    return Growth(0.0 if stable else rate, wave, stable)


def box_of(pairs: Couplings, cells: int, layers: int) -> tuple[System, np.ndarray]:
    """The motion of ``cells``^d particles inside ``layers`` of fixed ones, and their n (n, d).

    Row d·i + x of the matrices is coordinate x of the particle i that moves; densities are those
    of all sites, fixed ones included.  Fixed sites that no particle reaches rest, as dry walls do in a
    run, and layers beyond them change nothing.
    """
    d = pairs.whole.shape[1]
    shape = np.full(d, cells + 2 * layers)
    sites = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), -1).reshape(-1, d)
    inner = ((sites >= layers) & (sites < layers + cells)).all(axis=1)
    own = np.where(inner, np.cumsum(inner) - 1, -1)  # number of a site among those that move
    n, every = int(inner.sum()), len(sites)
    stiffness, damping = np.zeros((n, d, n, d)), np.zeros((n, d, n, d))
    push, pull = np.zeros((n, d, every)), np.zeros((every, n, d))
    diffusion, wet = np.zeros((every, every)), inner.copy()
    for k, step in enumerate(pairs.whole):
        a = np.flatnonzero(((sites + step >= 0) & (sites + step < shape)).all(axis=1))
        b = np.ravel_multi_index((sites[a] + step).T, shape)
        taken = pairs.diffusion[k] - pairs.spreading[k] * (inner[a] & ~inner[b])
        taken -= pairs.meeting[k] * ~(inner[a] | inner[b])
        diffusion[a, a] += taken
        diffusion[a, b] -= taken
        towards = inner[b]
        wet[a[towards]] = True
        pull[a[towards], own[b[towards]]] += pairs.pull[k]
        a, b = a[inner[a]], b[inner[a]]
        towards = inner[b]
        pull[a, own[a]] -= pairs.pull[k]
        push[own[a], :, b] += pairs.push[k]
        for matrix, part in ((stiffness, pairs.stiffness[k]), (damping, pairs.damping[k])):
            matrix[own[a], :, own[a], :] += part
            matrix[own[a[towards]], :, own[b[towards]], :] -= part
    diffusion[~wet] = 0.0  # walls that no fluid reaches rest: psph.particles.wetting
    q = n * d
    return System(
        stiffness.reshape(q, q),
        damping.reshape(q, q),
        push.reshape(q, every),
        pull.reshape(every, q),
        diffusion,
    ), sites[inner] - layers


def zone_grid(lattice: BravaisLattice, count: int) -> np.ndarray:
    """Waves (n, d) in parts of the reciprocal basis, k = 0 left out.

    Half of a cell, k and −k being one; of a lattice along the axes as much of each axis.
    """
    half, full = np.arange(count // 2 + 1) / count, np.arange(count) / count
    mirrored = np.count_nonzero(lattice.basis) == lattice.dimensions
    axes = [half] + [half if mirrored else full] * (lattice.dimensions - 1)
    return np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, lattice.dimensions)[1:]


def _climb(height: Callable, starts: np.ndarray, step: float) -> np.ndarray:
    """Where ``height`` is largest: uphill from the best ``starts``, ``step`` apart."""
    from scipy.optimize import minimize  # late: it takes a while, and runs go without

    heights = height(starts)
    scale = np.abs(heights).max() or 1.0
    _, order = np.unique(-np.round(heights / scale, 9), return_index=True)
    simplex = step * np.eye(starts.shape[1] + 1, starts.shape[1])
    enough = {"xatol": FINEST, "fatol": FINEST**2 * scale}
    found = [
        minimize(
            lambda at: -height(at[None])[0],
            start,
            method="Nelder-Mead",
            options={"initial_simplex": start + simplex, **enough},
        )
        for start in starts[order[:STARTS]]
    ]
    tops = [starts[order[0]], *(one.x for one in found)]
    return max(tops, key=lambda at: height(at[None])[0])
