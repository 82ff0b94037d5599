"""Paddles: their strokes by the theory of waves, and the derivatives of their laws."""

import math

import pytest

from psph.case.paddles import Flap, Irregular, Piston, SolitaryWave
from psph.physics.rigid.absorption import Absorption, Correction
from psph.physics.rigid.schedule import ActingTime
from psph.theory.water_waves import (
    bound_crest,
    flap_gain,
    frequency,
    jonswap,
    piston_gain,
    second_harmonic,
    steepest,
    wave_number,
)

G = 9.81
DEPTHS = (0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0)
PISTON = (0.250, 0.499, 0.982, 1.393, 1.682, 1.933, 1.998)
FLAP = (0.126, 0.255, 0.528, 0.803, 1.041, 1.350, 1.604)


def test_waves_are_as_long_as_their_period_and_depth_say():
    for exponent in range(-60, 61):
        omega = 10.0 ** (exponent / 10.0)
        assert frequency(wave_number(omega, 0.7, G), 0.7, G) == pytest.approx(omega, rel=1e-12)
    k = wave_number(2.0 * math.pi / 1.2, 0.3, G)
    assert 2.0 * math.pi / k == pytest.approx(1.770, abs=5e-4)
    assert wave_number(20.0, 50.0, G) == pytest.approx(400.0 / G)  # deep water
    assert wave_number(0.01, 0.5, G) == pytest.approx(0.01 / math.sqrt(0.5 * G), rel=1e-5)  # shallow


def test_heights_over_strokes():
    assert [piston_gain(kh) for kh in DEPTHS] == pytest.approx(PISTON, abs=6e-4)
    assert [flap_gain(kh) for kh in DEPTHS] == pytest.approx(FLAP, abs=6e-4)
    for kh in DEPTHS:
        assert flap_gain(kh, -1e7) == pytest.approx(piston_gain(kh), rel=1e-6)  # a hinge far below
        assert flap_gain(kh, 0.5) < flap_gain(kh) < flap_gain(kh, -0.5)
    assert flap_gain(1e-9) == pytest.approx(0.5e-9) and piston_gain(1e-9) == pytest.approx(1e-9)
    assert piston_gain(1e4) == pytest.approx(2.0) and flap_gain(1e4) == pytest.approx(2.0, rel=2e-4)


def test_a_flap_pushes_what_its_profile_pushes():
    """H/S = 4 sinh kh/(sinh 2kh + 2kh) · k ∫ profile cosh k(z + h) dz, by a sum of its own."""
    kh, n = 1.3, 20000
    for hinge in (-0.4, 0.0, 0.3):
        heights = [(m + 0.5) / n for m in range(n)]
        pushed = sum(max(z - hinge, 0.0) / (1.0 - hinge) * math.cosh(kh * z) for z in heights) * kh / n
        told = 4.0 * math.sinh(kh) / (math.sinh(2.0 * kh) + 2.0 * kh) * pushed
        assert flap_gain(kh, hinge) == pytest.approx(told, rel=1e-6)


def test_second_order_adds_what_madsen_adds():
    kh, height, depth = 1.0646, 0.08, 0.3
    m = 2.0 * math.sinh(kh) ** 2 / (math.sinh(kh) * math.cosh(kh) + kh)
    told = height**2 / (32.0 * depth) * (3.0 * math.cosh(kh) / math.sinh(kh) ** 3 - 2.0 / m)
    assert second_harmonic(height, kh, depth) == pytest.approx(told)
    assert steepest(100.0) == pytest.approx(0.142)
    both = Piston(height=0.08, period=1.2, depth=0.3, order=2, phase=0.4).law(G)
    alone = Piston(height=0.08, period=1.2, depth=0.3, phase=0.4).law(G)
    assert both.swings[0] == alone.swings[0] and len(alone.swings) == 1
    assert both.swings[1] == pytest.approx((told, 4.0 * math.pi / 1.2, 0.8), rel=2e-3)


def test_the_waves_of_a_spectrum_have_its_height_and_its_peak():
    waves = jonswap(0.1, 1.5, 3.3, 400, 7)
    assert 4.0 * math.sqrt(sum(w.amplitude**2 / 2.0 for w in waves)) == pytest.approx(0.1)
    largest = max(waves, key=lambda w: w.amplitude)
    assert 2.0 * math.pi / largest.omega == pytest.approx(1.5, rel=0.02)
    assert waves == jonswap(0.1, 1.5, 3.3, 400, 7) != jonswap(0.1, 1.5, 3.3, 400, 8)
    assert len({w.phase for w in waves}) == 400
    # γ raises the peak over that of Pierson and Moskowitz by γ, before both are scaled.
    wide = jonswap(0.1, 1.5, 1.0, 400, 7)
    ratio = [(a.amplitude / b.amplitude) ** 2 for a, b in zip(waves, wide)]
    assert max(ratio) / min(ratio) == pytest.approx(3.3, rel=0.02)


