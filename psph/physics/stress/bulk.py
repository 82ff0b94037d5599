"""The pressure of matter that resists shear, from its density."""

import math
from typing import NamedTuple

import numpy as np


class Hooke(NamedTuple):
    """Pressure proportional to the logarithm of the compression.

    p = K ln(ρ/ρ₀), so that dp/dt = −K ∇·v exactly: Hooke's law as a rate, beside that of
    :class:`psph.physics.stress.deviator.DeviatorRate`; and no tension beyond ``tension`` in Pa: what is torn
    apart bears that, and has to close again before it is pressed.  ``bulk`` is K in Pa.
    """

    bulk: float
    tension: float = math.inf

    def pressure(self, density, rest_density, sound_speed):
        """p in Pa from ρ and ρ₀ in kg/m³; the speed of sound is not looked at."""
        return max(self.bulk * np.log(density / rest_density), -self.tension)

    def density(self, pressure, rest_density, sound_speed):
        """ρ in kg/m³, the inverse of :meth:`pressure`."""
        return rest_density * np.exp(pressure / self.bulk)

    def energy(self, density, rest_density, sound_speed):
        """Elastic energy ∫p/ρ² dρ from rest, J/kg, of arrays of densities in kg/m³."""
        ratio = np.maximum(density / rest_density, math.exp(-self.tension / self.bulk))
        return self.bulk / rest_density * (1.0 - (np.log(ratio) + 1.0) / ratio)
