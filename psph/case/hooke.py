"""What soils and elastic solids have in common: matter that obeys Hooke's law where it does not yield."""

import math
from typing import TYPE_CHECKING, ClassVar

from psph.case.matter import FreeMatter


class Hookean(FreeMatter):
    """Matter with Young's modulus E, Poisson's ratio ν and a density at rest."""

    viscosity: ClassVar = 0.0
    rheology: ClassVar = None
    equation_of_state: ClassVar = None
    pressure: ClassVar = 0.0

    if TYPE_CHECKING:  # keys of each kind of matter, in the order and with the words of its own
        young: float
        poisson: float
        density: float

    @property
    def shear_modulus(self) -> float:
        """G = E/(2(1 + ν)), Pa."""
        return 0.5 * self.young / (1.0 + self.poisson)

    @property
    def bulk_modulus(self) -> float:
        """K = E/(3(1 − 2ν)), Pa."""
        return self.young / (3.0 * (1.0 - 2.0 * self.poisson))

    @property
    def wave_speed(self) -> float:
        """Of the fastest wave, √((K + 4G/3)/ρ), m/s."""
        return math.sqrt((self.bulk_modulus + 4.0 / 3.0 * self.shear_modulus) / self.density)
