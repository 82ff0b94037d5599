"""The tree against the direct sum: its errors, its cost, and scenes that are hard on trees."""

import numpy as np
import pytest

from psph.lab.bench.gravity import ACCURACY, by_tree, errors, even, evrard, plummer, pulls, rows_of
from psph.particles import octree as octree_room
from psph.particles.octree import octree
from psph.physics.self_gravity import softened_by_both
from psph.simulation.direct_sum import DirectSum
from psph.simulation.masses import WHOLE


def with_sizes(rows, reach) -> np.ndarray:
    """The rows of particles that ``reach`` (n,) m, each by its size."""
    return np.hstack([rows, np.asarray(reach)[:, None]])


def clumps(n, rng):
    """Two small ones, far apart and far from the origin."""
    place = 0.1 * plummer(n, rng) + 1000.0
    place[n // 2 :, 0] += 50.0
    return place


@pytest.mark.parametrize("cloud", [plummer, even, evrard, clumps])
def test_pulls_are_those_of_the_direct_sum(cloud):
    rng = np.random.default_rng(1)
    rows, reach = rows_of(cloud(8000, rng)), 0.07
    exact = pulls(DirectSum(1.0, reach), rows)
    found, tree = by_tree(rows, reach)
    off = errors(found, exact)
    assert np.sqrt((off**2).mean()) < 1.2e-3
    assert np.quantile(off, 0.99) < 4e-3
    assert off.max() < 2e-2
    assert abs(found[3].sum() / exact[3].sum() - 1.0) < 1e-4
    momentum = np.linalg.norm(found[:3].mean(axis=1)) / np.linalg.norm(exact[:3], axis=0).mean()
    assert 1e-7 < momentum < 2e-4  # not to rounding, as by all pairs
    assert tree.pairs + tree.cells < 0.2 * len(rows) ** 2


def test_second_moments_and_the_opening_are_what_makes_it_so(monkeypatch):
    """The controls: at the same opening without second moments, and with cells that are too near."""
    rows, reach = rows_of(plummer(8000, np.random.default_rng(1))), 0.07
    exact = pulls(DirectSum(1.0, reach), rows)
    rms = {
        name: np.sqrt((errors(by_tree(rows, reach, a)[0], exact) ** 2).mean())
        for name, a in (("fine", ACCURACY), ("coarse", 0.1))
    }
    assert rms["coarse"] > 2.5 * rms["fine"]
    whole = octree_room.moments

    def masses_alone(tree, mass):
        found = whole(tree, mass)
        found.cells[:, 4:] = 0.0
        return found

    monkeypatch.setattr("psph.simulation.tree_sum.moments", masses_alone)
    bare = errors(by_tree(rows, reach)[0], exact)
    assert np.sqrt((bare**2).mean()) > max(3.0 * rms["fine"], 2e-3)


def test_a_wide_kernel_softens_cells_too():
    """Most of the cells that are seen lie within a kernel as wide as half of the ball."""
    rows = rows_of(even(4000, np.random.default_rng(2)))
    exact = pulls(DirectSum(1.0, 1.0), rows)
    assert errors(by_tree(rows, 1.0)[0], exact).max() < 1e-2
    assert (
        np.median(errors(pulls(DirectSum(1.0, 0.01), rows), exact)) > 0.1
    )  # the control: Newton's is another


def test_particles_of_unlike_sizes_have_the_mean_of_both_fields():
    """By all pairs as written out; by a tree within its error, where cells are beyond all reach."""
    rng = np.random.default_rng(5)
    place, reach = plummer(4000, rng), rng.uniform(0.02, 0.4, 4000)
    rows = with_sizes(rows_of(place), reach)
    exact = pulls(DirectSum(1.0, None), rows)
    assert errors(by_tree(rows, None)[0], exact).max() < 2e-2
    x, mean = place[7] - place, np.zeros(4)
    for near, far in zip(x, reach):
        g, f = softened_by_both(float(np.linalg.norm(near)), reach[7], far)
        mean -= np.array([*(g * near), 0.5 * f]) / 4000
    assert exact[:, 7] == pytest.approx(mean, rel=1e-10)
    alike = pulls(DirectSum(1.0, 0.21), rows)
    assert np.sqrt((errors(alike, exact) ** 2).mean()) > 0.02  # the control: one reach is another field


def test_each_rank_gets_the_bits_of_one():
    """Any share of the particles; a tree that is made anew from all masses."""
    rng = np.random.default_rng(3)
    rows = rows_of(plummer(3000, rng), rng.uniform(0.5, 1.5, 3000))
    rows[2000:, WHOLE] = 1.0
    exact = pulls(DirectSum(1.0, 0.1), rows)
    every, tree = by_tree(rows, 0.1)
    assert errors(every, exact).max() < 1e-2
    share = np.sort(rng.choice(3000, 700, replace=False))
    some, _ = by_tree(rows, 0.1, columns=share)
    assert np.array_equal(some[:, share], every[:, share])
    assert np.isnan(np.delete(some, share, axis=1)).any(axis=0).all()
    none, _ = by_tree(rows, 0.1, columns=share[:0])
    assert np.isnan(none[3]).all()


@pytest.mark.parametrize(
    "place",
    [
        np.zeros((0, 3)),
        np.array([[3.0, 4.0, 5.0]]),
        np.full((300, 3), 7.0),
        np.repeat([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], 200, axis=0),
        np.linspace(0.0, 1.0, 500)[:, None] * [1.0, 0.0, 0.0],
    ],
    ids=["none", "one", "in one place", "in two places", "in a line"],
)
def test_odd_clouds(place):
    rows = rows_of(np.asarray(place, float))
    exact, (found, _) = pulls(DirectSum(1.0, 0.1), rows), by_tree(rows, 0.1)
    size = max(np.abs(exact).max(initial=0.0), 1e-9)
    assert found == pytest.approx(exact, abs=3e-3 * size)


def test_cells_are_those_of_one_grid():
    """Each particle is in one group; boxes and moments are those of the particles within."""
    rng = np.random.default_rng(4)
    place, mass = plummer(2000, rng), rng.random(2000)
    tree = octree(place)
    weights = octree_room.moments(tree, mass)
    spans = sorted(zip(tree.first[tree.groups].tolist(), tree.last[tree.groups].tolist()))
    assert spans[0][0] == 0 and spans[-1][1] == 2000
    assert all(end == begin for (_, end), (begin, _) in zip(spans, spans[1:]))
    for cell in rng.choice(len(tree.first), 40):
        own = slice(tree.first[cell], tree.last[cell])
        x, m = tree.places[:, own].T, weights.mass[own]
        centre = m @ x / m.sum()
        second = np.einsum("k,ka,kb->ab", m, x - centre, x - centre)
        assert weights.cells[cell, :4] == pytest.approx([*centre, m.sum()])
        assert weights.cells[cell, 4:] == pytest.approx(second[np.triu_indices(3)], abs=1e-12)
        assert np.array_equal(tree.lower[:, cell], x.min(axis=0))
        assert (((x - centre) ** 2).sum(axis=1) <= weights.radius2[cell] * (1 + 1e-12)).all()
