"""Solids whose stress relaxes: a law of elasticity that lasts, and branches beside it that forget.

Each branch is a spring G behind a dashpot Gτ (Maxwell), with a history C_v⁻¹ as a metal has one
(psph.physics.solid.strain): its stress is G dev b, b = J^{−2/3} F C_v⁻¹ Fᵀ, and dev b falls by exp(−Δt/τ)
in a step.  For small strains the shear modulus falls as the series of Prony, G(t) = G∞ + Σ G_n exp(−t/τ_n),
to the first order in Δt/τ.  Reese & Govindjee (1998), Int. J. Solids Struct. 35, 3455.
"""

from typing import Any, NamedTuple

import numpy as np

from psph.engine.jit import call_by_type, overload_inside, tuple_of, unrolled
from psph.fields import SYMMETRIC, Field
from psph.formula import long_helper
from psph.physics.solid.history import History
from psph.physics.solid.strain import dilation, elastic_part, history_of, nominal, only_in_plane
from psph.vectors import add, less_diagonal, scale, trace

MOST = 4
"""Branches of a solid."""

RELAXED = tuple(
    Field(f"relaxed_metric_{n}", "1", "C_v⁻¹ − 1, the history of a branch that relaxes", SYMMETRIC)
    for n in range(MOST)
)
"""What particles carry only where the stress of a solid relaxes, one for each branch."""

law_stress, law_across, law_energy = map(call_by_type, ("stress", "across", "energy"))


class Branch(NamedTuple):
    """A spring of the ``shear`` modulus G in Pa, which forgets its stress in the ``time`` τ in s."""

    shear: float
    time: float


class Viscoelastic(NamedTuple):
    """The ``law`` that lasts (psph.physics.solid.laws) and ``branches`` beside it."""

    law: Any
    branches: tuple[Branch, ...]

    def flow(self, f, past, dt, a):
        """P in Pa by rows after a step of ``dt`` s with the deformation ``f``, and the new History."""
        p, kept = all_relaxed(self.branches, past.branches, law_stress(self.law, f, a), f, dt, a)
        return p, History(past.metric, past.strain, past.work, past.heat, kept)

    def stress(self, f, past, a):
        """P in Pa by rows at what it remembers."""
        p, volume = law_stress(self.law, f, a), dilation(f, a)
        for n in range(len(self.branches)):
            b, b_zz = elastic_part(f, past.branches[n], volume, a)
            s = less_diagonal(b, (trace(b, a) + b_zz) / 3.0, a)
            p = add(p, nominal(scale(s, self.branches[n].shear), f, volume, a))
        return p

    def across(self, f, past, a):
        """P along z in plane strain, Pa."""
        p, volume = law_across(self.law, f, a), dilation(f, a)
        for n in range(len(self.branches)):
            b, b_zz = elastic_part(f, past.branches[n], volume, a)
            p += self.branches[n].shear * (b_zz - (trace(b, a) + b_zz) / 3.0)
        return p

    def energy(self, f, past, a):
        """ψ and G/2 (tr b − 3) of the branches, J per reference volume."""
        found, volume = law_energy(self.law, f, a), dilation(f, a)
        for n in range(len(self.branches)):
            b, b_zz = elastic_part(f, past.branches[n], volume, a)
            found += 0.5 * self.branches[n].shear * (trace(b, a) + b_zz - 3.0)
        return found


@long_helper
def relaxed(branch, f, metric, dt, a):
    """P of a branch in Pa by rows, and C_v⁻¹ − 1, after a step of ``dt`` s in which it has relaxed."""
    volume = dilation(f, a)
    b, b_zz = elastic_part(f, metric, volume, a)
    mean, left = (trace(b, a) + b_zz) / 3.0, np.exp(-dt / branch.time)
    s, s_zz = scale(less_diagonal(b, mean, a), left), only_in_plane((b_zz - mean) * left, a)
    return nominal(scale(s, branch.shear), f, volume, a), history_of(s, s_zz, f, volume, a)


def all_relaxed(branches, metrics, p, f, dt, a):
    """P with that of all ``branches``, and the histories: those that no branch of this solid has stay."""
    kept = list(metrics)
    for n, branch in enumerate(branches):
        more, kept[n] = relaxed(branch, f, metrics[n], dt, a)
        p = add(p, more)
    return p, tuple(kept)


@overload_inside(all_relaxed)
def _typed_all_relaxed(branches, metrics, p, f, dt, a):
    own = range(len(branches))
    lines = [f"more_{n}, now_{n} = relaxed(branches[{n}], f, metrics[{n}], dt, a)" for n in own]
    lines += [f"p = add(p, more_{n})" for n in own]
    kept = (f"now_{n}" if n in own else f"metrics[{n}]" for n in range(len(metrics)))
    returned = f"return p, {tuple_of(kept)}"
    return unrolled("branches, metrics, p, f, dt, a", *lines, returned, relaxed=relaxed, add=add)
