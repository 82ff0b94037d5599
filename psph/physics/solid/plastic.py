"""Plasticity of metals in total Lagrangian solids: the law, how hard it yields, and what it remembers.

C_p⁻¹, the inverse of the plastic part of C = FᵀF, is the history.  It is symmetric, turns with nothing, and
gives the elastic strain whatever the turn of the solid: with J = det F

    b = J^{−2/3} F C_p⁻¹ Fᵀ,   τ = τ_m(J) 1 + μ dev b,   P = τ F⁻ᵀ,

τ_m by psph.physics.solid.compression: K/2 (J² − 1), or −J times the pressure of Mie and Grüneisen.

Where q = √(3/2) |μ dev b| exceeds the yield stress Y, the stress returns along a ray:

    q − 3μ̄ Δε = Y(ε + Δε),   μ̄ = μ tr b/3,   dev b ← (1 − 3μ̄ Δε/q) dev b,

with the trace of b such that det b = 1, and C_p⁻¹ = J^{2/3} F⁻¹ b F⁻ᵀ.  In 2D, plane strain, b_zz counts.
Simo & Hughes (1998), Computational Inelasticity, box 9.1; the trace as in Simo & Miehe (1992), Comput.
Methods Appl. Mech. Eng. 98, 41.
"""

from typing import Any, NamedTuple

import numpy as np

from psph.engine.jit import call_by_type
from psph.fields import SYMMETRIC, Field, Same
from psph.physics.solid.compression import mean_stress, pressed, stored_by
from psph.physics.solid.history import History
from psph.physics.solid.plane import thinned
from psph.physics.solid.strain import dilation, elastic_part, history_of, nominal, only_in_plane
from psph.vectors import less_diagonal, norm_squared, scale, trace

PLASTIC_METRIC = Field("plastic_metric", "1", "C_p⁻¹ − 1, the history of a solid that yields", SYMMETRIC)
PLASTIC_STRAIN = Field("plastic_strain", "1", "equivalent plastic strain of a solid", saved=True, image=Same)
PLASTIC_WORK = Field("plastic_work", "J/m3", "work that has gone into plastic strain, by volume at the start")

OF_PLASTIC = (PLASTIC_METRIC, PLASTIC_STRAIN, PLASTIC_WORK)
"""What particles carry only where a solid yields."""

TURNS = 60
"""The most steps in which a yield stress that depends on the rate is found; five or six are usual."""

CLOSE = 1e-13
"""Of the trial stress: how well it is found."""


class LinearHardening(NamedTuple):
    """Y = σ_y + Hε, Pa: the ``yield_stress`` grows by ``hardening`` H with the plastic strain ε."""

    yield_stress: float
    hardening: float

    def strength(self, strain, rate, work):
        """Y at the plastic ``strain``, Pa."""
        return self.yield_stress + self.hardening * strain

    def increment(self, q, stiffness, past, dt):
        """Δε of a trial stress ``q`` in Pa that falls by ``stiffness`` Δε, Pa."""
        return (q - strength(self, past.strain, 0.0, past.work)) / (stiffness + self.hardening)


class JohnsonCook(NamedTuple):
    """Y = (A + Bεⁿ)(1 + C ln max(ε̇, 1))(1 − T*^m), T* = (T − T₀)/``melting`` from 0 to 1, ε̇ in 1/s.

    Adiabatic: T = T₀ + ``heated`` W, with the plastic work W in J/m³ and ``heated`` in K m³/J, 0.9 of the
    work as heat; T of the step before, ε̇ = Δε/Δt of this one.  Johnson & Cook (1983), Proc. 7th Int. Symp.
    Ballistics, 541.
    """

    yield_stress: float
    hardening: float
    exponent: float
    rate: float
    softening: float
    melting: float
    heated: float

    def strength(self, strain, rate, work):
        """Y at the plastic ``strain``, its ``rate`` in 1/s and after the plastic ``work`` in J/m³, Pa."""
        cold = self.yield_stress + self.hardening * strain**self.exponent
        fast = 1.0 + self.rate * np.log(max(rate, 1.0))
        warm = min(self.heated * work / self.melting, 1.0)
        return cold * fast * (1.0 - warm**self.softening)

    def increment(self, q, stiffness, past, dt):
        """Δε of a trial stress ``q`` in Pa that falls by ``stiffness`` Δε: a root between 0 and
        q/stiffness, by false position (Illinois), since Y grows with Δε."""
        per_time = 1.0 / dt if dt > 0.0 else 0.0
        low, high = 0.0, q / stiffness
        over = q - strength(self, past.strain, 0.0, past.work)
        under = -strength(self, past.strain + high, high * per_time, past.work)
        found, side = low, 0
        for _ in range(TURNS):
            found = (low * under - high * over) / (under - over)
            off = q - stiffness * found - strength(self, past.strain + found, found * per_time, past.work)
            if abs(off) <= CLOSE * q:
                break
            if off > 0.0:
                low, over = found, off
                under = 0.5 * under if side > 0 else under
                side = 1
            else:
                high, under = found, off
                over = 0.5 * over if side < 0 else over
                side = -1
        return found


