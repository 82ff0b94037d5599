"""The artificial stress of solids: what of a stress pulls, and how a pair repels."""

import numpy as np
import pytest
from stores import seen

from psph.composition.pair import Pair
from psph.physics.stress.repulsion import PrincipalStress, pulled


@pytest.mark.parametrize("d", (2, 3))
def test_what_pulls_is_what_eigenvectors_tell(d):
    rng = np.random.default_rng(1)
    upper = np.triu_indices(d)
    for k in range(60):
        m = rng.normal(size=(d, d)) * 10.0 ** rng.integers(-6, 6)
        m = {0: np.diag(np.diag(m)), 1: np.eye(d) * m[0, 0]}.get(k % 5, m + m.T)
        values, vectors = np.linalg.eigh(m)
        expected = ((vectors * np.maximum(values, 0.0)) @ vectors.T)[upper]
        assert pulled(tuple(m[upper]), (0.0,) * d) == pytest.approx(expected, abs=1e-12 * abs(m).max())
    assert pulled((0.0,) * len(upper[0]), (0.0,) * d) == (0.0,) * len(upper[0])


def test_a_pair_repels_along_the_tension_alone():
    effect = PrincipalStress(0.3, 1.0 / 0.8)
    still = {"position": (0.0, 0.0), "specific_volume": 0.5}
    drawn = seen(deviator=(5.0, 0.0, -1.0), pressure=-1.0, repulsion=None, **still)  # σ = (6, 0)
    stress = effect.finish_value(0.0, drawn, None)
    assert stress == pytest.approx((-0.3 * 6.0 * 0.25, 0.0, 0.0))
    one = seen(repulsion=stress, **still)
    other = seen(repulsion=(0.0, 0.0, 0.0), **still)
    pair = Pair(x_ij=(0.7, 0.4), w=0.8, m_dw_r=-2.0)
    assert effect.push(one, other, pair) == pytest.approx((0.45 * 0.7 * 2.0, 0.0))
    nearer = Pair(x_ij=(0.7, 0.4), w=1.6, m_dw_r=-2.0)
    assert effect.push(one, other, nearer)[0] == pytest.approx(16.0 * 0.45 * 0.7 * 2.0)
