"""Particles of many sizes: levels of cells look at few, however unlike sizes are."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from psph.lab.bench.uneven import SIZES, SMOOTHING, alike, cost, ghosts, layers, nests


@pytest.mark.parametrize(("dimensions", "side"), [(2, 24), (3, 12)])
@pytest.mark.parametrize("ratio", [1, 10, 100])
def test_candidates_do_not_grow_with_the_ratio_of_sizes(dimensions, side, ratio):
    """Cells as wide as the largest reaches would hold 60 to 130 candidates a neighbour at 10 : 1."""
    assert 1.0 < cost(dimensions, ratio, side, repeats=1).candidates < 6.0


@pytest.mark.parametrize(("dimensions", "side"), [(2, 24), (3, 12)])
def test_lists_of_one_size_are_timed(dimensions, side):
    """A clock has no right answer: some nanoseconds an entry, not none and no microseconds."""
    assert 0.1 < alike(dimensions, side, repeats=1) < 1000.0


def test_nests_are_as_fine_as_they_say():
    """The distance to the nearest neighbour falls with the spacing."""
    x, spacing = nests(2, 10.0, 24)
    assert spacing.max() / spacing.min() == pytest.approx(10.0)
    apart = cKDTree(x.T).query(x.T, 2)[0][:, 1]
    for one in np.unique(spacing):
        assert 0.5 < np.median(apart[spacing == one]) / one < 1.0


def test_ghosts_are_those_in_reach_and_planes_hold_them_all():
    """Counted over all pairs; where it is fine thin planes hold fewer than those as wide as the coarse reach,
    where coarse particles stand in every plane no fewer."""
    counts = []
    for cut in (0.0, 0.4):
        x, spacing = layers(2, 4, 24)
        reach, x = SIZES.reach(SMOOTHING * spacing), np.array([x[0] - cut, x[1]])
        own = np.abs(x[0]) < 0.5
        x, reach = x[:, own], reach[own]
        below, above = x[0] < 0.0, x[0] >= 0.0
        apart = np.linalg.norm(x[:, below].T[:, None] - x[:, above].T, axis=2)
        met = (apart < np.maximum(reach[below][:, None], reach[above])).any(axis=1).sum()
        counts.append(ghosts(x, reach))
        assert counts[-1].reach == met <= min(counts[-1].planes, counts[-1].thin)
    assert counts[1].thin < 0.7 * counts[1].planes
