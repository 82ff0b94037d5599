"""The elastic catenary, on a level bed too: its tensions and shape, as J. Jonkman, NREL/TP-500-41958 (2007), has it."""

import math
from typing import NamedTuple

import numpy as np
from scipy.optimize import fsolve


class Catenary(NamedTuple):
    """A line of ``weight`` N/m, ``length`` m without tension and ``stiffness`` EA N from an anchor at (0, 0) to (x, z),
    pulled there with H and V, N; what is ``lying`` on the bed, m."""

    weight: float
    length: float
    stiffness: float
    h: float
    v: float
    lying: float

    def point(self, s):
        """Where the point ``s`` m of its length from the anchor is: (x, z), m."""
        w, ea, h = self.weight, self.stiffness, self.h
        if s <= self.lying:
            return s * (1.0 + h / ea), 0.0
        low = self.v - w * (self.length - self.lying)  # 0 where it lies
        up, on = low + w * (s - self.lying), s - self.lying
        x = self.lying * (1.0 + h / ea) + h / w * (math.asinh(up / h) - math.asinh(low / h)) + h * on / ea
        z = (math.hypot(h, up) - math.hypot(h, low)) / w + (up * up - low * low) / (2.0 * ea * w)
        return x, z


def catenary(weight, length, stiffness, x, z, bed=False):
    """The one that ends at (x, z)."""

    def one(h, v):
        lying = max(length - v / weight, 0.0) if bed else 0.0
        return Catenary(weight, length, stiffness, abs(h), v, lying)

    start = 0.3 * weight * length, 0.7 * weight * length
    found = fsolve(lambda hv: np.subtract(one(*hv).point(length), (x, z)), start, xtol=1e-11)
    return one(*found)
