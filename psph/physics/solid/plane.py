"""Plane stress: a sheet in 2D that is free to become thinner, so that nothing pulls across it."""

from typing import Any, NamedTuple

import numpy as np

from psph.engine.jit import call_by_type
from psph.formula import helper, long_helper

law_stress, law_energy = map(call_by_type, ("stress", "energy"))

SPACE = (1.0, 1.0, 1.0)
"""Any vector of three dimensions."""

TURNS, LONGEST = 40, 0.5
"""The most steps in which the thickness is found, six are usual; and the largest change of its logarithm in
one of them."""

CLOSE = 1e-13
"""The change of the logarithm of the thickness at which it is found."""


class PlaneStress(NamedTuple):
    """An elastic ``law`` of a sheet: its stretch λ_z across is such that P_zz = 0.

    It is the law in three dimensions of F and λ_z, for any law.  The energy ψ(F, λ_z) has the derivative P,
    since ∂ψ/∂λ_z = P_zz is none.  Bonet & Wood, Nonlinear Continuum Mechanics for Finite Element Analysis
    (2008), section 6.6.
    """

    law: Any

    def stress(self, f, a):
        """The first Piola–Kirchhoff stress P by the thickness at the start, Pa, by rows."""
        p = law_stress(self.law, in_space(f, thickness(self.law, f, a)), SPACE)
        return p[0], p[1], p[3], p[4]

    def across(self, f, a):
        """None, Pa."""
        return 0.0

    def energy(self, f, a):
        """ψ, J per reference volume."""
        return law_energy(self.law, in_space(f, thickness(self.law, f, a)), SPACE)

    def thinned(self, f, a):
        """λ_z, the thickness over that at the start."""
        return thickness(self.law, f, a)


@helper
def in_space(f, thick):
    """The deformation gradient of three dimensions by rows."""
    return f[0], f[1], 0.0, f[2], f[3], 0.0, 0.0, 0.0, thick


@helper
def pull(law, f, log):
    """λ_z P_zz, Pa, at the logarithm of λ_z."""
    thick = np.exp(log)
    return thick * law_stress(law, in_space(f, thick), SPACE)[8]


@long_helper
def thickness(law, f, a):
    """λ_z at which P_zz = 0, by secants of λ_z P_zz over ln λ_z; 1 for an F without area."""
    area = abs(f[0] * f[3] - f[1] * f[2])
    if area == 0.0:
        return 1.0
    log = -0.5 * np.log(area)
    before, found = 0.9 * log + 1e-3, pull(law, f, log)
    old = pull(law, f, before)
    for _ in range(TURNS):
        if found == old:
            break
        change = -found * (log - before) / (found - old)
        change = min(max(change, -LONGEST), LONGEST)
        before, old = log, found
        log += change
        if abs(change) <= CLOSE:
            break
        found = pull(law, f, log)
    return np.exp(log)


def even(law, f, a):
    """1: other matter has no thickness that changes."""
    return 1.0


thinned = call_by_type("thinned", even)
"""(law, F, a) → the thickness over that at the start."""
