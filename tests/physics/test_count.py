"""The operations of a pair, counted by hand and by the trial call."""

import pytest

from psph.composition.count import flops_per_pair
from psph.physics.catalogue import (
    BUILT_IN,
    ArtificialViscosity,
    Continuity,
    FreeSurface,
    MinimumPressure,
    SymmetricPressure,
)
from psph.smoothing import KERNELS, kernel

SHARED = ("mass", "rest_density", "sound_speed", "smoothing_length")


def count(*effects, dim=1, name="wendland-c2", shared=SHARED):
    reductions = tuple(e for e in effects if hasattr(e, "start"))
    return flops_per_pair(
        effects, reductions, kernel(name, 0.1, dim), BUILT_IN.fields.values(), shared, (None,) * dim
    )


def geometry_by_hand(dim):
    """x_ij, r², √(r² + tiny), m_j, and W′/r of Wendland C2: 3 for a, 2 for a³, 1 for the factor."""
    return dim + (2 * dim - 1) + 2 + 1 + 6


@pytest.mark.parametrize("dim", [1, 2, 3])
def test_continuity_by_hand(dim):
    velocities = dim + (2 * dim - 1)  # u_ij and u·x
    assert count(Continuity(), dim=dim) == geometry_by_hand(dim) + velocities + 1 + 1


@pytest.mark.parametrize("dim", [1, 2, 3])
def test_symmetric_pressure_by_hand(dim):
    # p_j v_j v_j, the sum, times m_j W′/r; then x_ij times it onto the acceleration.
    assert count(SymmetricPressure(), dim=dim) == geometry_by_hand(dim) + 2 + 1 + 1 + 2 * dim


def test_shared_geometry_counts_once():
    both = count(Continuity(), SymmetricPressure(), dim=3)
    assert both == count(Continuity(), dim=3) + count(SymmetricPressure(), dim=3) - geometry_by_hand(3)


def test_what_belongs_to_the_particle_itself_is_free():
    alike = count(Continuity(), dim=2)
    assert count(Continuity(), dim=2, shared=SHARED[1:]) == alike  # m_j in place of m
    assert count(ArtificialViscosity(0.1, 0.5)) == count(ArtificialViscosity(0.0, 0.0))


def test_a_sum_of_its_own_counts():
    # W: s, 0.5 s, 1 − that, a², α a² twice, 1 + 2s, times; then m v, times W; sum.
    w = 1 + 2 + 1 + 2 + 2 + 1
    more = count(MinimumPressure(), FreeSurface(), dim=2) - count(MinimumPressure(), dim=2)
    assert more == w + 1 + 1 + 1


@pytest.mark.parametrize("name", KERNELS)
def test_every_kernel_can_be_counted(name):
    assert count(Continuity(), FreeSurface(), dim=2, name=name) > count(Continuity(), dim=2, name=name)


def test_nothing_costs_nothing():
    assert count(dim=3) == 0
