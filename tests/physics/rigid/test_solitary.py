"""Solitary waves and the strokes that make them, against the exact wave of Euler's equations."""

import math

import numpy as np
import pytest

from psph.case.paddles import SolitaryWave
from psph.physics.rigid.schedule import ActingTime
from psph.theory import water_waves

G, DEPTH = 9.81, 0.3


def exact_wave(froude, count=2048):
    """x and η of the wave of c = ``froude`` √(gh), in depths: Babenko's equation by Petviashvili's iteration.

    Clamond & Dutykh (2013), Comput. Fluids 84, 35: F² C η − η = ½ C η² + η C η in the conformal plane, where
    C has the symbol k coth k.  The tails fall by e^(−κx) with F² = tan κ/κ.
    """
    low, high = 1e-6, 1.55
    for _ in range(80):
        rate = 0.5 * (low + high)
        low, high = (rate, high) if math.tan(rate) / rate < froude**2 else (low, rate)
    half = 17.0 * math.log(10.0) / rate
    at = (np.arange(count) - count // 2) * 2.0 * half / count
    k = math.pi / half * np.fft.fftfreq(count, 1.0 / count)
    symbol = np.ones(count)
    symbol[1:] = k[1:] / np.tanh(k[1:])
    eta = (froude**2 - 1.0) / np.cosh(0.5 * rate * at) ** 2
    for _ in range(300):
        left = (froude**2 * symbol - 1.0) * np.fft.fft(eta)
        slope = np.fft.ifft(symbol * np.fft.fft(eta)).real
        right = 0.5 * symbol * np.fft.fft(eta * eta) + np.fft.fft(eta * slope)
        size = (np.vdot(np.fft.fft(eta), left) / np.vdot(np.fft.fft(eta), right)).real ** 2
        before, eta = eta, size * np.fft.ifft(right / (froude**2 * symbol - 1.0)).real
        if abs(eta - before).max() < 1e-12:
            break
    stretch = 1.0 + np.fft.ifft(symbol * np.fft.fft(eta)).real  # dx by that of the plane, at even distances
    x = np.append(0.0, np.cumsum(0.5 * (stretch[1:] + stretch[:-1]))) * 2.0 * half / count
    return x - x[count // 2], eta


# F of the exact wave; by how much the volumes of Grimshaw's and Rayleigh's waves differ from its own.
HEIGHTS = {0.125: (1.060248, -0.0005, 0.018), 0.2: (1.094345, -0.002, 0.031), 0.4: (1.178075, -0.0138, 0.080)}


@pytest.mark.parametrize("height", HEIGHTS)
def test_grimshaws_wave_is_nearly_the_exact_one(height):
    froude, grimshaw, rayleigh = HEIGHTS[height]
    x, eta = exact_wave(froude)
    assert eta.max() == pytest.approx(height, rel=2e-5)
    volume = float(np.sum(0.5 * (eta[1:] + eta[:-1]) * np.diff(x)))
    for theory, off in (("grimshaw", grimshaw), ("rayleigh", rayleigh)):
        law = SolitaryWave(height=height * DEPTH, depth=DEPTH, theory=theory).law(G)
        # What the piston sweeps below the surface at rest is the volume of its wave.
        assert law.stroke / math.tanh(3.8) / DEPTH / volume - 1.0 == pytest.approx(off, abs=6e-4)
    wave = water_waves.grimshaw(height * DEPTH, DEPTH, G)
    assert wave.speed == pytest.approx(froude * math.sqrt(G * DEPTH), rel=6e-4)
    s = np.cosh(np.minimum(wave.outskirts * DEPTH * abs(x), 300.0)) ** -2.0
    form = sum(a * s**n for n, a in enumerate(wave.terms, 1))
    assert abs(form - eta).max() < 0.011 * height


@pytest.mark.parametrize("theory", ["grimshaw", "rayleigh", "boussinesq"])
def test_the_surface_of_a_solitary_wave_moves_the_paddle(theory):
    """dx/dt = c η/(h + η) at the paddle, from the elevation of its own."""
    law, schedule = SolitaryWave(height=0.12, depth=DEPTH, theory=theory).law(G), ActingTime(0.5)
    for n in range(1, 10):
        time = 0.5 + law.duration * n / 10.0
        (x, *_), (speed, *_), _ = law.ways(schedule, time)
        eta = law.elevation(schedule, time, x)
        assert speed == pytest.approx(law.wave.speed * eta / (DEPTH + eta))
    middle = law.ways(schedule, 0.5 + 0.5 * law.duration)[0][0]
    assert law.elevation(schedule, 0.5 + 0.5 * law.duration, middle) == pytest.approx(0.12)
    assert law.elevation(schedule, 1e3, 0.0) == pytest.approx(0.0, abs=1e-100)
