"""Cases of the coast against laws of run-up and overtopping, formulas for walls, and the linear theory of waves."""

import math

import numpy as np
import pytest
from cases.measures import finished, window
from cases.radiation import G, forces, responses
from cases.slope_by_boundaries import shoreline
from long import LONG

from psph.theory.curves.crests import mean_crest
from psph.theory.curves.number import Curve
from psph.theory.curves.oscillation import harmonic
from psph.theory.curves.overtopping import discharge, number_of_waves
from psph.theory.water_waves import wave_number

BOX = {"beam": 0.5, "draught": 0.1, "depth": 0.4}
"""Of the pontoon, m."""


def test_what_waves_push_with_is_what_the_box_radiates():
    """By Haskind's relation B_jj = |X_j|²/(2 g c_g) for a box with two alike sides; forces are symmetric."""
    w = 2.0 * math.pi / 1.4
    force, pushed = forces(w, **BOX, panel=0.03)
    k = wave_number(w, BOX["depth"], G)
    kh = k * BOX["depth"]
    group = 0.5 * w / k * (1.0 + 2.0 * kh / math.sinh(2.0 * kh))
    assert -force.real.diagonal() == pytest.approx(np.abs(pushed) ** 2 / (2.0 * G * group), rel=0.01)
    assert abs(force[0, 2] - force[2, 0]) < 0.02 * abs(force[0, 2])


def told(period):
    """Sway, m/m, heave and roll, rad/m, of the pontoon by linear theory: its centre is in the waterline."""
    beam, draught = BOX["beam"], BOX["draught"]
    mass = beam * draught
    inertia = mass * (beam**2 + (2.0 * draught) ** 2) / 12.0
    springs = 2.0 * 50.0 / 1000.0
    stiffness = np.diag([springs, G * beam, G * (beam**3 / 12.0 - 0.5 * mass * draught)])
    return np.abs(responses(2.0 * math.pi / period, **BOX, mass=[mass, mass, inertia], stiffness=stiffness))


def incident(gauges, places, period, depth, begin):
    """Amplitude, m, of the waves that run along x, by the levels at some ``places``, m, from ``begin`` s on:
    c(x) = A exp(ikx) + B exp(−ikx)."""
    k = wave_number(2.0 * math.pi / period, depth, G)
    tones = [harmonic(later(gauges[name], f"{name}.level", begin), period)[0] for name in places]
    x = np.array(list(places.values()))
    waves = np.stack([np.exp(1j * k * x), np.exp(-1j * k * x)], axis=1)
    return np.abs(np.linalg.lstsq(waves, np.conj(tones), rcond=None)[0][0])


def later(table, column, begin):
    """A column from a time on."""
    return Curve(*(window(table, name, begin, math.inf) for name in ("time", column)))


def answers(run, period):
    """Sway, heave and roll of the pontoon over the amplitude of the waves that come."""
    gauges, begin = run.gauges(), run.times[-1] - 3.0 * period
    wave = incident(gauges, {"first": 1.0, "second": 1.2, "third": 1.45}, period, BOX["depth"], begin)
    columns = ("centre_x", "centre_y", "turn_z")
    swings = [harmonic(later(gauges["pontoon"], f"pontoon.{name}", begin), period)[0] for name in columns]
    return np.abs(swings) / wave


def goda(height, period, depth):
    """Largest force of waves on a wall that stands on the bed and is not overtopped, over its force at rest,
    N/m: Goda (2000), (4.2) to (4.14), with α₂ = 0, for waves that come straight."""
    kh = depth * wave_number(2.0 * math.pi / period, depth, G)
    surface = 1000.0 * G * height * (0.6 + 0.5 * (2.0 * kh / math.sinh(2.0 * kh)) ** 2)
    return 0.5 * surface * 1.5 * height + 0.5 * surface * (1.0 + 1.0 / math.cosh(kh)) * depth


def sainflou(height, period, depth):
    """The same by Sainflou (1928)."""
    k = wave_number(2.0 * math.pi / period, depth, G)
    bed, rise = 1000.0 * G * height / math.cosh(k * depth), 0.5 * k * height**2 / math.tanh(k * depth)
    still = 1000.0 * G * depth
    return 0.5 * (depth + height + rise) * (bed + still) - 0.5 * still * depth


@LONG
def test_waves_push_a_breakwater_as_goda_says(tmp_path):
    """From 7.2 s on in waves of half the swing at the wall, 0.056 m: 116 N/m at the crests, where Goda has 114,
    Sainflou 154; for each metre that the surface swings there 0.97 of linear theory."""
    gauges, period, depth = finished("coast/breakwater", tmp_path / "run").gauges(), 1.2, 0.3
    force, level = (gauges["breakwater"], "breakwater.force_x"), (gauges["wall"], "wall.wetted")
    rest = window(*force, 0.0, 0.6).mean()
    assert rest == pytest.approx(0.5 * 1000.0 * G * depth**2, rel=0.002)
    spans = [(begin, begin + period) for begin in (7.2, 8.4, 9.6, 10.8)]
    height = 0.5 * np.mean([np.ptp(window(*level, *span)) for span in spans])
    crests = np.mean([window(*force, *span).max() for span in spans]) - rest
    assert crests == pytest.approx(goda(height, period, depth), rel=0.1)
    assert crests < 0.85 * sainflou(height, period, depth)  # the control: another formula
    k = wave_number(2.0 * math.pi / period, depth, G)
    swings = [abs(harmonic(later(*one, 7.2), period)[0]) for one in (force, level)]
    at_wall = swings[1] / math.cos(k * 0.042)  # the level is measured so far before it
    assert swings[0] == pytest.approx(1000.0 * G * math.tanh(k * depth) / k * at_wall, rel=0.05)


