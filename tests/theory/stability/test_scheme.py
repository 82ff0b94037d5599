"""The pair potential of the stable scheme: no wave on any lattice may lower its energy."""

import itertools

import numpy as np
import pytest

from psph.composition.pair import Pair
from psph.physics.order.potential import NEAR, neutral_potential
from psph.theory.stability.lattices import lattice

ACROSS = 8
"""Waves along an edge of the reciprocal cell."""

LATTICES = ("square", "hexagonal", "cubic", "bcc", "fcc")


def attraction(potential, r):
    """f(r) of a_a = −Σ f x_ab/r, for a mass, a density and a speed of sound of one."""
    pairs = (Pair(r2=x * x, r=x, inverse_r=1.0 / x) for x in r)
    return -r * np.array([potential.radial(None, None, pair) for pair in pairs])


def smallest_eigenvalue(potential, name):
    """Of Σ (f′ r̂r̂ᵀ + f/r (1 − r̂r̂ᵀ))(1 − cos k·R) over the waves k ≠ 0 of a lattice."""
    cell = lattice(name, 1.0)
    sites = cell.within(3.0) @ cell.basis
    r = np.linalg.norm(sites, axis=1)
    along = sites[:, :, None] * sites[:, None, :] / (r * r)[:, None, None]
    step = 1e-6
    slope = (attraction(potential, r + step) - attraction(potential, r - step)) / (2.0 * step)
    across = attraction(potential, r) / r
    stiffness = slope[:, None, None] * along + across[:, None, None] * (np.eye(len(cell.basis)) - along)
    parts = itertools.product(range(ACROSS), repeat=len(cell.basis))
    waves = np.array([k for k in parts if any(k)]) / ACROSS @ cell.reciprocal
    sums = np.einsum("kr,rij->kij", 1.0 - np.cos(waves @ sites.T), stiffness)
    unit = -attraction(potential, np.array([NEAR]))[0]
    return np.linalg.eigvalsh(sums)[:, 0].min() / unit


@pytest.mark.parametrize("name", LATTICES)
def test_every_wave_on_every_lattice_costs_energy(name):
    potential = neutral_potential(1.0, 1.0, 1.0, len(lattice(name, 1.0).basis))
    assert smallest_eigenvalue(potential, name) > 0.0


@pytest.mark.parametrize("name", ["cubic", "fcc"])
def test_the_shape_for_two_dimensions_fails_in_three(name):
    assert smallest_eigenvalue(neutral_potential(1.0, 1.0, 1.0, 2), name) < 0.0