increment = call_by_type("increment")
"""(strength, q, stiffness, past, dt) → Δε."""
strength = call_by_type("strength")
"""(strength, strain, rate, work) → Y, Pa."""


class Metal(NamedTuple):
    """Hooke's law for the elastic part of large deformations, and a yield stress: see above.

    ``compression`` says how it resists a change of volume (psph.physics.solid.compression), ``yielding`` how
    hard it yields; ``shear`` μ in Pa.
    """

    compression: Any
    shear: float
    yielding: Any

    def flow(self, f, past, dt, a):
        """P in Pa by rows after a step of ``dt`` s with the deformation ``f``, and the new History."""
        volume = dilation(f, a)
        b, b_zz = elastic_part(f, past.metric, volume, a)
        mean = (trace(b, a) + b_zz) / 3.0
        s, s_zz = scale(less_diagonal(b, mean, a), self.shear), self.shear * only_in_plane(b_zz - mean, a)
        size2 = norm_squared(s, a) + s_zz * s_zz
        q = np.sqrt(1.5 * size2)
        before = past.work
        if q > strength(self.yielding, past.strain, 0.0, past.work):
            stiffness = 3.0 * self.shear * mean
            more = max(increment(self.yielding, q, stiffness, past, dt), 0.0)
            left = max(1.0 - stiffness * more / q, 0.0)
            s, s_zz = scale(s, left), s_zz * left
            b, b_zz = scale(s, 1.0 / self.shear), s_zz / self.shear
            metric = history_of(b, b_zz, f, volume, a)
            work = past.work + more * (q - stiffness * more)
            past = History(metric, past.strain + more, work, past.heat, past.branches)
        swells, heat = pressed(self.compression, volume, past.heat, past.work - before, dt)
        past = History(past.metric, past.strain, past.work, heat, past.branches)
        return nominal(less_diagonal(s, -swells, a), f, volume, a), past

    def stress(self, f, past, a):
        """P in Pa by rows at what it remembers."""
        volume = dilation(f, a)
        b, b_zz = elastic_part(f, past.metric, volume, a)
        mean = (trace(b, a) + b_zz) / 3.0
        s = scale(less_diagonal(b, mean, a), self.shear)
        swells = mean_stress(self.compression, volume, past.heat)
        return nominal(less_diagonal(s, -swells, a), f, volume, a)

    def across(self, f, past, a):
        """P along z in plane strain, Pa."""
        volume = dilation(f, a)
        b, b_zz = elastic_part(f, past.metric, volume, a)
        mean = (trace(b, a) + b_zz) / 3.0
        return mean_stress(self.compression, volume, past.heat) + self.shear * (b_zz - mean)

    def energy(self, f, past, a):
        """What is stored in the volume, and μ/2 (tr b − 3), J per reference volume."""
        volume = dilation(f, a)
        b, b_zz = elastic_part(f, past.metric, volume, a)
        squeezed = stored_by(self.compression, volume, past.heat)
        return squeezed + 0.5 * self.shear * (trace(b, a) + b_zz - 3.0)


law_stress, law_across, law_energy = map(call_by_type, ("stress", "across", "energy"))


class Lasting(NamedTuple):
    """An elastic ``law`` (psph.physics.solid.laws) beside laws with a memory: it remembers nothing."""

    law: Any

    def flow(self, f, past, dt, a):
        """P in Pa by rows, and the same History."""
        return law_stress(self.law, f, a), past

    def stress(self, f, past, a):
        """P in Pa by rows."""
        return law_stress(self.law, f, a)

    def across(self, f, past, a):
        """P along z in plane strain, Pa."""
        return law_across(self.law, f, a)

    def energy(self, f, past, a):
        """ψ, J per reference volume."""
        return law_energy(self.law, f, a)

    def thinned(self, f, a):
        """Its thickness over that at the start."""
        return thinned(self.law, f, a)
