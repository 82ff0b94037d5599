"""Numbers of curves of which they are known."""

import math

import numpy as np
import pytest

from psph.theory.curves import crests, moments, oscillation, overtopping
from psph.theory.curves.catalogue import TAKEN
from psph.theory.curves.number import Curve, NoNumber
from psph.theory.curves.spectrum import highest_third, peak_period, significant_height, spectrum

TIME = np.linspace(0.0, 10.0, 2001)


def uneven(rows: int = 2000, end: float = 10.0) -> np.ndarray:
    """Times of steps that are not equal."""
    steps = np.random.default_rng(3).uniform(0.5, 1.5, rows)
    return np.concatenate([[0.0], np.cumsum(steps) * end / steps.sum()])


def test_moments_of_a_sine_with_a_drift_in_uneven_steps():
    t = uneven()
    curve = Curve(t, 2.0 + 0.3 * t + np.sin(2.0 * math.pi * t / 2.0))
    assert moments.mean(curve).value == pytest.approx(2.0 + 0.3 * 5.0, abs=1e-4)
    assert moments.impulse(curve).value == pytest.approx(10.0 * 3.5, abs=1e-3)
    assert moments.change(curve).value == pytest.approx(3.0)
    top = moments.maximum(curve)
    assert top.value == pytest.approx(2.0 + 0.3 * 8.53 + 1.0, abs=0.01)
    assert top.time == pytest.approx(8.53, abs=0.02)
    assert moments.minimum(curve).time == pytest.approx(1.47, abs=0.02)
    plain = Curve(TIME, np.sin(2.0 * math.pi * TIME / 2.0))
    assert moments.spread(plain).value == pytest.approx(math.sqrt(0.5), rel=1e-4)
    assert moments.amplitude(plain).value == pytest.approx(1.0, rel=1e-4)


def test_the_mean_of_noise_lies_within_its_reach_nine_times_in_ten():
    random, inside, reaches = np.random.default_rng(1), 0, []
    for _ in range(200):
        noise = np.convolve(random.normal(size=2050), np.ones(50) / 50.0, "valid")[:2001]
        found = moments.mean(Curve(TIME, noise))
        inside += abs(found.value) < found.reach
        reaches.append(found.reach)
    assert 165 <= inside <= 195
    assert np.mean(reaches) == pytest.approx(1.6449 / math.sqrt(2000.0), rel=0.15)


@pytest.mark.parametrize("damping", [0.0, 0.3])
def test_period_of_a_damped_swing_about_any_place(damping):
    swing = 5.0 + np.exp(-damping * TIME) * np.cos(2.0 * math.pi * TIME / 1.3)
    found = oscillation.mean_period(Curve(TIME, swing + 0.02 * TIME))
    assert found.value == pytest.approx(1.3, rel=2e-3) and found.reach < 0.01
    noise = np.random.default_rng(2).normal(size=len(TIME))
    assert oscillation.mean_period(Curve(TIME, swing + 0.01 * noise)).value == pytest.approx(1.3, rel=0.01)
    with pytest.raises(NoNumber, match="no two maxima"):
        oscillation.mean_period(Curve(TIME, TIME))


def test_arrival_of_a_step_and_of_a_ramp():
    assert oscillation.arrival(Curve(TIME, np.where(TIME > 3.0, 4.0, 0.0))).value == pytest.approx(
        3.0, abs=5e-3
    )
    ramp = Curve(uneven(40), np.clip(uneven(40) - 2.0, 0.0, 3.0))
    assert oscillation.arrival(ramp, 1.0).value == pytest.approx(3.0, abs=1e-9)
    assert oscillation.arrival(Curve(TIME, -TIME), -4.0).value == pytest.approx(4.0)
    with pytest.raises(NoNumber, match="it never comes there, 9"):
        oscillation.arrival(ramp, 9.0)
    with pytest.raises(NoNumber, match="it never comes there, 1"):
        oscillation.arrival(Curve(TIME, np.ones(len(TIME))))


def test_crossings_of_a_level_do_not_count_noise():
    sine = np.sin(2.0 * math.pi * TIME / 2.0 - 0.5)
    noise = 0.02 * np.random.default_rng(4).normal(size=len(TIME))
    assert oscillation.crossings(Curve(TIME, sine + noise), 0.0).value == 5.0
    times = oscillation.up_crossings(Curve(TIME, sine), 0.0)
    assert times == pytest.approx(np.arange(5) * 2.0 + 0.5 / math.pi, abs=1e-5)
    assert oscillation.crossings(Curve(TIME, sine), 2.0).value == 0.0


