"""The curl of the velocity, from particles."""

import numpy as np
import pytest

from psph.output.pictures.vorticity import vorticity


def scattered(dimensions, count, seed=5):
    """Particles of a shaken lattice in the unit box, and volumes that differ."""
    rng = np.random.default_rng(seed)
    places = (
        np.stack(np.meshgrid(*[np.arange(count)] * dimensions), -1).reshape(-1, dimensions) + 0.5
    ) / count
    places += rng.uniform(-0.2, 0.2, places.shape) / count
    return places, rng.uniform(0.7, 1.3, len(places)) / count**dimensions


def test_a_body_that_turns_has_twice_its_rate_up_to_its_surface():
    for dimensions, count in ((2, 12), (3, 8)):
        x, volume = scattered(dimensions, count)
        spin = np.array([0.3, -0.7, 1.1])
        arms = np.zeros((len(x), 3))
        arms[:, :dimensions] = x - 0.5
        u = np.cross(spin * ([1, 1, 1] if dimensions == 3 else [0, 0, 1]), arms)[:, :dimensions] + 2.0
        omega = vorticity(x, u, volume, 2.8 / count, [0.0] * dimensions)
        expected = 2 * spin if dimensions == 3 else np.full(len(x), 2 * spin[2])
        assert np.abs(omega - expected).max() < 1e-10


def test_strain_has_none():
    x, volume = scattered(3, 8)
    rate = np.array([[0.3, 0.2, -0.5], [0.2, -0.6, 0.1], [-0.5, 0.1, 0.3]])
    assert np.abs(vorticity(x, x @ rate.T, volume, 0.35, [0.0] * 3)).max() < 1e-10


@pytest.mark.parametrize("shake", [0.0, 0.1])
def test_taylor_green_vortices_in_a_periodic_box(shake):
    count, k = 50, 2 * np.pi
    x, _ = scattered(2, count)
    x = (np.floor(x * count) + 0.5) / count + shake / 0.2 * (x - (np.floor(x * count) + 0.5) / count)
    u = np.stack([-np.cos(k * x[:, 0]) * np.sin(k * x[:, 1]), np.sin(k * x[:, 0]) * np.cos(k * x[:, 1])], 1)
    exact = 2 * k * np.cos(k * x[:, 0]) * np.cos(k * x[:, 1])
    volume = np.full(len(x), 1 / count**2)
    off = vorticity(x + [0.31, -0.4], u, volume, 2.8 / count, [1.0, 1.0]) - exact
    assert np.abs(off).max() < 0.03 * 2 * k
    open_ends = vorticity(x, u, volume, 2.8 / count, [0.0, 0.0]) - exact
    assert (
        np.abs(open_ends).max() > 1.2 * np.abs(off).max()
    )  # a box that is not periodic is worse at its ends


def test_spray_and_what_was_thrown_away_have_none():
    x, volume = scattered(2, 6)
    x = np.concatenate([x, [[3.0, 3.0], [np.nan, 0.0], [5.0, 5.0], [5.1, 5.1]]])
    omega = vorticity(x, x[:, ::-1] * [-1.0, 1.0], np.append(volume, [0.03] * 4), 0.5, [0.0, 0.0])
    assert np.isnan(omega[-4:]).all() and omega[:-4] == pytest.approx(np.full(36, 2.0))


def test_blocks_of_particles_make_no_difference(monkeypatch):
    x, volume = scattered(2, 12)
    u = np.sin(7 * x[:, ::-1])
    whole = vorticity(x, u, volume, 0.25, [0.0, 0.0])
    monkeypatch.setattr("psph.output.pictures.vorticity.BLOCK", 37)
    assert vorticity(x, u, volume, 0.25, [0.0, 0.0]) == pytest.approx(whole, rel=1e-12)
