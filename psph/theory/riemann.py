"""The Riemann problem of an ideal gas: two states that meet at x = 0, exactly.

Toro (2009), Riemann Solvers and Numerical Methods for Fluid Dynamics, ch. 4.  Densities in kg/m^d, pressures
in Pa, velocities in m/s.
"""

import math
from typing import NamedTuple

import numpy as np

CLOSE = 1e-14
"""Relative change of the pressure between the waves by which it is found."""

MOST_TURNS = 200
"""Turns of Newton's method."""


class GasState(NamedTuple):
    """A state of gas: ``density``, ``pressure`` and ``velocity`` along x."""

    density: float
    pressure: float
    velocity: float = 0.0

    def sound_speed(self, gamma: float) -> float:
        """c = √(γp/ρ), m/s."""
        return math.sqrt(gamma * self.pressure / self.density)


class Riemann(NamedTuple):
    """The solution between ``left`` and ``right`` with the adiabatic index ``gamma``.

    ``pressure`` and ``velocity`` are those between the two outer waves, on both sides of the contact.
    """

    left: GasState
    right: GasState
    gamma: float
    pressure: float
    velocity: float

    def middle_density(self, side: GasState) -> float:
        """ρ between the contact and the wave into a ``side``, kg/m^d."""
        ratio, m = self.pressure / side.pressure, (self.gamma - 1.0) / (self.gamma + 1.0)
        if self.pressure > side.pressure:
            return side.density * (ratio + m) / (m * ratio + 1.0)
        return side.density * ratio ** (1.0 / self.gamma)

    def edges(self, side: GasState, way: float) -> tuple[float, float]:
        """Speeds of the far and the near edge of the wave into a ``side``, m/s: of a shock the same.

        ``way`` is −1 to the left and 1 to the right.
        """
        c, ratio, gamma = side.sound_speed(self.gamma), self.pressure / side.pressure, self.gamma
        if ratio > 1.0:
            speed = side.velocity + way * c * math.sqrt(
                (gamma + 1.0) / (2.0 * gamma) * ratio + (gamma - 1.0) / (2.0 * gamma)
            )
            return speed, speed
        inner = c * ratio ** ((gamma - 1.0) / (2.0 * gamma))
        return side.velocity + way * c, self.velocity + way * inner

    def at(self, xi: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """ρ, p and u (n,) at x/t = ``xi`` (n,), m/s."""
        found = np.empty((3, len(xi)))
        for side, way in ((self.left, -1.0), (self.right, 1.0)):
            here = way * (xi - self.velocity) >= 0.0
            far, near = self.edges(side, way)
            outside, between = here & (way * (xi - far) >= 0.0), here & (way * (xi - near) <= 0.0)
            found[:, between] = np.array([[self.middle_density(side)], [self.pressure], [self.velocity]])
            found[:, outside] = np.array(side)[:, None]
            fan = here & ~outside & ~between
            found[:, fan] = self._fan(side, way, xi[fan])
        return tuple(found)

    def _fan(self, side: GasState, way: float, xi: np.ndarray) -> np.ndarray:
        gamma, c = self.gamma, side.sound_speed(self.gamma)
        share = 2.0 / (gamma + 1.0) - way * (gamma - 1.0) / (gamma + 1.0) / c * (side.velocity - xi)
        u = 2.0 / (gamma + 1.0) * (-way * c + 0.5 * (gamma - 1.0) * side.velocity + xi)
        return np.array(
            [
                side.density * share ** (2.0 / (gamma - 1.0)),
                side.pressure * share ** (2.0 * gamma / (gamma - 1.0)),
                u,
            ]
        )


def _change(side: GasState, gamma: float, p: float) -> tuple[float, float]:
    """By how much the wave into a ``side`` changes the velocity where the pressure behind it is ``p``, m/s,
    and the derivative of that by ``p``."""
    c = side.sound_speed(gamma)
    if p > side.pressure:
        a, b = 2.0 / ((gamma + 1.0) * side.density), (gamma - 1.0) / (gamma + 1.0) * side.pressure
        root = math.sqrt(a / (p + b))
        return (p - side.pressure) * root, root * (1.0 - 0.5 * (p - side.pressure) / (p + b))
    power = (gamma - 1.0) / (2.0 * gamma)
    ratio = p / side.pressure
    return (
        2.0 * c / (gamma - 1.0) * (ratio**power - 1.0),
        1.0 / (side.density * c) * ratio ** (-0.5 * (gamma + 1.0) / gamma),
    )


def riemann(left: GasState, right: GasState, gamma: float) -> Riemann:
    """The solution of a Riemann problem by Newton's method; ValueError where the gases part and leave nothing
    between them."""
    c_left, c_right = left.sound_speed(gamma), right.sound_speed(gamma)
    apart = right.velocity - left.velocity
    if 2.0 * (c_left + c_right) / (gamma - 1.0) <= apart:
        raise ValueError("the states part so fast that a vacuum is left between them; give slower ones")
    # Two expansions: exact where both waves are, from below else, where the sum of changes is concave.
    power = 0.5 * (gamma - 1.0) / gamma
    p = (
        (c_left + c_right - 0.5 * (gamma - 1.0) * apart)
        / (c_left / left.pressure**power + c_right / right.pressure**power)
    ) ** (1.0 / power)
    for _ in range(MOST_TURNS):
        (of_left, slope_left), (of_right, slope_right) = (_change(side, gamma, p) for side in (left, right))
        new = max(p - (of_left + of_right + apart) / (slope_left + slope_right), 1e-3 * p)
        p, before = new, p
        if abs(p - before) <= CLOSE * p:
            break
    of_left, of_right = (_change(side, gamma, p)[0] for side in (left, right))
    velocity = 0.5 * (left.velocity + right.velocity + of_right - of_left)
    return Riemann(left, right, gamma, p, velocity)