def test_a_period_leaves_out_where_a_curve_has_no_value():
    """As of a point that falls dry for a while."""
    swing = np.sin(2.0 * np.pi * TIME / 1.3)
    dry = (TIME > 5.0) & (TIME < 9.0)
    found = oscillation.mean_period(Curve.of(TIME, np.where(dry, np.nan, swing)))
    assert found.value == pytest.approx(1.3, rel=0.01)


def test_response_is_the_ratio_of_amplitudes_at_the_period_of_the_wave():
    angle = 2.0 * math.pi * TIME / 1.7
    wave = Curve(TIME, 0.5 + 0.04 * np.cos(angle) + 0.01 * np.cos(2.0 * angle))
    heave = Curve(TIME, 1.0 + 0.05 * TIME + 0.07 * np.sin(angle - 0.4) + 0.003 * np.sin(3.0 * angle))
    found = oscillation.response(heave, wave)
    assert found.value == pytest.approx(0.07 / 0.04, rel=0.01) and found.reach < 0.1
    assert oscillation.response(heave, wave, 1.7).value == pytest.approx(0.07 / 0.04, rel=2e-3)
    with pytest.raises(NoNumber, match="does not swing"):
        oscillation.response(heave, Curve(TIME, np.ones(len(TIME))), 1.7)
    with pytest.raises(NoNumber, match="less than a period"):
        oscillation.response(heave, wave, 20.0)


def test_a_period_needs_no_row_at_its_end():
    """Rows each 0.02 s of a wave of 1.5 s: the one at 1.5 s would be the first of the next period."""
    time = 3.0 + 0.02 * np.arange(75)
    angle = 2.0 * math.pi * time / 1.5
    wave, push = Curve(time, 0.1 * np.cos(angle)), Curve(time, 50.0 * np.sin(angle))
    assert oscillation.response(push, wave, 1.5).value == pytest.approx(500.0)
    with pytest.raises(NoNumber, match="less than a period"):
        oscillation.response(push, wave, 1.53)


def jonswap(height: float, peak: float, lasts: float, seed: int) -> Curve:
    """A sea with H_s, m, and T_p, s, of 400 waves with phases at random (Hasselmann and others 1973)."""
    frequency = np.arange(1, 4 * round(lasts / peak) + 1) / lasts
    x = frequency * peak
    width = np.where(x <= 1.0, 0.07, 0.09)
    shape = frequency**-5.0 * np.exp(-1.25 * x**-4.0) * 3.3 ** np.exp(-((x - 1.0) ** 2) / (2.0 * width**2))
    size = np.sqrt(2.0 * shape / shape.sum()) * height / 4.0
    phase = np.random.default_rng(seed).uniform(0.0, 2.0 * math.pi, len(frequency))
    t = np.arange(0.0, lasts, peak / 40.0)
    return Curve(t, 3.0 + (size * np.cos(2.0 * math.pi * np.outer(t, frequency) + phase)).sum(axis=1))


def test_height_and_period_of_a_sea_that_is_known():
    sea = jonswap(0.12, 1.6, 160.0, 5)
    height, period = significant_height(sea), peak_period(sea)
    assert height.value == pytest.approx(0.12, rel=0.01) and abs(height.value - 0.12) < height.reach < 0.02
    assert period.value == pytest.approx(1.6, rel=0.04) and abs(period.value - 1.6) < period.reach
    frequency, density = spectrum(sea)
    assert float(density.sum() * (frequency[1] - frequency[0])) == pytest.approx((0.12 / 4.0) ** 2, rel=0.1)
    # Of narrow seas H_1/3 is a little below H_m0 (Longuet-Higgins 1952; Forristall 1978).
    assert 0.88 < highest_third(sea).value / height.value < 1.0
    still = significant_height(Curve(TIME, np.ones(len(TIME))))
    assert still.value == 0.0
    with pytest.raises(NoNumber, match="does not swing"):
        peak_period(Curve(TIME, np.ones(len(TIME))))
    with pytest.raises(NoNumber, match="too few"):
        significant_height(Curve(TIME[:3], TIME[:3]))


