"""What an elastic solid is made of, and how fast its waves are."""

from collections.abc import Iterable
from typing import Any, NamedTuple

from psph.physics.solid.laws import LAWS, moduli

STEP = 0.6
"""Δt ≤ 0.6 min(h/(c_l + v), √(h/a)).  Gray, Monaghan & Swift (2001), Comput. Methods Appl. Mech. Eng. 190,
6641; Zhang, Rezavand & Hu (2021), J. Comput. Phys. 429, 110028."""

FRICTION_STEP = 0.125
"""Δt ≤ 0.125 h²ρ₀/η, as of viscous fluids (Morris and others 1997)."""

MADE_OF = ("density", "young", "poisson", "law", "damping", "hourglass")
"""The keys of a case that say what a solid is made of."""


class Solid(NamedTuple):
    """An elastic solid: its ``law`` (psph.physics.solid.laws), ``density`` in the reference in kg/m³, and
    ``wave_speed`` c_l = √((λ + 2μ)/ρ₀) of its fastest wave in m/s; the ``viscosity`` of Kelvin and Voigt in
    Pa s, and the ``stiffness`` αE of the hourglass control in Pa."""

    name: str
    law: Any
    density: float
    wave_speed: float
    viscosity: float
    stiffness: float

    def longest_step(self, smoothing_length: float, speed: float) -> float:
        """By waves and friction, at the largest speed in m/s, s."""
        h = smoothing_length
        by_waves = STEP * h / (self.wave_speed + speed)
        if not self.viscosity:
            return by_waves
        return min(by_waves, FRICTION_STEP * h * h * self.density / self.viscosity)


def solid_of(
    name: str, density: float, young: float, poisson: float, law: str, damping: float, hourglass: float
) -> Solid:
    """The solid of these numbers: ``young`` and ``poisson`` E in Pa and ν, ``damping`` η in Pa s."""
    lame, shear = moduli(young, poisson)
    speed = ((lame + 2.0 * shear) / density) ** 0.5
    return Solid(name, LAWS[law](lame, shear), density, speed, damping, hourglass * young)


def is_damped(solids: Iterable[Solid]) -> bool:
    """Whether any solid has a viscosity: then velocities are summed, and travel, too."""
    return any(one.viscosity for one in solids)
