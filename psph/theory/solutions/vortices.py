"""Vortices in two and three dimensions."""

import math
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from psph.theory.solutions.setting import Setting, Surroundings, whole_waves


def _only_2d(setting: Surroundings) -> str | None:
    return None if setting.dimensions == 2 else "is a flow in 2D; give space.dimensions = 2"


TopSpeed = Annotated[
    float, Field(gt=0, description="largest speed U at the start", json_schema_extra={"unit": "m/s"})
]
Period = Annotated[float, Field(gt=0, description="length L of a period", json_schema_extra={"unit": "m"})]
"""Keys of vortices that fill space: their largest speed, m/s, and length, m."""


class TaylorGreen(NamedTuple):
    """Vortices side by side that decay by viscosity alone.

    u = U e^(−2νk²t) (−cos kx sin ky, sin kx cos ky), p = −ρU²/4 e^(−4νk²t) (cos 2kx + cos 2ky),
    k = 2π/L.  Taylor & Green (1937), Proc. R. Soc. Lond. A 158, 499.
    """

    speed: TopSpeed
    length: Period

    up_to_a_constant = ("pressure",)

    def unfit(self, setting: Surroundings) -> str | None:
        """What is wrong with the case for this solution, or None."""
        return _only_2d(setting) or whole_waves(setting, (0, 1), self.length)

    def top_speed(self, setting: Surroundings) -> float:
        """The largest speed, m/s."""
        return self.speed

    def velocity(self, x: np.ndarray, t: float, setting: Setting) -> np.ndarray:
        """u (n, dim) in m/s at ``x`` (n, dim) m and ``t`` s."""
        k = 2.0 * math.pi / self.length
        a = self.speed * math.exp(-2.0 * setting.viscosity * k * k * t)
        kx, ky = k * x.T
        return a * np.column_stack([-np.cos(kx) * np.sin(ky), np.sin(kx) * np.cos(ky)])

    def pressure(self, x: np.ndarray, t: float, setting: Setting) -> np.ndarray:
        """p (n,) in Pa, zero on average."""
        k = 2.0 * math.pi / self.length
        a = self.speed * math.exp(-2.0 * setting.viscosity * k * k * t)
        kx, ky = k * x.T
        return -0.25 * setting.density * a * a * (np.cos(2.0 * kx) + np.cos(2.0 * ky))


class Beltrami(NamedTuple):
    """A flow in 3D whose vorticity is parallel to its velocity everywhere; it decays by viscosity alone.

    u = a e^(−νk²t) (sin kz + cos ky, sin kx + cos kz, sin ky + cos kx), a = U/√6, p = −ρ u²/2, k = 2π/L: the
    flow of Arnold, Beltrami and Childress with equal parts; an exact solution since u × ∇×u = 0.  Dombre and
    others (1986), J. Fluid Mech. 167, 353.
    """

    speed: TopSpeed
    length: Period

    up_to_a_constant = ("pressure",)

    def unfit(self, setting: Surroundings) -> str | None:
        """What is wrong with the case for this solution, or None."""
        if setting.dimensions != 3:
            return "is a flow in 3D; give space.dimensions = 3"
        return whole_waves(setting, (0, 1, 2), self.length)

    def top_speed(self, setting: Surroundings) -> float:
        """The largest speed, m/s."""
        return self.speed

    def velocity(self, x: np.ndarray, t: float, setting: Setting) -> np.ndarray:
        """u (n, 3) in m/s at ``x`` (n, 3) m and ``t`` s."""
        k = 2.0 * math.pi / self.length
        a = self.speed / math.sqrt(6.0) * math.exp(-setting.viscosity * k * k * t)
        s, c = np.sin(k * x.T), np.cos(k * x.T)
        return a * np.column_stack([s[2] + c[1], s[0] + c[2], s[1] + c[0]])

    def pressure(self, x: np.ndarray, t: float, setting: Setting) -> np.ndarray:
        """p (n,) in Pa, zero where the flow rests."""
        return -0.5 * setting.density * (self.velocity(x, t, setting) ** 2).sum(axis=1)


class Gresho(NamedTuple):
    """A steady vortex, triangular in its speed: pressure alone holds it together.

    u_φ = U s for s < 1, U (2 − s) for s < 2, else 0, with s = r/R.  Gresho & Chan (1990), Int. J.
    Numer. Methods Fluids 11, 621; pressure after Liska & Wendroff (2003), SIAM J. Sci. Comput.
    25, 995, zero outside.
    """

    speed: Annotated[float, Field(gt=0, description="largest speed U", json_schema_extra={"unit": "m/s"})]
    radius: Annotated[
        float, Field(gt=0, description="radius R of that speed", json_schema_extra={"unit": "m"})
    ]
    centre: Annotated[
        tuple[float, float],
        Field(description="centre of the vortex", json_schema_extra={"unit": "m"}),
    ] = (0.0, 0.0)

    up_to_a_constant = ("pressure",)

    def unfit(self, setting: Surroundings) -> str | None:
        """What is wrong with the case for this solution, or None."""
        if setting.viscosity:
            return "is a flow without friction; remove the fluid's viscosity"
        return _only_2d(setting)

    def top_speed(self, setting: Surroundings) -> float:
        """The largest speed, m/s."""
        return self.speed

    def velocity(self, x: np.ndarray, t: float, setting: Setting) -> np.ndarray:
        """u (n, dim) in m/s at ``x`` (n, dim) m; the same at all times."""
        off = (x - np.array(self.centre)) / self.radius
        s = np.hypot(*off.T)
        around = np.where(s < 1.0, s, np.maximum(2.0 - s, 0.0))
        turn = self.speed * around / np.maximum(s, 1e-300)
        return turn[:, None] * np.column_stack([-off[:, 1], off[:, 0]])

    def pressure(self, x: np.ndarray, t: float, setting: Setting) -> np.ndarray:
        """p (n,) in Pa."""
        s = np.hypot(*((x - np.array(self.centre)) / self.radius).T)
        ring = np.clip(s, 1.0, 2.0)
        p = np.where(s < 1.0, 0.5 * s * s, 0.5 * ring * ring + 4.0 * (1.0 - ring + np.log(ring)))
        return setting.density * self.speed**2 * (p - (4.0 * math.log(2.0) - 2.0))
