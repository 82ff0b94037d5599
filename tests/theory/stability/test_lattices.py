"""Lattices: how dense, how many neighbours, which waves are one."""

import numpy as np
import pytest

from psph.theory.stability.lattices import LATTICES, OF_SCENES, lattice

NEAREST = {"row": 2, "square": 4, "hexagonal": 6, "cubic": 6, "bcc": 8, "fcc": 12}
DISTANCE = {"hexagonal": 1.0746, "bcc": 1.0911, "fcc": 1.1225}


@pytest.mark.parametrize("name", LATTICES)
def test_one_particle_in_its_volume(name):
    made = lattice(name, 0.3)
    assert abs(np.linalg.det(made.basis)) == pytest.approx(0.3**made.dimensions)


@pytest.mark.parametrize("name", LATTICES)
def test_nearest_neighbours(name):
    made = lattice(name, 1.0)
    far = np.linalg.norm(made.within(3.0) @ made.basis, axis=1)
    assert (far < far.min() * 1.001).sum() == NEAREST[name]
    assert far.min() == pytest.approx(DISTANCE.get(name, 1.0), abs=1e-4)


@pytest.mark.parametrize("name", LATTICES)
def test_sites_are_all_there(name):
    """As many as the ball has volume, and with each R its −R."""
    made = lattice(name, 1.0)
    whole = made.within(8.0)
    ball = {1: 16.0, 2: np.pi * 64.0, 3: 4.0 / 3.0 * np.pi * 512.0}[made.dimensions]
    assert len(whole) + 1 == pytest.approx(ball, rel=0.07)
    assert {tuple(n) for n in whole} == {tuple(-n) for n in whole}


@pytest.mark.parametrize("name", LATTICES)
def test_waves_that_are_one_have_one_name(name):
    made = lattice(name, 0.1)
    rng = np.random.default_rng(1)
    sites = made.within(0.5) @ made.basis
    for wave in rng.uniform(-0.5, 0.5, (5, made.dimensions)) @ made.reciprocal:
        other = -(wave + rng.integers(-1, 2, made.dimensions) @ made.reciprocal)
        short = made.shortest(other)
        assert short == pytest.approx(made.shortest(wave))
        assert np.linalg.norm(short) <= np.linalg.norm(wave) * 1.000001
        assert np.cos(sites @ short) == pytest.approx(np.cos(sites @ wave), abs=1e-9)


def test_scenes_start_on_known_lattices():
    assert {d: lattice(name, 1.0).dimensions for d, name in OF_SCENES.items()} == {1: 1, 2: 2, 3: 3}
