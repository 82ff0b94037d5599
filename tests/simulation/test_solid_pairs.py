"""The two passes over pairs of solids, on lattices in disorder whose particles have different volumes."""

from typing import NamedTuple

import numpy as np
import pytest

from psph.composition.space import Metres, softening
from psph.fields import view_of
from psph.particles.partners import padded_lists
from psph.particles.records import record_width
from psph.physics.solid.deformation import SMOOTHING, Gradient
from psph.physics.solid.laws import LAWS, moduli
from psph.simulation.solid_pairs import (
    Matter,
    Rows,
    Weights,
    drag,
    measure,
    sum_gradients,
    sum_inner_forces,
    sum_moments,
)
from psph.smoothing import kernel

YOUNG, POISSON, DX = 2.0e6, 0.3, 0.1


class Lattice(NamedTuple):
    """Places in the reference (n, dim), volumes (n,), and the neighbours: their number and they."""

    places: np.ndarray
    volume: np.ndarray
    counts: np.ndarray
    partners: np.ndarray


def lattice(d, side, jitter=0.2, uneven=0.3, seed=1):
    """A lattice of ``side`` particles along each axis in disorder, of volumes that differ."""
    random = np.random.default_rng(seed)
    sites = np.stack(np.meshgrid(*[np.arange(side)] * d, indexing="ij"), axis=-1).reshape(-1, d)
    places = DX * (sites + jitter * random.uniform(-1.0, 1.0, sites.shape))
    volume = DX**d * (1.0 + uneven * random.uniform(-1.0, 1.0, len(sites)))
    apart = np.linalg.norm(places[:, None] - places[None], axis=2)
    near = (apart < 2.0 * SMOOTHING * DX) & (apart > 0.0)
    return Lattice(places, volume, near.sum(axis=1), np.nonzero(near)[1])


class Found(NamedTuple):
    """F (n, d, d), force m_i a_i (n, d), energy (n,), Cauchy stress (n, s), von Mises stress (n,)."""

    gradient: np.ndarray
    force: np.ndarray
    energy: np.ndarray
    stress: np.ndarray
    mises: np.ndarray


