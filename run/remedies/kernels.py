"""Remedies: kernels that are steepest where particles are nearest.

A case beside this file says ``use = ["kernels.py"]``.
"""

import math
from typing import NamedTuple

from psph.physics.catalogue import Catalogue, Entry


class Quadratic(NamedTuple):
    """Quadratic kernel, W = α(2−s)²₊: its slope is steepest where particles are nearest.

    W″ > 0 everywhere; W′ = −4α/h at s = 0, a cusp, and W″ jumps at s = 2.  Johnson, Stryk & Beissel
    (1996), Comput. Methods Appl. Mech. Eng. 139, 347.
    """

    inverse_h: float
    alpha: float

    support = 2.0
    norm = (3 / 16, 3 / (8 * math.pi), 15 / (64 * math.pi))

    def w(self, r):
        """W(r)."""
        a = max(2.0 - r * self.inverse_h, 0.0)
        return self.alpha * a * a

    def dw(self, r):
        """dW/dr, 1/m more than W."""
        a = max(2.0 - r * self.inverse_h, 0.0)
        return -2.0 * self.alpha * self.inverse_h * a


class Spiky(NamedTuple):
    """Spiky kernel, W = α(2−s)³₊: the power above the quadratic one, smooth at its edge.

    W″ > 0 everywhere; W′ = −12α/h at s = 0, a cusp.  Desbrun & Gascuel (1996), Comput. Animat. Simul.
    '96, 61.
    """

    inverse_h: float
    alpha: float

    support = 2.0
    norm = (1 / 8, 5 / (16 * math.pi), 15 / (64 * math.pi))

    def w(self, r):
        """W(r)."""
        a = max(2.0 - r * self.inverse_h, 0.0)
        return self.alpha * a * a * a

    def dw(self, r):
        """dW/dr, 1/m more than W."""
        a = max(2.0 - r * self.inverse_h, 0.0)
        return -3.0 * self.alpha * self.inverse_h * a * a


CATALOGUE = Catalogue(
    kernels=(Entry("space.kernel=quadratic", Quadratic), Entry("space.kernel=spiky", Spiky))
)
