"""Groups with steps of their own: what they do in several steps is one leapfrog of all these."""

import numpy as np
import pytest
from simulation.test_integrator import RULES
from stores import seen

from psph.simulation.integrator import kick, kick_drift_predict
from psph.simulation.level_clock import LevelClock
from psph.simulation.rules import Columns

DT = 0.1


class Sound:
    """A particle of each pace, all on the same sound: v' = −ω r, r' = ω v, x' = v."""

    def __init__(self, omega, paces):
        n = len(paces)
        self.omega, self.clock = omega, LevelClock(paces, np.arange(n))
        self.rules = RULES._replace(
            own=self.clock.own,
            free=np.uint8(n),
            law_of=np.zeros(n, np.uint8),
            given_pressure=np.zeros(n, bool),
            motion_of=np.zeros(n, np.uint8),
        )
        x, v, predicted, a = ((np.zeros(n),) for _ in range(4))
        v[0][:] = predicted[0][:] = 1.0
        rates = [np.full(n, omega) for _ in range(3)]
        self.columns = Columns(
            np.arange(n, dtype=np.uint8),
            None,
            x,
            v,
            predicted,
            a,
            np.ones(n),
            *rates,
            np.ones(n),
            np.zeros(n),
        )
        self.view = seen(position=x, velocity=predicted, rest_density=1.0, sound_speed=1.0)

    def step(self, number):
        c, n = self.columns, len(self.clock.pace)
        self.clock.turn(number, False)
        kick_drift_predict(0, n, 0.0, DT, self.rules, self.view, c)
        ends = self.clock.ends
        c.density_rate[ends] = self.omega * c.predicted_velocity[0][ends]
        c.acceleration[0][ends] = -self.omega * c.pressure[ends]
        kick(0, n, 0.0, DT, 0.5 * DT, self.rules, self.view, c)

    def state(self):
        c = self.columns
        return np.array([c.position[0], c.velocity[0], c.density, c.density_rate_1, c.density_rate_2])


@pytest.mark.parametrize("pace", [2, 4])
def test_a_step_of_its_own_is_one_leapfrog(pace, monkeypatch):
    coarse = Sound(1.0, (pace, 1))
    for number in range(40):
        coarse.step(number)
    monkeypatch.setitem(globals(), "DT", pace * DT)
    single = Sound(1.0, (1,))
    for number in range(40 // pace):
        single.step(number)
    assert coarse.state()[:, 0] == pytest.approx(single.state()[:, 0], rel=1e-12, abs=1e-12)


def seen_amid(omega):
    """How far off v̂ and ρ̂ are that others see amid a step of 2Δt from an exact state, at its angle of 0.3."""
    sound, angle, turned = Sound(omega, (2,)), 0.3, omega * DT
    c = sound.columns
    c.velocity[0][0], c.density[0], c.acceleration[0][0] = (
        np.cos(angle),
        1 + np.sin(angle),
        -omega * np.sin(angle),
    )
    for rate, back in zip((c.density_rate, c.density_rate_1, c.density_rate_2), (0, 2, 4)):
        rate[0] = omega * np.cos(angle - back * turned)
    sound.step(0)
    now = angle + turned
    return np.abs([c.predicted_velocity[0][0] - np.cos(now), c.pressure[0] - np.sin(now)])


def test_what_is_seen_amid_a_step_is_off_by_terms_of_second_and_third_order():
    whole, half = seen_amid(1.0), seen_amid(0.5)
    assert half[0] < 0.27 * whole[0] and half[1] < 0.15 * whole[1]


def test_with_a_pace_of_one_all_is_as_without():
    own, plain = Sound(1.0, (1, 1)), Sound(1.0, (1, 1))
    plain.rules = plain.rules._replace(own=None)
    for number in range(5):
        own.step(number)
        c = plain.columns
        kick_drift_predict(0, 2, 0.0, DT, plain.rules, plain.view, c)
        plain.columns = c = c._replace(
            density_rate=c.density_rate_2, density_rate_1=c.density_rate, density_rate_2=c.density_rate_1
        )
        c.density_rate[:] = c.predicted_velocity[0]
        c.acceleration[0][:] = -c.pressure
        kick(0, 2, 0.0, DT, 0.5 * DT, plain.rules, plain.view, c)
    assert np.array_equal(own.state(), plain.state())


def test_levels_end_their_steps_together():
    clock = LevelClock((4, 2, 1), np.arange(3))
    ends, seldom = [], []
    for number in range(8):
        clock.turn(number, False)
        ends.append(clock.ends.tolist())
        seldom.append(clock.every(2).tolist())
    assert [sum(column) for column in zip(*ends)] == [2, 4, 8]
    assert all(ends[number][0] for number in (3, 7)) and seldom[7] == [True, True, True]
    assert seldom[3] == [False, True, True]
