"""Equations of state: pressure from density, weakly compressible."""

from typing import NamedTuple

import numpy as np


class Linear(NamedTuple):
    """Pressure proportional to the excess of density.

    p = c²(ρ − ρ₀).  SSPH paper, eq. (7); c at least ten times the largest speed.
    """

    def pressure(self, density, rest_density, sound_speed):
        """p in Pa from ρ and ρ₀ in kg/m³ and c in m/s."""
        return sound_speed * sound_speed * (density - rest_density)

    def density(self, pressure, rest_density, sound_speed):
        """ρ in kg/m³, the inverse of :meth:`pressure`."""
        return rest_density + pressure / (sound_speed * sound_speed)

    def energy(self, density, rest_density, sound_speed):
        """Elastic energy ∫p/ρ² dρ from rest, J/kg, of arrays of densities in kg/m³."""
        ratio = density / rest_density
        return sound_speed * sound_speed * (np.log(ratio) + 1.0 / ratio - 1.0)


class Tait(NamedTuple):
    """Water's stiff pressure law.

    p = c²ρ₀/γ [(ρ/ρ₀)^γ − 1], γ = 7.  Batchelor (1967); Monaghan (1994), J. Comput. Phys. 110, 399.
    """

    gamma: float = 7.0

    def pressure(self, density, rest_density, sound_speed):
        """p in Pa from ρ and ρ₀ in kg/m³ and c in m/s."""
        stiffness = sound_speed * sound_speed * rest_density / self.gamma
        return stiffness * ((density / rest_density) ** self.gamma - 1.0)

    def density(self, pressure, rest_density, sound_speed):
        """ρ in kg/m³, the inverse of :meth:`pressure`; complex below p = −c²ρ₀/γ."""
        stiffness = sound_speed * sound_speed * rest_density / self.gamma
        return rest_density * (pressure / stiffness + 1.0) ** (1.0 / self.gamma)

    def energy(self, density, rest_density, sound_speed):
        """Elastic energy ∫p/ρ² dρ from rest, J/kg, of arrays of densities in kg/m³."""
        ratio, less = density / rest_density, self.gamma - 1.0
        stiffness = sound_speed * sound_speed / self.gamma
        return stiffness * ((ratio**less - 1.0) / less + 1.0 / ratio - 1.0)
