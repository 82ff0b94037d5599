"""Waves on water of a constant depth, and the strokes of the paddles that make them.

Lengths in m, times in s, ``gravity`` the strength g > 0 in m/s², ``depth`` h of the water at rest.
"""

import math
import random
from typing import NamedTuple

DEEP = 200.0
"""kh above which hyperbolic functions, and their cubes, would overflow; such waves know of no bed."""

LOWEST, HIGHEST = 0.5, 3.0
"""Frequencies of the waves of a spectrum, over that of its peak."""

MADSEN = 8.0 * math.pi**2 / 3.0
"""H L²/h³ from which waves of second order have a second crest (Madsen 1971)."""


def frequency(k: float, depth: float, gravity: float) -> float:
    """ω = √(gk tanh kh) of small waves, rad/s; ``k`` in rad/m.  Lamb (1932), Hydrodynamics, §228."""
    return math.sqrt(gravity * k * math.tanh(k * depth))


def wave_number(omega: float, depth: float, gravity: float) -> float:
    """k, rad/m, of small waves with ω² = gk tanh kh.

    Newton's method for x tanh x = y, x = kh, y = ω²h/g, from above: x < 1.2 max(y, √y).
    """
    y = omega * omega * depth / gravity
    x = 1.2 * max(y, math.sqrt(y))
    for _ in range(60):
        t = math.tanh(x)
        step = (x * t - y) / (t + x * (1.0 - t * t))
        x -= step
        if abs(step) <= 1e-15 * x:
            break
    return x / depth


def piston_gain(kh: float) -> float:
    """H/S of a piston: height of its wave over its stroke, 2 (cosh 2kh − 1)/(sinh 2kh + 2kh).

    Dean & Dalrymple (1991), Water Wave Mechanics for Engineers and Scientists, sec. 6.3, after Biésel (1951).
    """
    kh = min(kh, DEEP)
    return 4.0 * math.sinh(kh) ** 2 / (math.sinh(2.0 * kh) + 2.0 * kh)


def flap_gain(kh: float, hinge: float = 0.0) -> float:
    """H/S of a flap, S its stroke at the surface at rest; ``hinge``: its height above the bed, over h.

    4 sinh kh [sinh kh + (cosh kd − cosh kh)/(k(h − d))]/(sinh 2kh + 2kh), d the height of the hinge; for one
    below the bed 1 takes the place of cosh kd.  Dean & Dalrymple (1991), sec. 6.3, integrated from d on.
    """
    x = min(kh, DEEP)
    s, d = math.sinh(x), x * max(hinge, 0.0)
    fall = 2.0 * math.sinh(0.5 * (d + x)) * math.sinh(0.5 * (d - x))  # cosh kd − cosh kh, exact in long waves
    lever = fall / (kh * (1.0 - hinge))
    return 4.0 * s * (s + lever) / (math.sinh(2.0 * x) + 2.0 * x)


def second_harmonic(height: float, kh: float, depth: float) -> float:
    """Amplitude, m, of sin 2ωt beside (S/2) sin ωt for a piston whose wave keeps its form.

    H²/(32h) [3 cosh kh/sinh³kh − 2/m], m = H/S.  Madsen (1971), J. Geophys. Res. 76, 8672.
    """
    kh = min(kh, DEEP)
    bound = 3.0 * math.cosh(kh) / math.sinh(kh) ** 3 - 2.0 / piston_gain(kh)
    return height * height / (32.0 * depth) * bound


def bound_crest(height: float, kh: float, depth: float) -> float:
    """Amplitude, m, of cos 2(ωt − kx) in the surface beside (H/2) cos(ωt − kx), of Stokes to second order.

    kH²/16 (3 coth³kh − coth kh).  Dean & Dalrymple (1991), sec. 11.2.
    """
    c = 1.0 / math.tanh(min(kh, DEEP))
    return kh / depth * height * height / 16.0 * (3.0 * c**3 - c)


class Component(NamedTuple):
    """A sinusoid among several, A sin(ωt + φ): ``amplitude`` m or rad, ``omega`` rad/s, ``phase`` rad."""

    amplitude: float
    omega: float
    phase: float


