"""Cracks: bonds of a solid that are cut for good where they are stretched too far.

A bond is a pair of neighbours in the reference.  It is cut where |x_ij| > (1 + s_ij)|X_ij|; s_ij is the
critical stretch of the solid times the smaller of the strengths of both particles.  A pair that is cut
counts no more in L, F, the force and the hourglass control of both, and the energy of a particle is

    V (1 − D) ψ(F),   D the part of its bonds that is cut:

L alone would make up for every bond that is lost, and nothing would give way.  With L made again from what is
left, force and energy belong together as before, and momentum and angular momentum are kept.
Silling & Askari (2005), Comput. Struct. 83, 1526 (bonds, and damage as the part of them that is cut);
Rabczuk & Belytschko (2004), Int. J. Numer. Methods Eng. 61, 2316 (cracks as cut pairs of particles).
"""

import math

import numpy as np

from psph.fields import VECTOR, Field

CUT = Field("cut", "1", "bits of a particle's bonds, in the order of ids: 1 where one is cut", VECTOR)
DAMAGE = Field("damage", "1", "part of a particle's bonds that are cut", saved=True)

OF_CRACKS = (CUT, DAMAGE)
"""What particles carry only where a solid may crack."""

BITS = 52
"""Bits of bonds in a number of ``cut``, which holds them exactly."""

FEWEST = 0.25
"""A particle that has less than this part of its bonds lets go of them all, before they span no space."""

FLATTEST = 0.2
"""Nor does one hold that has lost some if the determinant of its Σ V g X Xᵀ, 1 in the bulk, is below 0.2^d:
its bonds lie about along a line."""


def strengths(ids: np.ndarray, seed: int, modulus: float) -> np.ndarray:
    """Weibull's strengths (n,) of the particles ``ids`` (n,), 1 on average: (−ln u)^(1/m)/Γ(1 + 1/m).

    ``modulus`` m; u in (0, 1) is mixed from the id and ``seed`` by the bijection of Steele, Lea & Flood
    (2014), OOPSLA, 453.  Weibull (1951), J. Appl. Mech. 18, 293.
    """
    with np.errstate(over="ignore"):
        z = ids.astype(np.uint64) + np.uint64(1) + np.uint64(seed) * np.uint64(0x9E3779B97F4A7C15)
        z *= np.uint64(0x9E3779B97F4A7C15)
        z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        z ^= z >> np.uint64(31)
    u = ((z >> np.uint64(11)).astype(float) + 0.5) * 2.0**-53
    return (-np.log(u)) ** (1.0 / modulus) / math.gamma(1.0 + 1.0 / modulus)
