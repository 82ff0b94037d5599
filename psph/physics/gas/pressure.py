"""The pressure of an ideal gas, with both smoothing lengths of a pair."""

from typing import Any, NamedTuple

from psph.acts import IDEAL_GASES
from psph.engine.jit import overload, unrolled
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
def slope_by(kernel, h, pair):
    """W′(r, h)/r by a ``kernel`` whose own h is 1 m, 1/m^(d + 2)."""
    inverse = 1.0 / h
    return slope_over_r(kernel, pair.r * inverse, pair.inverse_r * h) * power_of_slope(inverse, pair.x_ij)


@helper
def both_slopes(kernel, i, j, pair):
    """m_j f_ij W′(h_i)/r and m_j f_ji W′(h_j)/r, with m_j f_ij = m_j − q_i: neighbours by number."""
    own = (j.mass - i.unequal) * slope_by(kernel, i.smoothing_length, pair)
    other = (j.mass - j.unequal * (j.mass / i.mass)) * slope_by(kernel, j.smoothing_length, pair)
    return own, other


class GasPressure(NamedTuple):
    """The pressure of an ideal gas, for particles of any sizes and masses.

    a_i = −Σ_j m_j [f_ij p_i/ρ_i² ∇W(h_i) + f_ji p_j/ρ_j² ∇W(h_j)], f_ij = 1 − q_i/m_j,
    q_i = h_i/(d n_i Ω_i) ∂ρ_i/∂h_i: what follows from the energy of particles whose h_i = η n_i^(−1/d) moves
    with the number n_i of their neighbours.  Springel & Hernquist (2002), MNRAS 333, 649; Hopkins (2013),
    MNRAS 428, 2840.  With :class:`psph.physics.gas.heat.GasHeat` it conserves energy.
    """

    acts = (IDEAL_GASES,)
    conserves = ("momentum", "angular momentum")

    kernel: Any = None

    def in_scene(self, scene: Facts):
        """With the kernel for h = 1 m."""
        return GasPressure(unit_kernel(scene.kernel, scene.dimensions))

    def push(self, i, j, pair):
        """Acceleration, m/s²."""
        own, other = both_slopes(self.kernel, i, j, pair)
        p_i = i.pressure * i.specific_volume * i.specific_volume
        p_j = j.pressure * j.specific_volume * j.specific_volume
        return scale(pair.x_ij, -(p_i * own + p_j * other))
