"""The integrator on sound, the fastest thing that it meets: v' = −ω r, r' = ω v."""

import numpy as np
import pytest
from stores import seen

from psph.physics import motion
from psph.physics.fluid.state import Linear
from psph.simulation.integrator import kick, kick_drift_predict
from psph.simulation.rules import Columns, Rules

MOTIONS = np.array([motion.FREE, motion.FIXED], np.uint8)
NUMBERS = np.zeros(2, np.uint8)
RULES = Rules(
    (), (Linear(),), NUMBERS, np.zeros(2, bool), np.uint8(1), (), MOTIONS, None, None, None, (None,)
)


def oscillate(theta, steps):
    """Amplitude after ``steps`` steps of ωΔt = ``theta``, from 1; real compiled loops."""
    group = np.zeros(1, np.uint8)
    x, v, predicted, a = ((np.zeros(1),) for _ in range(4))
    density, volume, pressure = np.ones(1), np.ones(1), np.zeros(1)
    rates = [np.zeros(1) for _ in range(3)]
    v[0][0] = predicted[0][0] = 1.0
    view = seen(position=x, velocity=predicted, rest_density=1.0, sound_speed=1.0)
    for rate in rates:
        rate[0] = theta
    for _ in range(steps):
        columns = Columns(group, None, x, v, predicted, a, density, *rates, volume, pressure)
        kick_drift_predict(0, 1, 0.0, 1.0, RULES, view, columns)
        rates = [rates[2], rates[0], rates[1]]
        rates[0][0] = theta * predicted[0][0]
        a[0][0] = -theta * pressure[0]
        kick(0, 1, 0.0, 1.0, 0.5, RULES, view, columns._replace(density_rate=rates[0]))
    return np.hypot(v[0][0], density[0] - 1.0)


@pytest.mark.parametrize("theta, damping", [(0.1, 1.9e-7), (0.2, 1.2e-5), (0.4, 8.5e-4)])
def test_sound_neither_grows_nor_fades(theta, damping):
    steps = 4000
    amplitude = oscillate(theta, steps)
    assert np.exp(-1.3 * damping * steps) - 0.02 < amplitude < 1.02


def test_it_is_stable_up_to_the_limit_and_not_beyond():
    assert oscillate(0.6, 4000) < 1.0
    assert not oscillate(1.2, 400) < 1e3  # the control


def test_first_order_prediction_would_grow():
    """The control: weights (1, 0, 0) make sound grow by θ⁴/4 a step."""

    def growth(c, theta):
        def step(s):
            r, v, d0, d1, d2, a0 = s
            predicted = r + c[0] * d0 + c[1] * d1 + c[2] * d2
            d, a = theta * (v + a0), -theta * predicted
            return np.array([r + 0.5 * (d0 + d), v + 0.5 * (a0 + a), d, d0, d1, a])

        matrix = np.array([step(e) for e in np.eye(6)]).T
        return np.abs(np.linalg.eigvals(matrix)).max() - 1.0

    assert growth((1.0, 0.0, 0.0), 0.2) == pytest.approx(0.2**4 / 4, rel=0.1)
    assert growth((1.75, -1.0, 0.25), 0.2) == pytest.approx(-1.2e-5, rel=0.1)
    assert growth((1.75, -1.0, 0.25), 0.1) == pytest.approx(-1.9e-7, rel=0.1)


def test_walls_stay_and_lost_numbers_are_reported():
    group = np.array([1, 0], np.uint8)
    x, v, predicted, a = ((np.zeros(2),) for _ in range(4))
    a[0][:] = 5.0, np.nan
    rates = [np.zeros(2) for _ in range(3)]
    density, volume, pressure = np.ones(2), np.ones(2), np.zeros(2)
    view = seen(position=x, velocity=predicted, rest_density=1.0, sound_speed=1.0)
    columns = Columns(group, None, x, v, predicted, a, density, *rates, volume, pressure)
    kick_drift_predict(0, 2, 0.0, 0.1, RULES, view, columns)
    *_, error, _, _ = kick(0, 2, 0.0, 0.1, 0.05, RULES, view, columns)
    assert x[0][0] == v[0][0] == 0.0 and error == np.inf
    a[0][1] = v[0][1] = 0.0
    *_, error, _, _ = kick(0, 2, 0.0, 0.1, 0.05, RULES, view, columns)
    assert error == np.inf  # its place is lost
    x[0][1] = 1.0
    *_, error, _, _ = kick(0, 2, 0.0, 0.1, 0.05, RULES, view, columns)
    assert error == abs(density - 1.0).max() < np.inf
