"""Smoothing kernels W(r, h): what a particle weighs its neighbours with.

One class a kernel and one line in ``KERNELS``.  Each is written in s = r/h and vanishes for
s ≥ ``support``; ``norm`` holds the constants that make ∫W dV = 1 in 1D, 2D and 3D (times h^-d), one or
several.  All are branch-free: ``max(k - s, 0)`` cuts a power off.  W has the unit m^-d.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from psph.engine.jit import call_by_type, method_of, overload
from psph.engine.simd import where

weight = call_by_type("w")
"""(kernel, r) → W(r), in compiled code and plain Python."""
slope = call_by_type("dw")
"""(kernel, r) → W′(r), in compiled code and plain Python."""


def slope_over_r(kernel, r, inverse_r):
    """W′(r)/r, by the kernel's own ``dw_r`` where it can do without 1/r."""
    return kernel.dw_r(r, inverse_r) if hasattr(kernel, "dw_r") else kernel.dw(r) * inverse_r


@overload(slope_over_r)
def _typed_slope_over_r(kernel, r, inverse_r):
    own = method_of(kernel, "dw_r")
    if own is not None:
        return lambda kernel, r, inverse_r: own(kernel, r, inverse_r)
    return lambda kernel, r, inverse_r: slope(kernel, r) * inverse_r


class Cubic(NamedTuple):
    """Cubic spline, W = α[(2−s)³₊ − 4(1−s)³₊].

    Monaghan & Lattanzio (1985), Astron. Astrophys. 149, 135; eq. (9) of the SSPH paper.
    """

    inverse_h: float
    alpha: float

    support = 2.0
    norm = (1 / 6, 5 / (14 * math.pi), 1 / (4 * math.pi))

    def w(self, r):
        """W(r)."""
        s = r * self.inverse_h
        a, b = max(2.0 - s, 0.0), max(1.0 - s, 0.0)
        return self.alpha * (a * a * a - 4.0 * b * b * b)

    def dw(self, r):
        """dW/dr, 1/m more than W."""
        s = r * self.inverse_h
        a, b = max(2.0 - s, 0.0), max(1.0 - s, 0.0)
        return self.alpha * self.inverse_h * (12.0 * b * b - 3.0 * a * a)


class Quintic(NamedTuple):
    """Quintic spline, W = α[(3−s)⁵₊ − 6(2−s)⁵₊ + 15(1−s)⁵₊], support 3h.

    Schoenberg (1946), Q. Appl. Math. 4, 45; Morris, Fox & Zhu (1997), J. Comput. Phys. 136, 214.
    """

    inverse_h: float
    alpha: float

    support = 3.0
    norm = (1 / 120, 7 / (478 * math.pi), 1 / (120 * math.pi))

    def w(self, r):
        """W(r)."""
        s = r * self.inverse_h
        a, b, c = max(3.0 - s, 0.0), max(2.0 - s, 0.0), max(1.0 - s, 0.0)
        return self.alpha * (a**5 - 6.0 * b**5 + 15.0 * c**5)

    def dw(self, r):
        """dW/dr, 1/m more than W."""
        s = r * self.inverse_h
        a, b, c = max(3.0 - s, 0.0), max(2.0 - s, 0.0), max(1.0 - s, 0.0)
        return self.alpha * self.inverse_h * (-5.0 * a**4 + 30.0 * b**4 - 75.0 * c**4)


class WendlandC2(NamedTuple):
    """Wendland C2, W = α(1−s/2)⁴₊(1 + 2s), the same polynomial in 1D, 2D and 3D.

    Wendland (1995), Adv. Comput. Math. 4, 389; Dehnen & Aly (2012), MNRAS 425, 1068.
    """

    inverse_h: float
    alpha: float

    support = 2.0
    norm = (3 / 4, 7 / (4 * math.pi), 21 / (16 * math.pi))

    def w(self, r):
        """W(r)."""
        s = r * self.inverse_h
        a = max(1.0 - 0.5 * s, 0.0)
        return self.alpha * (a * a) * (a * a) * (1.0 + 2.0 * s)

    def dw(self, r):
        """dW/dr, 1/m more than W."""
        s = r * self.inverse_h
        a = max(1.0 - 0.5 * s, 0.0)
        return -5.0 * self.alpha * self.inverse_h * s * (a * a * a)

    def dw_r(self, r, inverse_r):
        """W′/r, a polynomial."""
        a = max(1.0 - 0.5 * r * self.inverse_h, 0.0)
        return -5.0 * self.alpha * self.inverse_h * self.inverse_h * (a * a * a)


