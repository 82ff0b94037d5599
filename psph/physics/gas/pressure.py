"""The pressure of an ideal gas, with both smoothing lengths of a pair."""

from typing import Any, NamedTuple

from psph.acts import IDEAL_GASES
from psph.engine.jit import call_by_type, overload, unrolled
from psph.formula import helper
from psph.physics.facts import Facts
from psph.smoothing import slope_over_r, unit_kernel
from psph.vectors import scale


def power_of_slope(a, x):
    """a^(d + 2), d the length of the vector ``x``."""
    return a ** (len(x) + 2)


@overload(power_of_slope)
def _typed_power_of_slope(a, x):
    return unrolled("a, x", f"return {' * '.join(['a'] * (len(x) + 2))}")


@helper
def slope_by(kernel, inverse, pair):
    """W′(r, h)/r by a ``kernel`` whose own h is 1 m, 1/m^(d + 2); ``inverse`` is 1/h, 1/m."""
    return slope_over_r(kernel, pair.r * inverse, pair.inverse_r / inverse) * power_of_slope(
        inverse, pair.x_ij
    )


@helper
def even_slopes(kernel, i, j, pair):
    """m_j W′(h_i)/(r Ω_i) and m_j W′(h_j)/(r Ω_j), never above 0, so that friction heats, kg/m^(d + 2)."""
    own = i.evenness * slope_by(kernel, i.inverse_length, pair)
    other = j.evenness * slope_by(kernel, j.inverse_length, pair)
    return j.mass * own, j.mass * other


class OfOneMass(NamedTuple):
    """Slopes m_j f_ij W′(h_i)/r and m_j f_ji W′(h_j)/r where all have one mass: f_ij = 1/Ω_i."""

    kernel: Any

    def slopes(self, i, j, pair):
        """Both, kg/m^(d + 2)."""
        return even_slopes(self.kernel, i, j, pair)


class OfUnlikeMasses(NamedTuple):
    """The same of any masses, m_j f_ij = m_j − q_i: neighbours by number."""

    kernel: Any

    def slopes(self, i, j, pair):
        """Both, kg/m^(d + 2)."""
        own = (j.mass - i.unequal) * slope_by(self.kernel, i.inverse_length, pair)
        other = (j.mass - j.unequal * (j.mass / i.mass)) * slope_by(self.kernel, j.inverse_length, pair)
        return own, other


both_slopes = call_by_type("slopes")
"""(form, i, j, pair) → m_j f_ij W′(h_i)/r and m_j f_ji W′(h_j)/r."""


def slopes_in(scene: Facts) -> OfOneMass | OfUnlikeMasses:
    """The form of both slopes in a ``scene``, with its kernel for h = 1 m."""
    masses = {one.mass for one in scene.species}
    alike = len(masses) == 1 and all(one.one_mass for one in scene.species)
    return (OfOneMass if alike else OfUnlikeMasses)(unit_kernel(scene.kernel, scene.dimensions))


class GasPressure(NamedTuple):
    """The pressure of an ideal gas, for particles of any sizes and masses.

    a_i = −Σ_j m_j [f_ij p_i/ρ_i² ∇W(h_i) + f_ji p_j/ρ_j² ∇W(h_j)], f_ij = 1 − q_i/m_j,
    q_i = h_i/(d n_i Ω_i) ∂ρ_i/∂h_i: what follows from the energy of particles whose h_i = η n_i^(−1/d) moves
    with the number n_i of their neighbours.  Springel & Hernquist (2002), MNRAS 333, 649; Hopkins (2013),
    MNRAS 428, 2840.  With :class:`psph.physics.gas.heat.GasHeat` it conserves energy.
    """

    acts = (IDEAL_GASES,)
    conserves = ("momentum", "angular momentum")

    form: Any = None

    def in_scene(self, scene: Facts):
        """With slopes by the masses of the scene."""
        return GasPressure(slopes_in(scene))

    def push(self, i, j, pair):
        """Acceleration, m/s²."""
        own, other = both_slopes(self.form, i, j, pair)
        p_i = i.pressure * i.specific_volume * i.specific_volume
        p_j = j.pressure * j.specific_volume * j.specific_volume
        return scale(pair.x_ij, -(p_i * own + p_j * other))