def jonswap(height: float, period: float, gamma: float, number: int, seed: int) -> tuple[Component, ...]:
    """Waves with the spectrum of JONSWAP: significant ``height`` H_s = 4√m₀, peak ``period`` T_p.

    E(f) ∝ f⁻⁵ exp(−1.25 (f_p/f)⁴) γ^b, b = exp(−(f − f_p)²/(2σ²f_p²)), σ = 0.07 up to f_p, 0.09 above;
    Hasselmann and others (1973), Dtsch. Hydrogr. Z. Suppl. A8.  γ = 1 is Pierson & Moskowitz's.  ``number``
    bands of equal width from 0.5 to 3 f_p hold a wave each, at a random frequency, so that the waves do not
    repeat, and with a random phase.  All heights are scaled so that Σa²/2 = H_s²/16.
    """
    draw = random.Random(seed)
    width = (HIGHEST - LOWEST) / number
    ratios = [LOWEST + width * (n + draw.random()) for n in range(number)]
    phases = [2.0 * math.pi * draw.random() for _ in ratios]
    weights = [math.sqrt(_jonswap(x, gamma)) for x in ratios]
    size = height / math.sqrt(8.0 * math.fsum(w * w for w in weights))
    turn = 2.0 * math.pi / period
    return tuple(Component(size * w, turn * x, phase) for w, x, phase in zip(weights, ratios, phases))


def _jonswap(x: float, gamma: float) -> float:
    """E at ``x`` = f/f_p, but for a factor."""
    sigma = 0.07 if x <= 1.0 else 0.09
    return x**-5 * math.exp(-1.25 * x**-4) * gamma ** math.exp(-((x - 1.0) ** 2) / (2.0 * sigma * sigma))


class Running(NamedTuple):
    """A wave A cos(ωt − kx + φ): ``amplitude`` m, ``omega`` rad/s, wave ``number`` k rad/m, ``phase`` rad."""

    amplitude: float
    omega: float
    number: float
    phase: float


class Solitary(NamedTuple):
    """A solitary wave of ``height`` H on water of ``depth`` h: η = h Σ a_n sech²ⁿ K(x − ct), n = 1, 2 ...

    ``outskirts`` K, 1/m; ``speed`` c, m/s; ``terms`` a_n, which add up to H/h.
    """

    height: float
    depth: float
    outskirts: float
    speed: float
    terms: tuple[float, ...]


def boussinesq(height: float, depth: float, gravity: float) -> Solitary:
    """The wave of Boussinesq: η = H sech², K = √(3H/4h³), c = √(g(h + H))."""
    e = height / depth
    return Solitary(height, depth, math.sqrt(0.75 * e) / depth, math.sqrt(gravity * (depth + height)), (e,))


def rayleigh(height: float, depth: float, gravity: float) -> Solitary:
    """The wave of Rayleigh: η = H sech², K = √(3H/(4h²(h + H))), c = √(g(h + H)); it is too long."""
    wave = boussinesq(height, depth, gravity)
    return wave._replace(outskirts=wave.outskirts / math.sqrt(1.0 + height / depth))


def grimshaw(height: float, depth: float, gravity: float) -> Solitary:
    """The wave of Grimshaw to third order in ε = H/h, s = sech² Kx.

    η/h = εs − ¾ε² s(1 − s) + ε³(5/8 s(1 − s) − 101/80 s²(1 − s)), Kh = √(¾ε)(1 − 5/8 ε + 71/128 ε²),
    c² = gh(1 + ε − ε²/20 − 3ε³/70).  Grimshaw (1971), J. Fluid Mech. 46, 611.
    """
    e = height / depth
    rate = math.sqrt(0.75 * e) * (1.0 - 0.625 * e + 71.0 / 128.0 * e * e)
    speed = math.sqrt(gravity * depth * (1.0 + e - e * e / 20.0 - 3.0 / 70.0 * e**3))
    terms = (
        e - 0.75 * e * e + 0.625 * e**3,
        0.75 * e * e - 151.0 / 80.0 * e**3,
        101.0 / 80.0 * e**3,
    )
    return Solitary(height, depth, rate / depth, speed, terms)


def steepest(kh: float) -> float:
    """H/L at which a wave breaks, 0.142 tanh kh.  Miche (1944), Ann. Ponts Chaussées 114."""
    return 0.142 * math.tanh(kh)


HIGHEST_IN_DEPTH = 0.78
"""H/h at which a wave breaks in shallow water (McCowan 1894, Philos. Mag. 38, 351)."""
