"""How paddles that make waves move: laws of displacement and angle (psph.physics.rigid.laws)."""

import math
from typing import NamedTuple

from psph.physics.rigid.laws import STILL, Ways, faded
from psph.physics.rigid.schedule import ActingTime
from psph.theory.water_waves import Component, Running, Solitary
from psph.vectors import Vector, scale

TAIL = 3.8
"""θ at both ends of a solitary wave's stroke: tanh 3.80 = 0.999 (Goring 1978)."""

FAR = 300.0
"""θ beyond which a solitary wave has no height that a number tells."""


class Swings(NamedTuple):
    """Sinusoids in one ``direction``: s = r Σ A sin(ωτ + φ); the way of what has so many frequencies.

    ``direction``: a unit displacement (x, y, z, 0) or a unit angle (0, 0, 0, 1).
    """

    direction: Vector
    swings: tuple[Component, ...]

    def ways(self, schedule: ActingTime, time: float) -> Ways:
        """The law, switched on and off as a sinusoid is (psph.physics.rigid.laws.Harmonic)."""
        moved, speed, change = faded(schedule, time, self._sum)
        return tuple(scale(self.direction, way[0]) for way in (moved, speed, change))

    def _sum(self, t: float) -> Ways:
        x = v = a = 0.0
        for size, w, phase in self.swings:
            s, c = size * math.sin(w * t + phase), size * math.cos(w * t + phase)
            x, v, a = x + s, v + w * c, a - w * w * s
        return (x,), (v,), (a,)


class Crests(NamedTuple):
    """The surface before a paddle that makes some ``waves``: η = r Σ A cos(ωτ − kx + φ), by its share r.

    Without the waves that stay beside the paddle (evanescent modes), a twentieth of them at kh = 1.
    """

    waves: tuple[Running, ...]

    def elevation(self, schedule: ActingTime, time: float, distance: float) -> float:
        """η, m, at a ``distance`` x, m, from where the paddle stood at the start."""
        since, share = time - schedule.start, schedule.share(time)[0]
        return share * math.fsum(a * math.cos(w * since - k * distance + p) for a, w, k, p in self.waves)


class SolitaryStroke(NamedTuple):
    """The stroke of a piston before which a solitary wave rises, from where the piston stands, forwards.

    The piston goes with the water beside it, dx/dt = cη/(h + η), whose solution is Kx = ∫ η/h dθ, θ = K(ct −
    x), for every profile η(θ): Goring (1978), Caltech report KH-R-38, for Boussinesq's; others are taken in
    the same way.  It begins at θ = −3.8 and ends at 3.8, within a thousandth of its way from rest.
    """

    direction: Vector
    wave: Solitary

    @property
    def duration(self) -> float:
        """2 (θ + K x(θ))/(Kc), s, at θ = 3.8."""
        return 2.0 * self._moment(TAIL)

    @property
    def stroke(self) -> float:
        """From the beginning to the end, m."""
        return 2.0 * self._curve(TAIL)[0]

    def ways(self, schedule: ActingTime, time: float) -> Ways:
        """The law; at rest before the start, and when the stroke is done."""
        since = time - schedule.start
        first = -self._curve(TAIL)[0]
        if since < 0.0:
            return STILL, STILL, STILL
        if since >= self.duration:
            return scale(self.direction, -2.0 * first), STILL, STILL
        x, dx, ddx = self._curve(self._phase(since - 0.5 * self.duration))
        c, slow = self.wave.speed, 1.0 / self.wave.outskirts
        speed = c * dx / (slow + dx)
        change = c * c * ddx * slow / (slow + dx) ** 3
        return tuple(scale(self.direction, way) for way in (x - first, speed, change))

    def elevation(self, schedule: ActingTime, time: float, distance: float) -> float:
        """η of its wave, m, at a ``distance``, m, from where the piston stood at the start."""
        since = time - schedule.start - 0.5 * self.duration
        theta = self.wave.outskirts * (self.wave.speed * since - (distance - self._curve(TAIL)[0]))
        s = math.cosh(min(abs(theta), FAR)) ** -2
        return self.wave.depth * math.fsum(a * s**n for n, a in enumerate(self.wave.terms, 1))

    def _curve(self, theta: float) -> tuple[float, float, float]:
        """x, m, with its first and second derivative by θ: Kx = ∫ η/h dθ.

        The integrals I_n of sech²ⁿ follow from each other: (2n + 1) I_{n+1} = tanh θ sech²ⁿ θ + 2n I_n.
        """
        t = math.tanh(theta)
        s = 1.0 - t * t
        x = dx = ddx = 0.0
        integral, power = t, s
        for n, a in enumerate(self.wave.terms, 1):
            x, dx, ddx = x + a * integral, dx + a * power, ddx - 2.0 * n * a * power * t
            integral, power = (t * power + 2.0 * n * integral) / (2.0 * n + 1.0), power * s
        return scale((x, dx, ddx), 1.0 / self.wave.outskirts)

    def _moment(self, theta: float) -> float:
        """t = (θ/K + x(θ))/c, s: it rises with θ."""
        return (theta / self.wave.outskirts + self._curve(theta)[0]) / self.wave.speed

    def _phase(self, t: float) -> float:
        """θ at ``t``: Newton's method, kept between bounds that close in."""
        low, high, theta = -TAIL, TAIL, 0.0
        for _ in range(100):
            x, dx, _ = self._curve(theta)
            off = theta / self.wave.outskirts + x - self.wave.speed * t
            low, high = (low, theta) if off > 0.0 else (theta, high)
            step = off / (1.0 / self.wave.outskirts + dx)
            if abs(step) < 1e-15 or high - low < 1e-15:
                break
            theta = theta - step if low < theta - step < high else 0.5 * (low + high)
        return theta
