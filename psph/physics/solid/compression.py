"""How metals resist a change of volume: the mean Kirchhoff stress, tension positive, and its energy.

A law has three methods of J = det F and of the :class:`Heat` that a particle remembers, None where no solid
of the scene asks for it:

    pressed(volume, heat, gained, dt)   → τ_m in Pa after a step of dt s in which plastic work or friction has
                                          ``gained`` J/m³, and the new Heat
    mean(volume, heat)                  → τ_m at what it remembers
    stored(volume, heat)                → energy, J per volume in the reference
"""

from typing import Any, NamedTuple

import numpy as np

from psph.engine.jit import call_by_type
from psph.fields import Field
from psph.formula import helper, where

INTERNAL_ENERGY = Field(
    "internal_energy", "J/m3", "energy of compression and heat of a metal, by volume at the start", saved=True
)
SWELLING = Field("swelling", "1", "J − 1 of a metal after its last step")

OF_HEAT = (INTERNAL_ENERGY, SWELLING)
"""What particles carry only where a solid has a pressure by Mie and Grüneisen."""

LINEAR, QUADRATIC = 0.5, 1.2
"""Of the friction of shocks: they are two or three spacings wide, and hardly ring."""


class Heat(NamedTuple):
    """The internal ``energy``, J/m³, and the ``swelling`` J − 1 that it has come with."""

    energy: Any
    swelling: Any


class EvenBulk(NamedTuple):
    """τ_m = K/2 (J² − 1), of the energy K/2 ((J² − 1)/2 − ln J): Simo & Hughes (1998), eq. 9.2.6.

    It needs no heat.  ``bulk`` K in Pa.
    """

    bulk: float

    def pressed(self, volume, heat, gained, dt):
        """τ_m, Pa, and the same Heat."""
        return 0.5 * self.bulk * (volume * volume - 1.0), heat

    def mean(self, volume, heat):
        """τ_m, Pa."""
        return 0.5 * self.bulk * (volume * volume - 1.0)

    def stored(self, volume, heat):
        """K/2 ((J² − 1)/2 − ln J), J/m³."""
        return 0.5 * self.bulk * (0.5 * (volume * volume - 1.0) - np.log(np.abs(volume)))


class MieGruneisen(NamedTuple):
    """p = ρ₀c²μ(1 + μ)/(1 − (S − 1)μ)² (1 − Γμ/2) + Γρe, μ = 1/J − 1; in tension ρ₀c²μ + Γρe.

    e per mass is the internal energy, of compression and of heat. Behind a shock p is on the Hugoniot
    curve of U_s = c + S u_p: p = ρ₀U_s u_p. The energy by volume in the reference, U = ρ₀e, follows the
    mean of both pressures of a step, U ← U − ½(p + p′)ΔJ − qΔJ + gained, so that energy is booked in
    full: p is linear in U, so that p′ is found at once. Where it is compressed a friction q = ρ(a cl ε̇ +
    b²l²ε̇²), ε̇ = −J̇/J, a = 0.5, b = 1.2, over the length l makes the entropy of a shock. ``density`` ρ₀
    in kg/m³, ``sound_speed`` c in m/s, ``slope`` S, ``gruneisen`` Γ, ``length`` l in m. Meyers, Dynamic
    Behavior of Materials (1994), ch. 4 and 5; the friction von Neumann & Richtmyer (1950), J. Appl. Phys.
    21, 232, and Landshoff (1955), Los Alamos LA-1930.
    """

    density: float
    sound_speed: float
    slope: float
    gruneisen: float
    length: float

    def pressed(self, volume, heat, gained, dt):
        """−Jp, Pa, and the new Heat."""
        before, change = 1.0 + heat.swelling, volume - 1.0 - heat.swelling
        old = cold(self, before) + self.gruneisen / before * heat.energy
        per_time = 1.0 / dt if dt > 0.0 else 0.0
        rate = max(-change * per_time / volume, 0.0)
        wide = self.length * rate
        friction = self.density / volume * wide * (LINEAR * self.sound_speed + QUADRATIC * QUADRATIC * wide)
        warm = self.gruneisen / volume
        energy = heat.energy + gained - (0.5 * (old + cold(self, volume)) + friction) * change
        energy = energy / (1.0 + 0.5 * warm * change)
        return -volume * (cold(self, volume) + warm * energy + friction), Heat(energy, volume - 1.0)

    def mean(self, volume, heat):
        """−Jp without friction, Pa."""
        return -volume * (cold(self, volume) + self.gruneisen / volume * heat.energy)

    def stored(self, volume, heat):
        """The internal energy, J/m³."""
        return heat.energy


@helper
def cold(law, volume):
    """The part of p without Γρe, Pa."""
    mu = 1.0 / volume - 1.0
    squeezed = max(mu, 0.0)
    under = 1.0 - (law.slope - 1.0) * squeezed
    curve = squeezed * (1.0 + squeezed) / (under * under) * (1.0 - 0.5 * law.gruneisen * squeezed)
    return law.density * law.sound_speed * law.sound_speed * where(mu > 0.0, curve, mu)


pressed = call_by_type("pressed")
"""(law, J, Heat, gained, Δt) → τ_m, Pa, and the new Heat."""
mean_stress = call_by_type("mean")
"""(law, J, Heat) → τ_m, Pa."""
stored_by = call_by_type("stored")
"""(law, J, Heat) → J/m³."""