def passes(of: Lattice, places, law="saint-venant-kirchhoff", hourglass=0.1):
    """Both passes with the particles of a lattice at ``places``."""
    n, d = of.places.shape
    names = {"reference": d, "position": d, "flux": d * d, "volume": 1}
    table = np.zeros((n, record_width(sum(names.values()))))
    ends = np.cumsum([0, *names.values()])
    shown = [tuple(table[:, c] for c in range(*ends[k : k + 2])) for k in range(4)]
    view = view_of(tuple(names))(*shown[:3], shown[3][0])
    for columns, values in zip(shown, (of.places.T, places.T)):
        for column, value in zip(columns, values):
            column[:] = value
    shown[3][0][:] = of.volume
    h = SMOOTHING * DX
    soft = softening(Metres((None,) * d), h, int(of.counts.max()))
    weights = Weights(kernel("wendland-c2", h, d), (None,) * d, soft)
    own = LAWS[law](*moduli(YOUNG, POISSON))
    numbers = (np.array([x]) for x in (hourglass * YOUNG, 0.0, 1000.0))
    matter = Matter((own,), (Gradient((None,) * d),), np.zeros(n, np.uint8), *numbers)
    rows = Rows(view, table, padded_lists(of.counts, of.partners, Metres.lanes))
    moment = tuple(np.zeros(n) for _ in range(d * (d + 1) // 2))
    sum_moments(0, n, weights, rows, moment)
    sum_gradients(0, n, matter, weights, rows, moment, None, view.flux)
    force = tuple(np.zeros(n) for _ in range(d))
    sum_inner_forces(0, n, matter, weights, rows, force)
    stress = tuple(np.zeros(n) for _ in moment)
    found = (np.zeros(n), stress, np.zeros(n), np.zeros(n))
    measure(0, n, matter, weights, rows, moment, None, found)
    return Found(
        gradients(of, places), of.volume[:, None] * np.array(force).T, found[0], np.array(stress).T, found[2]
    )


def gradients(of: Lattice, places):
    """F_i by plain numpy, from the formulas of docs/solids.md."""
    h, d = SMOOTHING * DX, of.places.shape[1]
    own = kernel("wendland-c2", h, d)
    found, end = [], 0
    for i, count in enumerate(of.counts):
        j, end = of.partners[end : end + count], end + count
        apart, now = of.places[i] - of.places[j], places[i] - places[j]
        r = np.linalg.norm(apart, axis=1)
        weight = of.volume[j] * np.array([-own.dw(one) / one for one in r])
        moment = np.einsum("j,jd,je->de", weight, apart, apart)
        found.append(np.einsum("j,jd,je->de", weight, now, apart) @ np.linalg.inv(moment))
    return np.array(found)


DIMENSIONS = pytest.mark.parametrize("d, side", [(2, 7), (3, 5)])
BOTH = pytest.mark.parametrize("law", list(LAWS))


def affine(d, size=0.2, seed=7):
    return np.eye(d) + size * np.random.default_rng(seed).standard_normal((d, d))


@DIMENSIONS
@BOTH
def test_patch_an_affine_map_is_found_exactly_in_disorder(d, side, law):
    """F, energy and stress of every particle, those at the faces too."""
    of, a = lattice(d, side), affine(d)
    found = passes(of, of.places @ a.T + 0.3, law)
    assert np.abs(found.gradient - a).max() < 1e-12
    own = LAWS[law](*moduli(YOUNG, POISSON))
    energy = own.energy(tuple(a.ravel()), (1.0,) * d)
    assert found.energy == pytest.approx(of.volume * energy, rel=1e-10)
    p = np.reshape(own.stress(tuple(a.ravel()), (1.0,) * d), (d, d))
    cauchy = (p @ a.T / np.linalg.det(a))[np.triu_indices(d)]
    assert np.abs(found.stress - cauchy).max() < 1e-11 * YOUNG


@DIMENSIONS
def test_patch_of_a_regular_lattice_pushes_nothing_inside(d, side):
    of, a = lattice(d, side + 4, jitter=0.0, uneven=0.0), affine(d, 0.1)
    found = passes(of, of.places @ a.T)
    inside = ((of.places > 3.9 * DX) & (of.places < (side + 4 - 4.9) * DX)).all(axis=1)
    assert inside.any() and not inside.all()
    scale = YOUNG * DX ** (d - 1)
    assert np.abs(found.force[inside]).max() < 1e-12 * scale
    assert np.abs(found.force[~inside]).max() > 1e-3 * scale  # the faces pull


@DIMENSIONS
@BOTH
def test_force_is_the_derivative_of_the_energy(d, side, law):
    """With hourglass control, and with particles in disorder beside an affine map."""
    of = lattice(d, side)
    random = np.random.default_rng(9)
    places = of.places @ affine(d, 0.1).T + 0.1 * DX * random.standard_normal(of.places.shape)
    force, step = passes(of, places, law).force, 1e-6 * DX
    for i in (0, len(places) // 2, len(places) - 3):
        for axis in range(d):
            ends = []
            for sign in (1.0, -1.0):
                moved = places.copy()
                moved[i, axis] += sign * step
                ends.append(passes(of, moved, law).energy.sum())
            slope = -(ends[0] - ends[1]) / (2.0 * step)
            assert slope == pytest.approx(force[i, axis], rel=1e-6, abs=1e-7 * np.abs(force).max())


@DIMENSIONS
@BOTH
@pytest.mark.parametrize("hourglass", (0.0, 0.3))
def test_inner_forces_keep_momentum_and_angular_momentum(d, side, law, hourglass):
    of = lattice(d, side)
    random = np.random.default_rng(11)
    places = of.places @ affine(d, 0.2).T + 0.1 * DX * random.standard_normal(of.places.shape)
    force = passes(of, places, law, hourglass).force
    size = np.abs(force).sum()
    assert np.abs(force.sum(axis=0)).max() < 1e-14 * size
    torque = np.einsum("nd,ne->de", places, force)
    assert np.abs(torque - torque.T).max() < 1e-13 * size * np.abs(places).max()
    assert size > 1.0


@DIMENSIONS
@BOTH
@pytest.mark.parametrize("angle", (0.1, 1.0, 3.0))
def test_a_turn_by_any_angle_gives_no_stress(d, side, law, angle):
    of, turn = lattice(d, side), np.eye(d)
    turn[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    found = passes(of, of.places @ turn.T + 1.0, law)
    assert np.abs(found.stress).max() < 1e-11 * YOUNG
    assert np.abs(found.force).max() < 1e-11 * YOUNG * DX ** (d - 1)


def test_zigzag_has_no_stiffness_without_hourglass_control():
    """Rows of particles displaced in turn: F does not see it, the control alone pushes back."""
    of = lattice(2, 11, jitter=0.0, uneven=0.0)
    sites = np.rint(of.places / DX).astype(int)
    zigzag = 0.01 * DX * np.where(sites.sum(axis=1) % 2, 1.0, -1.0)[:, None] * np.array([1.0, 0.0])
    middle = len(sites) // 2
    free, held = (passes(of, of.places + zigzag, hourglass=a).force[middle, 0] for a in (0.0, 0.1))
    assert abs(free) < 1e-12 * YOUNG * DX
    assert held / zigzag[middle, 0] < -1e-3 * YOUNG


def test_von_mises_counts_the_stress_out_of_the_plane():
    """Plane strain under a small even pressure in the plane: s_zz is not zero."""
    of = lattice(2, 5)
    strain = 1e-6
    found = passes(of, of.places * (1.0 + strain))
    lame, shear = moduli(YOUNG, POISSON)
    sigma, sigma_zz = 2.0 * (lame + shear) * strain, 2.0 * lame * strain
    assert found.mises == pytest.approx(abs(sigma - sigma_zz), rel=1e-4)


@pytest.mark.parametrize("d", (2, 3))
def test_kelvin_and_voigt_take_energy_from_strain_and_none_from_a_spin(d):
    """P:Ḟ = η Ė:Ė, and a solid that spins as a whole has Ė = 0."""
    random = np.random.default_rng(13)
    f, a, viscosity = np.eye(d) + 0.2 * random.standard_normal((d, d)), (1.0,) * d, 3.0
    unit = tuple(np.eye(d)[np.triu_indices(d)])  # L, so that what is summed is the gradient itself
    spin = random.standard_normal((d, d))
    for rate, strains in ((random.standard_normal((d, d)), True), ((spin - spin.T) @ f, False)):
        folded = (tuple(f.ravel()), tuple(rate.ravel()))
        p = np.reshape(drag(viscosity, tuple(f.ravel()), folded, unit, a), (d, d))
        strain_rate = 0.5 * (f.T @ rate + rate.T @ f)
        assert (p * rate).sum() == pytest.approx(viscosity * (strain_rate**2).sum(), abs=1e-12)
        assert strains == (np.abs(p).max() > 1e-12)
        assert np.abs(p @ f.T - f @ p.T).max() < 1e-12  # no torque