LAWS = {
    "first order": (Piston(height=0.08, period=1.2, depth=0.3, phase=0.3), ActingTime(0.2, 5.0, 1.1)),
    "second order": (Piston(height=0.08, period=1.2, depth=0.3, order=2), ActingTime(0.1, math.inf, 2.4)),
    "to the left": (
        Piston(height=0.08, period=1.2, depth=0.3, direction=[-1.0, 0.0]),
        ActingTime(0.0, 9.0, 0.5),
    ),
    "flap": (
        Flap(height=0.08, period=1.2, depth=0.3, center=[0.0, 0.1], hinge=0.1),
        ActingTime(0.1, 8.0, 1.0),
    ),
    "irregular": (Irregular(height=0.06, period=1.4, depth=0.3, components=20), ActingTime(0.1, 8.0, 1.0)),
    "irregular flap": (
        Irregular(height=0.06, period=1.4, depth=0.3, components=9, center=[0.0, 0.0]),
        ActingTime(0.1, 8.0, 1.0),
    ),
    "grimshaw": (SolitaryWave(height=0.12, depth=0.3, theory="grimshaw"), ActingTime(0.25)),
    "rayleigh": (SolitaryWave(height=0.06, depth=0.3), ActingTime(0.25)),
    "boussinesq": (SolitaryWave(height=0.1, depth=0.3, theory="boussinesq"), ActingTime(0.0)),
}


@pytest.mark.parametrize("name", LAWS)
def test_speed_and_acceleration_are_derivatives(name):
    asked, schedule = LAWS[name]
    law, step = asked.law(G), 1e-5
    for n in range(1, 70):
        t = n * 0.1 * 0.7548776662466927 + schedule.start  # not at an end of the motion
        (before, *_), (_, speed, change), (after, *_) = (
            law.ways(schedule, t + s) for s in (-step, 0.0, step)
        )
        (_, slower, _), (_, faster, _) = (law.ways(schedule, t + s) for s in (-step, step))
        for d in range(4):
            assert speed[d] == pytest.approx((after[d] - before[d]) / (2.0 * step), abs=2e-7)
            assert change[d] == pytest.approx((faster[d] - slower[d]) / (2.0 * step), abs=2e-6)
    assert law.ways(schedule, schedule.start)[0] == pytest.approx((0.0,) * 4, abs=1e-12)


def test_a_stroke_starts_gently_with_a_ramp():
    law = LAWS["second order"][0].law(G)
    assert law.ways(ActingTime(0.1, math.inf, 2.4), 0.1) == ((0.0,) * 4,) * 3
    assert law.ways(ActingTime(0.1, math.inf, 0.0), 0.1)[1][0] > 0.1


def test_strokes_go_where_the_waves_go():
    right, left = (Piston(height=0.08, period=1.2, depth=0.3, direction=d) for d in (None, [-2.0, 0.0]))
    s = ActingTime()
    assert right.law(G).ways(s, 0.1)[0][0] == -left.law(G).ways(s, 0.1)[0][0] > 0.0
    oblique = Piston(height=0.08, period=1.2, depth=0.3, direction=[3.0, 4.0, 0.0]).law(G)
    x, y, z, turn = oblique.ways(s, 0.1)[0]
    assert (x / y, z, turn) == (pytest.approx(0.75), 0.0, 0.0)


@pytest.mark.parametrize("direction", [[1.0, 0.0], [-1.0, 0.0], [0.6, 0.8, 0.0]])
def test_the_top_of_a_flap_goes_where_the_waves_go(direction):
    up = [0.0] * (len(direction) - 1) + [0.3]
    flap = Flap(height=0.06, period=1.2, depth=0.3, center=[0.0] * len(direction), direction=direction)
    angle = flap.law(G).ways(ActingTime(), 0.1)[0][3]
    a = flap.unit_axis
    up = (*up, 0.0)[:3] if len(direction) == 2 else up
    moved = [angle * (a[i - 2] * up[i - 1] - a[i - 1] * up[i - 2]) for i in range(3)]
    kh = wave_number(2.0 * math.pi / 1.2, 0.3, G) * 0.3
    there = 0.03 / flap_gain(kh) * math.sin(2.0 * math.pi / 12.0)
    assert moved == pytest.approx([there * d for d in (*direction, 0.0)[:3]], abs=1e-12)


def test_a_solitary_wave_has_the_stroke_of_goring():
    law = SolitaryWave(height=0.06, depth=0.3, theory="boussinesq").law(G)
    assert law.wave.speed == pytest.approx(1.879, abs=5e-4)
    assert law.stroke == pytest.approx(math.sqrt(16.0 * 0.06 * 0.3 / 3.0) * math.tanh(3.8))
    assert law.duration == pytest.approx(3.30, abs=5e-3)


