"""Lattices of one particle a cell, their sites and their wave vectors."""

import itertools
from typing import NamedTuple

import numpy as np

_BASES = {
    "row": [[1]],
    "square": [[1, 0], [0, 1]],
    "hexagonal": [[1, 0], [0.5, 0.75**0.5]],
    "cubic": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
    "bcc": [[-0.5, 0.5, 0.5], [0.5, -0.5, 0.5], [0.5, 0.5, -0.5]],
    "fcc": [[0, 0.5, 0.5], [0.5, 0, 0.5], [0.5, 0.5, 0]],
}
LATTICES = tuple(_BASES)
"""In 1D a row, in 2D square and hexagonal, in 3D cubic (simple), body- and face-centred."""

OF_SCENES = {1: "row", 2: "square", 3: "cubic"}
"""The lattice on which a case starts, by its dimensions."""


class BravaisLattice(NamedTuple):
    """Sites Σ n_i a_i, n whole; the rows of ``basis`` (d, d), in m, are the a_i."""

    basis: np.ndarray

    @property
    def dimensions(self) -> int:
        """Of space."""
        return len(self.basis)

    @property
    def reciprocal(self) -> np.ndarray:
        """Rows b_i with b_i·a_j = 2π δ_ij, rad/m: waves k and k + b_i are the same."""
        return 2.0 * np.pi * np.linalg.inv(self.basis).T

    def within(self, reach: float) -> np.ndarray:
        """The n (sites, d) of all sites nearer than ``reach`` m to the origin, but that itself."""
        most = np.ceil(reach * np.linalg.norm(self.reciprocal, axis=1) / (2.0 * np.pi)).astype(int)
        whole = _all_of([range(-n, n + 1) for n in most])
        far = np.linalg.norm(whole @ self.basis, axis=1)
        return whole[(far > 0.0) & (far < reach)]

    def shortest(self, wave: np.ndarray) -> np.ndarray:
        """The same wave, up to its sign, in the first Brillouin zone; rad/m."""
        same = wave + _all_of([range(-2, 3)] * self.dimensions) @ self.reciprocal
        unit = np.linalg.norm(self.reciprocal[0])
        same[np.abs(same) < 1e-9 * unit] = 0.0
        lengths = np.round(np.linalg.norm(same, axis=1) / unit, 6)
        ways = [turn * k for k in same[lengths == lengths.min()] for turn in (1.0, -1.0)]
        return max(ways, key=lambda k: tuple(np.round(k / unit, 6))) + 0.0


def lattice(name: str, spacing: float) -> BravaisLattice:
    """The lattice ``name`` with one particle in ``spacing``^d, m^d; KeyError for an unknown name.

    So the ``spacing`` is that of a cubic lattice of the same density: in a hexagonal one the
    nearest neighbours are 1.075 spacings apart, in a bcc 1.091, in an fcc 1.122.
    """
    basis = np.array(_BASES[name], float)
    return BravaisLattice(basis * (spacing / abs(np.linalg.det(basis)) ** (1.0 / len(basis))))


def _all_of(ranges) -> np.ndarray:
    return np.array(list(itertools.product(*ranges)))
