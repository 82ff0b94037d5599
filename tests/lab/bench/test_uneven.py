"""Particles of many sizes: levels of cells look at few, however unlike sizes are."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from psph.lab.bench.uneven import cost, nests


@pytest.mark.parametrize(("dimensions", "side"), [(2, 24), (3, 12)])
@pytest.mark.parametrize("ratio", [1, 10, 100])
def test_candidates_do_not_grow_with_the_ratio_of_sizes(dimensions, side, ratio):
    """Cells as wide as the largest reaches would hold 60 to 130 candidates a neighbour at 10 : 1."""
    assert 1.0 < cost(dimensions, ratio, side, repeats=1).candidates < 6.0


def test_nests_are_as_fine_as_they_say():
    """The distance to the nearest neighbour falls with the spacing."""
    x, spacing = nests(2, 10.0, 24)
    assert spacing.max() / spacing.min() == pytest.approx(10.0)
    apart = cKDTree(x.T).query(x.T, 2)[0][:, 1]
    for one in np.unique(spacing):
        assert 0.5 < np.median(apart[spacing == one]) / one < 1.0
