"""What particles of an ideal gas carry, how they move, and their law."""

from typing import NamedTuple

import numpy as np

from psph.fields import GAS, OF_SCENE, Field, Same

LENGTH = OF_SCENE[0]
"""h, which is η n^(−1/d) of each particle."""

LISTED_LENGTH = Field("listed_length", "m", "smoothing length when the neighbour list was built")

INVERSE_LENGTH = Field("inverse_length", "1/m", "one over the smoothing length of a gas", image=Same)
"""A pair's forces would else divide by h once for each neighbour."""

UNEQUAL = Field(
    "unequal",
    "kg",
    "q, by which neighbours count as other masses where the smoothing length varies",
    image=Same,
)
"""q_i = h_i/(d n_i Ω_i) ∂ρ_i/∂h_i: m_j f_ij = m_j − q_i (Hopkins 2013)."""

EVENNESS = Field("evenness", "1", "1/Ω, f_ij among particles of one mass", image=Same)
"""1/Ω_i, always above 0, as f_ij among unlike masses is not."""

SOUND = Field("sound", "m/s", "speed of sound of a gas, √(γp/ρ), as the forces read it", image=Same)

HEAT = Field("thermal_energy", "J/kg", "thermal energy by mass", saved=True, evolves=True, image=Same)

SIGNAL = Field("signal_speed", "m/s", "fastest signal between a particle of a gas and its neighbours")

COMPRESSION = Field("velocity_divergence", "1/s", "divergence of the velocity of a gas, of the last pass")

ROTATION = Field("vorticity_size", "1/s", "size of the vorticity of a gas, of the last pass")

EARLIER = Field("earlier_divergence", "1/s", "divergence of the velocity of a gas one step before")

SHOCKED = Field("shocked", "1", "how near a shock a particle of a gas is or has been", start=1.0)
"""s, 1 in a shock: what is left of it falls as sound crosses the support."""

SHARE = Field(
    "viscosity_share", "1", "share of the viscosity of shocks that a particle has", start=1.0, image=Same
)

OF_SWITCH = (EARLIER, SHOCKED, SHARE)
"""What their work fills where viscosity is not the same everywhere."""

OF_GASES = (LENGTH, INVERSE_LENGTH, LISTED_LENGTH, UNEQUAL, EVENNESS, SOUND)
"""What their work fills."""


class Gaseous(NamedTuple):
    """Particles move as forces have them, and have sizes."""

    kind = GAS
    goes_free = True
    is_free = True


class OfHeat(NamedTuple):
    """The law of an ideal gas, p = (γ − 1) ρ u: density and pressure alone do not tell each other.

    In kick and drift it stands for that gas at the speed of sound of its start; the pressure that forces read
    is found with the density from u (psph.simulation.gas).
    """

    gamma: float

    def pressure(self, density, rest_density, sound_speed):
        """p = c²ρ/γ, Pa."""
        return sound_speed * sound_speed * density / self.gamma

    def density(self, pressure, rest_density, sound_speed):
        """That of the start, kg/m³, whatever the pressure."""
        return rest_density + 0.0 * pressure

    def energy(self, density, rest_density, sound_speed):
        """None by density, J/kg: heat is booked by itself."""
        return np.zeros_like(density)


LONGEST = Field(
    "longest_step", "s", "longest step that a particle of a gas and its neighbours bear", start=np.inf
)

EARLIER_LENGTH = Field("earlier_length", "m", "smoothing length at the end of a particle's step before")

GROWTH_RATE = Field("length_growth", "1/s", "relative rate of a smoothing length in the step before")

OF_OWN_STEPS = (LONGEST, EARLIER_LENGTH, GROWTH_RATE)
"""What their work fills where particles take steps of their own."""