@pytest.mark.parametrize("theory", ["rayleigh", "boussinesq"])
def test_a_solitary_stroke_holds_its_equation(theory):
    law, start = SolitaryWave(height=0.06, depth=0.3, theory=theory).law(G), 0.5
    K, c, h, H = law.wave.outskirts, law.wave.speed, 0.3, 0.06  # noqa: N806
    for n in range(1, 30):
        t = law.duration * n / 30.0
        (moved, *_), (speed, *_), _ = law.ways(ActingTime(start), start + t)
        x = moved - 0.5 * law.stroke
        theta = K * (c * (t - 0.5 * law.duration) - x)
        eta = H / math.cosh(theta) ** 2
        assert x == pytest.approx(H / (K * h) * math.tanh(theta), abs=1e-12)
        assert speed == pytest.approx(c * eta / (h + eta))
    assert law.ways(ActingTime(start), start + 9.0)[0][0] == pytest.approx(law.stroke)
    assert law.ways(ActingTime(start), start - 0.1) == ((0.0,) * 4,) * 3


def test_the_surface_of_regular_waves_runs_away_from_the_paddle():
    asked = Piston(height=0.08, period=1.2, depth=0.3, order=2, phase=0.4)
    crests, schedule = asked.crests(G), ActingTime(0.2, math.inf, 1.0)
    omega, k = 2.0 * math.pi / 1.2, wave_number(2.0 * math.pi / 1.2, 0.3, G)
    kh = 0.3 * k
    second = 0.08**2 * k / 16.0 * math.cosh(kh) * (2.0 + math.cosh(2.0 * kh)) / math.sinh(kh) ** 3
    assert bound_crest(0.08, kh, 0.3) == pytest.approx(second)
    for time, x in ((1.9, 0.1), (2.7, 1.3)):
        theta = omega * (time - 0.2) + 0.4 - k * x
        told = 0.04 * math.cos(theta) + second * math.cos(2.0 * theta)
        assert crests.elevation(schedule, time, x) == pytest.approx(told)
        assert crests.elevation(schedule, time + 0.3, x + 0.3 * omega / k) == pytest.approx(told)
    ways = asked.law(G).ways(schedule, 2.7)  # the water before it rises while it goes forwards
    assert crests.elevation(schedule, 2.7, ways[0][0]) * ways[1][0] > 0.0
    early = Piston(height=0.08, period=1.2, depth=0.3).crests(G)
    assert early.elevation(schedule, 0.1, 0.0) == 0.0
    assert early.elevation(schedule, 0.7, 0.0) == pytest.approx(0.5 * 0.04 * math.cos(0.5 * omega))


def test_the_surface_of_a_spectrum_has_its_height():
    crests = Irregular(height=0.06, period=1.4, depth=0.3, components=50).crests(G)
    heights = [crests.elevation(ActingTime(), 0.37 * n, 0.2) for n in range(4000)]
    assert 4.0 * math.sqrt(sum(h * h for h in heights) / len(heights)) == pytest.approx(0.06, rel=0.05)


def reflected(alpha, memory, gain=5.0, omega=4.0):
    """The part of long waves that a paddle sends back which answers α times as strongly as it should: a wave
    a that comes is sent back as r, the level is a + r, and r = a + v α/γ for a paddle of speed v, a moment
    later."""
    asked, own, dt, sent = Absorption(None, gain, memory, 10.0), Correction(), 1e-3, []
    raised = 0.0
    for n in range(60000):
        wave = math.cos(omega * n * dt)
        own.advance(asked, dt)
        raised += dt / 4e-3 * (own.speed * alpha / gain - raised)
        back = wave + raised
        own.answer(asked, wave + back, dt)
        sent.append(back)
    return max(sent[-5000:])


def test_a_paddle_takes_up_long_waves():
    assert reflected(1.0, 1e4) == pytest.approx(0.0, abs=0.02)
    assert reflected(1.3, 1e4) == pytest.approx(0.3 / 2.3, abs=0.02)
    forgotten = (4.0j * 2.0 / (1.0 + 4.0j * 2.0)) ** 2  # of v, by a memory of 2 s
    assert reflected(1.0, 2.0) == pytest.approx(abs((1.0 - forgotten) / (1.0 + forgotten)), abs=0.02)


def test_a_paddle_comes_back_from_a_level_that_stays_and_stays_in_reach():
    asked, own = Absorption(None, 5.0, 2.0, 0.1), Correction()
    farthest = 0.0
    for _ in range(20000):
        place = own.shift
        own.advance(asked, 2e-3)
        assert own.shift == pytest.approx(place + 2e-3 * own.speed)
        own.answer(asked, 0.05, 2e-3)
        farthest = max(farthest, abs(own.shift))
    assert farthest == 0.1 and abs(own.shift) < 1e-3
    own.answer(asked, 0.06, 2e-3)
    assert own.due < 0.0  # away from water that is too high