@LONG
@pytest.mark.timeout(1800)
def test_a_pontoon_answers_waves_as_linear_theory_says(tmp_path):
    """Measured: sway − 0.4, heave − 2.2, roll − 3.5 %."""
    found = answers(finished("coast/pontoon", tmp_path / "run"), 1.4)
    assert found == pytest.approx(told(1.4), rel=0.1)
    assert not np.allclose(found, told(1.2), rtol=0.15)  # the control: waves of another period


def run_up(run):
    """How far the tongue comes above the still water, m."""
    return run.gauges()["tongue"]["tongue.height"].max() - 0.02


@LONG
@pytest.mark.timeout(1800)
def test_a_solitary_wave_runs_up_a_beach_as_synolakis_says(tmp_path):
    """Within 5 %, measured − 4.6 (jittered starts − 4.8, − 4.0), of a lower wave 3.7 in the mean of three starts, which
    scatter from 1.5 to 5.1; − 14 % with the default walls, the control."""
    synolakis = 2.831 * math.sqrt(2.0) * (0.06 / 0.3) ** 1.25 * 0.3
    assert run_up(finished("coast/run_up", tmp_path / "run")) == pytest.approx(synolakis, rel=0.05)
    lower = ("walls.paddle.motion.solitary.height=0.045", "space.spacing=0.0075")
    starts = [f"fluids.water.jitter={jitter}" for jitter in (0.0, 0.02, 0.05)]
    found = [run_up(finished("coast/run_up", tmp_path / one, *lower, one)) for one in starts]
    assert np.mean(found) == pytest.approx(synolakis * 0.75**1.25, rel=0.05)
    plain = ("walls.flume.condition=dynamic", "walls.beach.condition=dynamic")
    braked = finished("coast/run_up", tmp_path / "braked", *plain, "time.end=4.0")
    assert run_up(braked) < 0.9 * synolakis


def test_deep_water_swings_on_a_slope_as_isaacson_says():
    """2 √(π/2β) at the shore of the angle β (1950, Commun. Pure Appl. Math. 3, 11), and of shallower water more."""
    for cot in (1.0, 2.0):
        exact = 2.0 * math.sqrt(0.5 * math.pi / math.atan(1.0 / cot))
        assert shoreline(0.75, 0.45, cot, 0.015) == pytest.approx(exact, rel=0.02)
    assert shoreline(1.3, 0.3, 2.0, 0.02) > 1.05 * exact


@LONG
@pytest.mark.timeout(1800)
def test_waves_run_up_a_slope_as_eurotop_says(tmp_path):
    """Regular waves stand for those that 2 % of a sea exceed, 1.4 H_m0 high, whose run-up is R_u2%.  The control:
    Hunt's R = ξH (1959) is of waves that break.  Measured 2.20, by EurOtop 2.29."""
    period, gauges = 1.3, finished("coast/wave_run_up", tmp_path / "run").gauges()
    places = {"first": 1.2, "second": 1.5, "third": 1.9}
    height = 2.0 * incident(gauges, places, period, 0.3, 5.2)
    found = (mean_crest(later(gauges["tongue"], "tongue.height", 5.2), rest=0.6).value - 0.1) / height
    steep = 0.5 / math.sqrt(2.0 * math.pi * height / (G * period**2))
    assert found == pytest.approx((4.0 - 1.5 / math.sqrt(steep)) / 1.4, rel=0.15)
    assert found == pytest.approx(0.5 * shoreline(period, 0.3, 2.0, 0.02), rel=0.15)
    assert steep > 3.3 and found < 0.75 * steep


def eurotop(height, freeboard):
    """Mean discharge over a steep smooth slope, L/(m s), in waves of the height H_m0: EurOtop (2018), ch. 5."""
    return 90.0 * math.exp(-((1.5 * freeboard / height) ** 1.3)) * math.sqrt(G * height**3)


@LONG
def test_waves_overtop_a_slope_as_eurotop_says(tmp_path):
    """Measured 2.39 L/(m s), where the formula has 2.53; its coefficients scatter by 15 and 10 %."""
    beyond = later(finished("coast/overtopping", tmp_path / "run").gauges()["crest"], "crest.beyond", 6.0)
    found = discharge(beyond).value
    assert found == pytest.approx(eurotop(math.sqrt(2.0) * 0.08, 0.1), rel=0.3)
    assert found > 2.0 * eurotop(0.08, 0.1)  # the control: waves of half the energy
    assert number_of_waves(beyond, 0.3).value == 5


def rolled(run, begin=0.7):
    """How far the second block rolls along x, up and down, once both have settled, m."""
    place = later(run.gauges()["stone_2"], "stone_2.centre_x", begin).value
    return np.abs(np.diff(place)).sum()


@LONG
@pytest.mark.timeout(1800)
def test_waves_rock_light_blocks_and_leave_heavy_ones(tmp_path):
    """By Hudson those of H/(ΔD) 13 are loose: measured 55 to 73 mm on 30 November 2026, in steps of one pass 115, at
    dx 0.01 177.  The control, stones of 0.8: 4 mm."""
    assert rolled(finished("coast/armour", tmp_path / "light")) > 0.04
    heavy = [f"bodies.stone_{k}.density=2650.0" for k in (1, 2)]
    assert rolled(finished("coast/armour", tmp_path / "heavy", *heavy)) < 0.01
