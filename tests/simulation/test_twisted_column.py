"""A column of rubber, 6 m high and 1 m wide, that is twisted by a spin of ω₀ sin(πz/2L): no particle turns inside out."""

import numpy as np
import pytest
from drafts import draft
from gauging import start
from long import LONG, tell
from scipy.spatial import cKDTree

from psph.physics.solid.deformation import SMOOTHING, support_of

DX, HEIGHT = 1.0 / 6.0, 6.0

COLUMN = f"""
time.end = 1.0
space = {{ dimensions = 3, spacing = {DX!r} }}
[solids.column]
shape.box = {{ lower = [-0.5, -0.5, {-9.0 * DX!r}], upper = [0.5, 0.5, {HEIGHT}] }}
clamped.box = {{ lower = [-0.5, -0.5, {-9.0 * DX!r}], upper = [0.5, 0.5, 0.0] }}
density = 1100.0
young = 17.0e6
poisson = 0.45
law = "neo-hookean"
"""


def dilations(places, now):
    """J = det F of each particle (n,), by plain numpy from X and x (n, 3) in m, as docs/solids.md has F."""
    h = SMOOTHING * DX
    pairs = cKDTree(places).query_pairs(support_of(h) * (1.0 - 1e-9), output_type="ndarray")
    i, j = np.vstack([pairs, pairs[:, ::-1]]).T
    apart, x_ij = places[i] - places[j], now[i] - now[j]
    weight = (1.0 - 0.5 * np.linalg.norm(apart, axis=1) / h) ** 3  # −W′/r but for a factor
    sums = np.zeros((2, len(places), 3, 3))
    for of, left in zip(sums, (x_ij, apart)):
        np.add.at(of, i, weight[:, None, None] * left[:, :, None] * apart[:, None, :])
    return np.linalg.det(sums[0] @ np.linalg.inv(sums[1]))


def twisted(case, spin, end):
    """Smallest J, largest relative error of the energy, lowest and highest z of the top, m, until ``end`` s."""
    simulation = start(case)
    store = simulation.store
    x, y, z = store.shown("reference").T
    turn = spin * np.sin(0.5 * np.pi * np.maximum(z, 0.0) / HEIGHT)
    for name in ("velocity", "predicted_velocity"):
        for axis, value in ((0, -turn * y), (1, turn * x)):
            store[name][axis][store.inner] = value

    def energy():
        speed2 = (store.shown("velocity") ** 2).sum(axis=1)
        return 0.5 * (store.shown("mass") * speed2).sum() + simulation.engine.stored_energy()

    begun, found = energy(), []
    for time in np.linspace(0.0, end, 61)[1:]:
        while simulation.time < time:
            simulation.step()
        now = store.shown("position")
        least = dilations(store.shown("reference"), now).min()
        found.append((least, abs(energy() / begun - 1.0), now[:, 2].max(), now[:, 2].max()))
    least, error, low, high = np.transpose(found)
    return least.min(), error.max(), low.min(), high.max()


@LONG
@pytest.mark.parametrize("spin", (105.0, 400.0))
def test_a_column_of_rubber_stands_a_twist(spin, tmp_path):
    least, error, _, high = twisted(draft(tmp_path, COLUMN), spin, 0.3)
    tell(f"column twisted at {spin:g} rad/s: smallest J {least:.2f}, energy to {error:.1e}")
    assert least > 0.3 and error < 0.01
    assert high > 6.02  # it springs back beyond its height


@LONG
def test_a_law_of_small_strains_lets_it_turn_inside_out(tmp_path):
    """The control: Saint Venant and Kirchhoff's has no stiffness below a stretch of 1/√3, and the column folds up."""
    least, _, low, _ = twisted(
        draft(tmp_path, COLUMN, "solids.column.law=saint-venant-kirchhoff"), 400.0, 0.3
    )
    assert least < -0.3 and low < 2.0
