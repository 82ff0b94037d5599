"""Weibull's strengths: their distribution, and that they are the same wherever a particle is."""

import numpy as np
import pytest

from psph.physics.solid.cracks import strengths


def test_strengths_are_weibulls_and_belong_to_the_id():
    ids = np.arange(200_000)
    found = strengths(ids, 3, 5.0)
    assert found.mean() == pytest.approx(1.0, rel=2e-3)
    scale = 1.0 / 0.9181687423997607  # Γ(1 + 1/5)
    for level in (0.6, 1.0, 1.3):
        assert (found < level).mean() == pytest.approx(1.0 - np.exp(-((level / scale) ** 5.0)), abs=3e-3)
    some = np.array([70_001, 5, 12])
    assert np.array_equal(strengths(some, 3, 5.0), found[some])
    assert not np.array_equal(strengths(some, 4, 5.0), found[some])
