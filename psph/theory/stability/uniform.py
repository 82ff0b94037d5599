"""The undisturbed state: particles at rest on a lattice under a uniform pressure."""

from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from psph.smoothing import kernel
from psph.theory.stability import SYMMETRIC
from psph.theory.stability.lattices import BravaisLattice, lattice

STIFF = 10.0
"""Default of c in √(|P|/ρ): P is about ρU², and c ten times the speed U."""


class Settings(NamedTuple):
    """Kernel, lattice and scheme; pressure in Pa, density in kg/m³, c in m/s, spacing in m.

    ``remedies`` are values of `psph.theory.stability.parts`, or of any class with methods like theirs.
    """

    kernel: str
    smoothing: float
    lattice: str
    pressure: float
    form: str = SYMMETRIC
    density: float = 1.0
    sound_speed: float = STIFF
    spacing: float = 1.0
    remedies: tuple[Any, ...] = ()


class Uniform:
    """Particles at rest on a lattice, under the same pressure everywhere, and their scheme."""

    def __init__(self, settings: Settings):
        self.settings = settings
        self.pressure, self.density = settings.pressure, settings.density
        self.sound_speed, self.spacing = settings.sound_speed, settings.spacing
        self.smoothing_length = settings.smoothing * settings.spacing
        self.lattice: BravaisLattice = lattice(settings.lattice, settings.spacing)
        self.kernel = kernel(settings.kernel, self.smoothing_length, self.lattice.dimensions)
        self.volume = settings.spacing**self.lattice.dimensions

    @property
    def reach(self) -> float:
        """Radius of the kernel support, m."""
        return self.kernel.support * self.smoothing_length

    @property
    def response(self) -> float:
        """d(p/ρ²)/dρ = c²/ρ² − 2p/ρ³, m⁵/(kg s²) in 3D."""
        return (self.sound_speed**2 - 2.0 * self.pressure / self.density) / self.density**2

    def weight(self, r: np.ndarray) -> np.ndarray:
        """W(r), 1/m^d, same shape as r."""
        return of_each(self.kernel.w, r)

    def slope(self, r: np.ndarray) -> np.ndarray:
        """W′(r), 1/m^(d+1), over the first moment where a remedy asks for it."""
        return self._slope(r) / self.moment

    @cached_property
    def moment(self) -> float:
        """The divisor of gradients."""
        normalised = any(hasattr(remedy, "normalises") for remedy in self.settings.remedies)
        return self.first_moment if normalised else 1.0

    @cached_property
    def first_moment(self) -> float:
        """−1/d Σ V r W′: what the sums make of the gradient of a linear field, ideally 1."""
        r = np.linalg.norm(self.lattice.within(self.reach) @ self.lattice.basis, axis=1)
        return float(-(r * self._slope(r)).sum() * self.volume / self.lattice.dimensions)

    def _slope(self, r: np.ndarray) -> np.ndarray:
        return of_each(self.kernel.dw, r)


def of_each(formula, r: np.ndarray) -> np.ndarray:
    """A formula of a single number, of each in r; few of the distances on a lattice differ."""
    values, places = np.unique(r, return_inverse=True)
    return np.array([formula(x) for x in values.tolist()])[places]