class WendlandC4(NamedTuple):
    """Wendland C4, W = α(1−s/2)⁶₊(1 + 3s + 35s²/12).  Source: see :class:`WendlandC2`."""

    inverse_h: float
    alpha: float

    support = 2.0
    norm = (27 / 32, 9 / (4 * math.pi), 495 / (256 * math.pi))

    def w(self, r):
        """W(r)."""
        s = r * self.inverse_h
        a = max(1.0 - 0.5 * s, 0.0)
        return self.alpha * a**6 * (1.0 + s * (3.0 + s * (35 / 12)))

    def dw(self, r):
        """dW/dr, 1/m more than W."""
        s = r * self.inverse_h
        a = max(1.0 - 0.5 * s, 0.0)
        return -(14 / 3) * self.alpha * self.inverse_h * s * a**5 * (1.0 + 2.5 * s)

    def dw_r(self, r, inverse_r):
        """W′/r, a polynomial."""
        s = r * self.inverse_h
        a = max(1.0 - 0.5 * s, 0.0)
        return -(14 / 3) * self.alpha * self.inverse_h * self.inverse_h * a**5 * (1.0 + 2.5 * s)


class WendlandC6(NamedTuple):
    """Wendland C6, W = α(1−s/2)⁸₊(1 + 4s + 25s²/4 + 4s³).  Source: see :class:`WendlandC2`."""

    inverse_h: float
    alpha: float

    support = 2.0
    norm = (15 / 16, 39 / (14 * math.pi), 1365 / (512 * math.pi))

    def w(self, r):
        """W(r)."""
        s = r * self.inverse_h
        a = max(1.0 - 0.5 * s, 0.0)
        return self.alpha * a**8 * (1.0 + s * (4.0 + s * (6.25 + 4.0 * s)))

    def dw(self, r):
        """dW/dr, 1/m more than W."""
        s = r * self.inverse_h
        a = max(1.0 - 0.5 * s, 0.0)
        return -5.5 * self.alpha * self.inverse_h * s * a**7 * (1.0 + s * (3.5 + 4.0 * s))

    def dw_r(self, r, inverse_r):
        """W′/r, a polynomial."""
        s = r * self.inverse_h
        a = max(1.0 - 0.5 * s, 0.0)
        slope_s = a**7 * (1.0 + s * (3.5 + 4.0 * s))
        return -5.5 * self.alpha * self.inverse_h * self.inverse_h * slope_s


class Gaussian(NamedTuple):
    """Gaussian, W = α exp(−s²), cut at 3h and normalised over what is left.

    Gingold & Monaghan (1977), MNRAS 181, 375.  The cut leaves a step of 1.2e-4 W(0) at 3h.
    """

    inverse_h: float
    alpha: float

    support = 3.0
    norm = (
        1 / (math.sqrt(math.pi) * math.erf(3.0)),
        1 / (math.pi * (1.0 - math.exp(-9.0))),
        1 / (math.pi**1.5 * math.erf(3.0) - 6.0 * math.pi * math.exp(-9.0)),
    )

    def w(self, r):
        """W(r)."""
        s = r * self.inverse_h
        return where(s < 3.0, self.alpha * np.exp(-s * s), 0.0)

    def dw(self, r):
        """dW/dr, 1/m more than W."""
        s = r * self.inverse_h
        slope_s = -2.0 * self.alpha * self.inverse_h * s * np.exp(-s * s)
        return where(s < 3.0, slope_s, 0.0)


