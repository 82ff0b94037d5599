"""The pressure of matter that resists shear, from its density."""

from typing import NamedTuple

import numpy as np


class Hooke(NamedTuple):
    """Pressure proportional to the logarithm of the compression.

    p = K ln(ρ/ρ₀), so that dp/dt = −K ∇·v exactly: Hooke's law as a rate, beside that of
    :class:`psph.physics.stress.deviator.DeviatorRate`.  ``bulk`` is K in Pa.
    """

    bulk: float

    def pressure(self, density, rest_density, sound_speed):
        """p in Pa from ρ and ρ₀ in kg/m³; the speed of sound is not looked at."""
        return self.bulk * np.log(density / rest_density)

    def density(self, pressure, rest_density, sound_speed):
        """ρ in kg/m³, the inverse of :meth:`pressure`."""
        return rest_density * np.exp(pressure / self.bulk)

    def energy(self, density, rest_density, sound_speed):
        """Elastic energy ∫p/ρ² dρ from rest, J/kg, of arrays of densities in kg/m³."""
        ratio = density / rest_density
        return self.bulk / rest_density * (1.0 - (np.log(ratio) + 1.0) / ratio)
