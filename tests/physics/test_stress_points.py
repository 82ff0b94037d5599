"""Stress points: who feels whom, and who moves with whom."""

import numpy as np
import pytest
from physics.pairs import pair_of, view
from remedies import remedy

from psph.physics.fluid.continuity import Continuity

VELOCITY, STRESS, WALL = range(3)

StressPoints = remedy("StressPoints")


def three():
    """A velocity point, a stress point and a velocity point in a wall."""
    return view(n=3)._replace(stress_point=np.array([0.0, 1.0, 0.0]), is_fluid=np.array([1.0, 1.0, 0.0]))


@pytest.mark.parametrize("a", (VELOCITY, STRESS))
@pytest.mark.parametrize("b", (VELOCITY, STRESS))
def test_stress_points_push_velocity_points_alone_and_for_two(a, b):
    p = view(n=4)
    i, j, pair = pair_of(p, 3, 0)
    i, j = (q._replace(stress_point=float(of == STRESS)) for q, of in ((i, a), (j, b)))
    times = 2.0 if (a, b) == (VELOCITY, STRESS) else 0.0
    expected = -times * j.mass * j.pressure * j.specific_volume**2 * pair.dw_r
    assert StressPoints().radial(i, j, pair) == pytest.approx(expected)


@pytest.mark.parametrize("b, times", [(VELOCITY, 2.0), (STRESS, 0.0)])
def test_the_density_of_a_stress_point_follows_velocity_points_alone_and_for_two(b, times):
    i, j, pair = pair_of(view(n=4), 3, 0)
    i, j = i._replace(stress_point=1.0), j._replace(stress_point=float(b == STRESS))

    def rate(i):
        return sum(effect.density_rate(i, j, pair) for effect in (Continuity(), StressPoints()))

    plain = Continuity().density_rate(i, j, pair)
    assert rate(i) == pytest.approx(times * plain)
    assert rate(i._replace(stress_point=0.0)) == plain  # a velocity point keeps the sum over all


def test_a_stress_point_moves_with_the_velocity_points_around_it():
    p, effect = three(), StressPoints()
    i, j, pair = pair_of(p, STRESS, VELOCITY)
    total = effect.gather(effect.gather(effect.start(i), i, j, pair), *pair_of(p, STRESS, WALL))
    drift = effect.finish_value(total, i, None)
    assert np.add(i.velocity, drift) == pytest.approx(j.velocity)  # the wall has no part in it
    pull = np.array(effect.finish_acceleration(total, i))
    assert pull == pytest.approx(np.array(drift) * 2.0 * i.sound_speed / i.smoothing_length)
    moved = effect.displacement(i._replace(transport=drift), 1e-3)
    assert moved == pytest.approx(np.array(drift) * 1e-3)


def test_a_velocity_point_and_a_lonely_stress_point_follow_nobody():
    p, effect = three(), StressPoints()
    for a, b in ((VELOCITY, STRESS), (STRESS, WALL)):
        i, j, pair = pair_of(p, a, b)
        total = effect.gather(effect.start(i), i, j, pair)
        for vector in (effect.finish_value(total, i, None), effect.finish_acceleration(total, i)):
            assert vector == pytest.approx((0.0, 0.0))
