"""Operations of a pair, counted: by hand for small formulas, more for more effects."""

from typing import NamedTuple

from physics.pairs import H, OPEN

from psph.physics.continuity import Continuity
from psph.physics.count import flops_per_pair
from psph.physics.pressure import MinimumPressure, SymmetricPressure
from psph.smoothing import kernel

SHARED = ("mass", "sound_speed", "smoothing_length")


class Drag(NamedTuple):
    """A coefficient of u_ij that is a product."""

    strength: float = 2.0

    def shear(self, i, j, pair):
        """One product that varies; that of i alone and the parameter does not."""
        return (self.strength * i.pressure) * j.pressure


def flops(*effects, dimensions=3):
    reductions = tuple(e for e in effects if hasattr(e, "start"))
    k = kernel("wendland-c2", H, dimensions)
    return flops_per_pair(effects, reductions, k, SHARED, OPEN[:dimensions])


def test_by_hand():
    # per axis u_i − u_j, times the coefficient, and into the sum; once the coefficient
    assert [flops(Drag(), dimensions=d) for d in (1, 2, 3)] == [4, 7, 10]
    assert flops() == 0  # nobody reads the geometry


def test_what_is_shared_counts_once():
    both = flops(Continuity(), SymmetricPressure())
    assert both < flops(Continuity()) + flops(SymmetricPressure())
    assert flops(Continuity(), SymmetricPressure(), Drag()) > both
    assert flops(Continuity(), MinimumPressure()) > flops(MinimumPressure())
