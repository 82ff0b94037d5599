"""Surface tension on lattices: what a flat surface pulls with, and which of its waves grow."""

import math
from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest

from psph.composition.pair import geometry
from psph.moments import sites_around
from psph.physics.surface.tension import DEPTH, TensionOfOne, blunt, blunt_kernel, borne, flat_surface
from psph.smoothing import kernel, slope_over_r
from psph.vectors import add, scale, subtract

DX, SIGMA, RHO, H = 0.1, 0.7, 1000.0, 0.14
DEEP = 12
"""Rows of the lattice: the lower ones are not looked at."""


def under(dim):
    """The tension of one fluid in a scene with such a lattice."""
    smoothing = kernel("wendland-c2", H, dim)
    pulls = blunt_kernel(smoothing, DX, dim)
    tension, vectors = flat_surface(pulls, smoothing, DX, dim)
    return TensionOfOne(SIGMA / tension, SIGMA / vectors, pulls, RHO / SIGMA)


class Surface:
    """A lattice below a flat surface, without an end along it; ``moved`` displaces its particles, m."""

    def __init__(self, effect, dim, moved=lambda x: np.zeros(len(x))):
        self.effect, self.dim, self.moved = effect, dim, moved
        self.smoothing = kernel("wendland-c2", H, dim)
        self.around = [*sites_around(self.smoothing, DX, dim)]
        self.vectors = {}

    def particle(self, site):
        """The view of the particle at a site (dim,), the last number of which is 0 in the first row."""
        x = np.array(site) * DX
        x = x + self.moved(x)
        return SimpleNamespace(
            position=tuple(x.tolist()),
            velocity=(0.0,) * self.dim,
            mass=RHO * DX**self.dim,
            specific_volume=1.0 / RHO,
            is_fluid=1.0,
        )

    def pairs(self, site):
        """Each neighbour of a site: its own site, both views and their pair."""
        i = self.particle(site)
        for step in self.around:
            other = tuple(a + b for a, b in zip(site, step))
            if -DEEP < other[-1] <= 0:
                j = self.particle(other)
                yield other, i, j, geometry(self.smoothing, subtract(i.position, j.position), 0.0, i, j)

    def with_vector(self, site, one):
        """The same view with the vector of its stress."""
        if site not in self.vectors:
            total = self.effect.start(one)
            for _, i, j, pair in self.pairs(site):
                total = self.effect.gather(total, i, j, pair)
            self.vectors[site] = self.effect.finish_value(total, one, self.smoothing)
        return SimpleNamespace(**vars(one), surface_vector=self.vectors[site])

    def pushes(self, site):
        """Of each neighbour, its site and the force on a particle, N."""
        for other, i, j, pair in self.pairs(site):
            i, j = self.with_vector(site, i), self.with_vector(other, j)
            yield other, RHO * DX**self.dim * np.array(self.effect.push(i, j, pair))


@pytest.mark.parametrize("dim", (2, 3))
def test_a_flat_surface_pulls_with_its_tension_and_has_that_energy(dim):
    surface, force, energy = Surface(under(dim), dim), np.zeros(dim), 0.0
    for depth in range(5):
        site = (*(0,) * (dim - 1), -depth)
        one = surface.with_vector(site, surface.particle(site))
        energy += RHO * DX**dim * surface.effect.potential(one)
        for other, push in surface.pushes(site):
            force += 0.5 * abs(other[0]) * push * (1 if other[0] > 0 else -1)  # through a plane across
    assert force[0] / DX ** (dim - 2) == pytest.approx(SIGMA, rel=1e-12)
    assert force[1:] == pytest.approx(0.0, abs=1e-12)
    assert energy / DX ** (dim - 1) == pytest.approx(SIGMA, rel=1e-12)


@pytest.mark.parametrize("dim", (2, 3))
def test_a_flat_surface_is_not_pushed_outwards(dim):
    surface = Surface(under(dim), dim)
    for depth in range(3):
        force = sum(push for _, push in surface.pushes((*(0,) * (dim - 1), -depth)))
        assert force == pytest.approx(0.0, abs=1e-12 * SIGMA * DX ** (dim - 2))


