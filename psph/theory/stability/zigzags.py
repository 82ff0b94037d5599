"""Which waves of elastic matter grow, and which have no stiffness at all."""

import numpy as np

from psph.theory.stability.elastic import ElasticMatter, TotalLagrangian, UpdatedLagrangian
from psph.theory.stability.growth import WAVES, Growth, Zone, zone_grid
from psph.theory.stability.system import System

Description = TotalLagrangian | UpdatedLagrangian

NOTHING = 1e-9
"""Of the largest ω²: below it a wave has no stiffness."""


def elastic_growth(of: Description, matter: ElasticMatter) -> Growth:
    """The wave that grows fastest."""
    around = of.sites(matter)
    return Zone(around.lattice, around.sites, lambda waves: _system(of, matter, waves)).growth()


def limp_waves(of: Description, matter: ElasticMatter) -> np.ndarray:
    """The waves (n, d), in π/dx of the lattice at rest, that meet no force in one direction at least.

    On a grid over half of the Brillouin zone that contains its corners.
    """
    waves = _grid(of, matter)
    squares = np.abs(np.linalg.eigvals(of.squares(matter, waves)))
    limp = squares.min(axis=1) <= NOTHING * squares.max()
    return waves[limp] * (matter.spacing / np.pi)


def zigzag(of: Description, matter: ElasticMatter) -> float:
    """ω h/c_l of the softest wave at the corners of the Brillouin zone, whose neighbours move against each
    other."""
    corners = zone_grid(of.sites(matter).lattice, 2) @ of.sites(matter).lattice.reciprocal
    squares = np.linalg.eigvals(of.squares(matter, corners)).real
    return float(np.sqrt(max(squares.min(), 0.0))) * _time(matter)


def fastest(of: Description, matter: ElasticMatter) -> float:
    """ω h/c_l of the fastest wave: by it the time step is limited."""
    squares = np.linalg.eigvals(of.squares(matter, _grid(of, matter))).real
    return float(np.sqrt(squares.max())) * _time(matter)


def _grid(of: Description, matter: ElasticMatter) -> np.ndarray:
    lattice = of.sites(matter).lattice
    return zone_grid(lattice, WAVES[lattice.dimensions]) @ lattice.reciprocal


def _time(matter: ElasticMatter) -> float:
    """h/c_l, s."""
    return matter.smoothing * matter.spacing / matter.wave_speed


def _system(of: Description, matter: ElasticMatter, waves: np.ndarray) -> System:
    squares = of.squares(matter, waves)
    n, d, _ = squares.shape
    return System(
        squares, np.zeros_like(squares), np.zeros((n, d, 0)), np.zeros((n, 0, d)), np.zeros((n, 0, 0))
    )