class Hyperbolic(NamedTuple):
    """Hyperbolic kernel, W = α[(2−s)³₊ − 2(1−s)³₊]: W″ ≥ 0 everywhere.

    Written out: s³ − 6s + 6 for s < 1 and (2−s)³ for 1 ≤ s < 2; W′ = −6α/h at s = 0, a cusp.
    SSPH paper (Acta Phys. Sin. 61, 224701, 2012), eq. (13).
    """

    inverse_h: float
    alpha: float

    support = 2.0
    norm = (1 / 7, 1 / (3 * math.pi), 15 / (62 * math.pi))

    def w(self, r):
        """W(r)."""
        s = r * self.inverse_h
        a, b = max(2.0 - s, 0.0), max(1.0 - s, 0.0)
        return self.alpha * (a * a * a - 2.0 * b * b * b)

    def dw(self, r):
        """dW/dr, 1/m more than W."""
        s = r * self.inverse_h
        a, b = max(2.0 - s, 0.0), max(1.0 - s, 0.0)
        return 3.0 * self.alpha * self.inverse_h * (2.0 * b * b - a * a)


class FourthOrder(NamedTuple):
    """Two quintic splines, W = 2 W₅(h) − W₅(√2 h): errors of fourth order, for smooth flows alone.

    Its second moment vanishes, so that a field is smoothed by h⁴ and not by h²; for that it is
    negative beyond 2 h.  Monaghan (1985), Comput. Phys. Rep. 3, 71, §3.3, with splines in place of
    Gaussians.  Pairs attract where W′ > 0: no kernel for free surfaces or negative pressures.
    """

    inverse_h: float
    alpha: float
    alpha_wide: float

    support = 3.0 * math.sqrt(2.0)
    repels = False
    norm = tuple((norm, norm * 2.0 ** (-0.5 * d)) for d, norm in enumerate(Quintic.norm, start=1))

    def w(self, r):
        """W(r)."""
        narrow = Quintic(self.inverse_h, self.alpha)
        wide = Quintic(self.inverse_h * math.sqrt(0.5), self.alpha_wide)
        return 2.0 * weight(narrow, r) - weight(wide, r)

    def dw(self, r):
        """dW/dr, 1/m more than W."""
        narrow = Quintic(self.inverse_h, self.alpha)
        wide = Quintic(self.inverse_h * math.sqrt(0.5), self.alpha_wide)
        return 2.0 * slope(narrow, r) - slope(wide, r)


class Normalised(NamedTuple):
    """A kernel whose slope is divided by its first moment M = −(1/d) Σ dx^d r W′ on the lattice.

    Gradients of linear fields are then exact on that lattice.  W itself stays.
    """

    kernel: Any
    stretch: float
    """1/M."""

    @property
    def support(self) -> float:
        """Where W ends, r/h."""
        return self.kernel.support

    @property
    def inverse_h(self) -> float:
        """1/h, 1/m."""
        return self.kernel.inverse_h

    def w(self, r):
        """W(r)."""
        return weight(self.kernel, r)

    def dw(self, r):
        """W′(r)/M."""
        return self.stretch * slope(self.kernel, r)

    def dw_r(self, r, inverse_r):
        """W′/(M r)."""
        return self.stretch * slope_over_r(self.kernel, r, inverse_r)


KERNELS = {
    "wendland-c2": WendlandC2,
    "hyperbolic": Hyperbolic,
    "cubic": Cubic,
    "quintic": Quintic,
    "wendland-c4": WendlandC4,
    "wendland-c6": WendlandC6,
    "gaussian": Gaussian,
    "fourth-order": FourthOrder,
}
"""Every smoothing kernel by the name that a case gives it.

The first stands in for a case whose scheme or profile names none."""


def kernel(name: str, smoothing_length: float, dimensions: int):
    """The kernel ``name`` for h in m and 1, 2 or 3 dimensions; KeyError for an unknown name."""
    cls: Any = KERNELS[name]
    constants = np.atleast_1d(cls.norm[dimensions - 1]) / smoothing_length**dimensions
    return cls(1.0 / smoothing_length, *constants.tolist())


def unit_kernel(kernel, dimensions: int) -> Any:
    """The ``kernel`` of a scene with h = 1 m."""
    return kernel._replace(inverse_h=1.0, alpha=kernel.alpha / kernel.inverse_h**dimensions)