ROUND = 10 * DX
"""A radius, m."""


@pytest.mark.parametrize("across, part", ((1.0, 1.0 - DEPTH * DX / ROUND), (-1.0, 1.0 + DEPTH * DX / ROUND)))
def test_along_a_round_surface_a_pair_pulls_by_its_depth_less_and_around_a_hollow_more(across, part):
    """δκ less, of a pair on a circle; two beside each other on the axis of a cylinder pull as on a plane."""
    effect = under(3)

    def one(turn, along):
        out = np.array([math.cos(turn), math.sin(turn), 0.0])
        x = across * ROUND * out + np.array([0.0, 0.0, along])
        one = {"position": tuple(x), "surface_vector": tuple(out), "specific_volume": 1.0, "mass": 1.0}
        return SimpleNamespace(**one, is_fluid=1.0, velocity=(0.0,) * 3)

    def pull(*places):
        i, j = (one(*place) for place in places)
        pair = geometry(kernel("wendland-c2", H, 3), subtract(i.position, j.position), 0.0, i, j)
        both = add(borne(i.surface_vector, pair.x_ij), borne(j.surface_vector, pair.x_ij))
        plane = effect.strength * blunt(effect.kernel, pair) * np.linalg.norm(both)
        return np.linalg.norm(effect.push(i, j, pair)) / plane

    assert pull((0.0, 0.0), (DX / ROUND, 0.0)) == pytest.approx(part, rel=1e-12)
    assert pull((0.0, 0.0), (0.0, DX)) == pytest.approx(1.0, rel=1e-12)


class SchemesOwn(TensionOfOne):
    """The stress as published, with the kernel of the scheme in the force."""

    def push(self, i, j, pair):
        """As with the blunt kernel, by W′/r."""
        both = add(borne(i.surface_vector, pair.x_ij), borne(j.surface_vector, pair.x_ij))
        return scale(both, self.strength * i.specific_volume * j.specific_volume * pair.m_dw_r)


def growth(effect, along, wave):
    """−ω² of particles of the first two rows that are displaced along an axis by a standing ``wave`` over σ/(ρ
    dx³): above 0 it grows."""
    small, dim = 1e-6 * DX, 2

    def moved(x):
        shift = np.zeros(dim)
        shift[along] = small * math.cos(wave * math.pi * x[0] / DX) * (x[-1] > -0.5 * DX)
        return shift

    surface = Surface(effect, dim, moved)
    force = sum(push for _, push in surface.pushes((0, 0)))
    return force[along] / (RHO * DX**2) / small * RHO * DX**3 / SIGMA


WAVES = [*product((0, 1), (0.25, 0.5, 0.75, 1.0))]


def test_no_wave_of_a_flat_surface_grows_fast():
    """The waves of the first row, along it and across, under the tension alone."""
    assert max(growth(under(2), *one) for one in WAVES) < 0.1


def test_with_the_kernel_of_the_scheme_in_the_force_some_do():
    """The control: its chain parts."""
    own, smoothing = SchemesOwn(*under(2)), kernel("wendland-c2", H, 2)
    sites = np.array([*sites_around(smoothing, DX, 2)], float) * DX
    slopes = [-float(slope_over_r(smoothing, r, 1.0 / r)) for r in np.linalg.norm(sites, axis=1)]
    scaled = own._replace(strength=own.strength / (DX**2 * float((sites**2).sum(axis=1) @ slopes)))
    assert max(growth(scaled, *one) for one in WAVES) > 0.5


def test_the_step_is_that_of_the_shortest_waves():
    step = under(2).longest_step(SimpleNamespace(smoothing_length=H))
    assert step == pytest.approx(0.25 * math.sqrt(RHO * H**3 / (2.0 * math.pi * SIGMA)))