def test_crests_of_waves_one_by_one():
    """Of heights after Rayleigh 2 % exceed ½√(½ ln 50) H_s; a regular wave's are all alike.  Waves lower than a
    twentieth of the swing do not count."""
    time = np.arange(0.0, 2000.0, 0.05)
    heights = np.random.default_rng(6).rayleigh(0.25 * 0.12, 2000)
    swash = Curve(time, np.repeat(heights, 20)[: len(time)] * np.sin(2.0 * math.pi * time))
    rare = crests.rare_crest(swash, 0.0).value
    assert rare == pytest.approx(0.5 * math.sqrt(0.5 * math.log(50.0)) * 0.12, rel=0.05)
    counted = heights[heights > 0.05 * swash.swing]
    assert crests.mean_crest(swash, 0.0).value == pytest.approx(counted.mean(), rel=1e-3)
    regular = Curve(TIME, 0.3 + 0.1 * np.sin(2.0 * math.pi * TIME / 1.3))
    assert crests.mean_crest(regular).value == pytest.approx(0.4, abs=1e-4)
    flickers = Curve(TIME, np.where(np.arange(len(TIME)) % 50 == 0, 0.2, regular.value))
    assert crests.mean_crest(flickers).value < 0.39 < crests.mean_crest(flickers, rest=0.7).value
    with pytest.raises(NoNumber, match="takes 49 waves, of 6 .*take mean_crest"):
        crests.rare_crest(regular)
    with pytest.raises(NoNumber, match="no wave from one rise"):
        crests.mean_crest(Curve(TIME, TIME))


@pytest.mark.parametrize("waves", (3.5, 5.0, 8.0, 20.0))
def test_a_short_record_has_the_period_of_its_waves(waves):
    """In four parts each would be shorter than a wave, and its length would pass for the period."""
    time = np.linspace(0.0, 1.2 * waves, round(40 * waves))
    found = peak_period(Curve(time, np.sin(2.0 * np.pi * time / 1.2)))
    assert found.value == pytest.approx(1.2, rel=0.05) and abs(found.value - 1.2) < found.reach


def test_less_than_three_waves_have_no_peak_period():
    time = np.linspace(0.0, 2.4, 80)
    with pytest.raises(NoNumber, match="less than three of its waves"):
        peak_period(Curve(time, np.sin(2.0 * np.pi * time / 1.2)))


def test_what_goes_over_a_crest_wave_by_wave():
    beyond = 0.001 * np.clip(TIME - 1.0, 0.0, 0.5) + 0.004 * np.clip(TIME - 4.0, 0.0, 0.5)
    curve = Curve(TIME, 0.7 + beyond)
    assert overtopping.discharge(curve).value == pytest.approx(0.25)
    assert overtopping.number_of_waves(curve, 1.0).value == 2.0
    largest = overtopping.largest_wave(curve, 1.0)
    assert largest.value == pytest.approx(2.0) and largest.time == pytest.approx(4.0, abs=0.01)
    assert overtopping.number_of_waves(curve, 4.0).value == 1.0
    with pytest.raises(NoNumber, match="nothing goes over"):
        overtopping.largest_wave(Curve(TIME, np.ones(len(TIME))), 1.0)


@pytest.mark.parametrize("step", (0.02, 0.1, 0.2))
def test_a_wave_over_a_crest_is_one_wave_however_sparse_the_rows(step):
    """Where the time from row to row counted as one without overtopping, each row was a wave: 7, of 5 L/m."""
    time = np.arange(0.0, 5.0, step)
    beyond = 0.01 * np.clip((time - 1.0) / 0.4, 0.0, 1.0) + 0.02 * np.clip((time - 3.0) / 0.4, 0.0, 1.0)
    assert overtopping.number_of_waves(Curve(time, beyond), 0.1).value == 2.0
    assert overtopping.largest_wave(Curve(time, beyond), 0.1).value == pytest.approx(20.0)


def test_rows_without_a_value_are_left_out_and_one_row_has_little():
    gap = np.where((TIME > 2.0) & (TIME < 3.0), np.nan, TIME)
    assert moments.mean(Curve.of(TIME, gap)).value == pytest.approx(5.0)
    with pytest.raises(NoNumber, match="no row has a value"):
        Curve.of(TIME, np.full(len(TIME), np.nan))
    one = Curve.of([0.0], [2.0])
    for name, taking in TAKEN.items():
        needed = {"wave": one, "rest": 1.0}
        try:
            found = taking.of(one, **{key: needed[key] for key in taking.needs})
        except NoNumber:
            continue
        assert found.value in (2.0, 0.0), name
