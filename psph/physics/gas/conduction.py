"""Conduction of heat in an ideal gas: it broadens contacts, where the pressure would have a blip."""

from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from psph.acts import IDEAL_GASES
from psph.engine.jit import call_by_type
from psph.formula import helper
from psph.physics.facts import Facts
from psph.physics.gas.shocks import approach
from psph.physics.gas.state import OfHeat


class HeatConduction(NamedTuple):
    """Heat spreads across contacts, where the pressure would have a blip.

    u̇_i = ½ α_u Σ_j m_j v (u_i − u_j) [W′(h_i)/(Ω_i ρ_i) + W′(h_j)/(Ω_j ρ_j)], v = √(|p_i − p_j|/ρ̄).  It keeps
    the energy of a pair, and acts where pressure is uneven: Price (2008), J. Comput. Phys. 227, 10040.  With
    gravity it is uneven at rest, and v = |u_ij·r̂|: Wadsley, Veeravalli & Couchman (2008), MNRAS 387, 427;
    Price and others (2018), PASA 35, e031.  Among unlike γ what spreads is p/ρ, which is even where nothing
    moves and densities are, in place of u.
    """

    acts = (IDEAL_GASES,)

    strength: Annotated[
        float, Field(ge=0, description="coefficient α_u", json_schema_extra={"unit": "1"})
    ] = 1.0


class OfPressure(NamedTuple):
    """Heat spreads as fast as an uneven pressure would push: without a pull contacts alone have that."""

    def speed(self, i, j, pair):
        """√(|p_i − p_j|/ρ̄), m/s."""
        _, volume = approach(i, j, pair)
        return np.sqrt(abs(i.pressure - j.pressure) * volume)


class OfMotion(NamedTuple):
    """Heat spreads as fast as a pair meets or parts: in balance with a pull not at all."""

    def speed(self, i, j, pair):
        """|u_ij·r̂|, m/s."""
        return abs(pair.u_dot_x) * pair.inverse_r


class OfOneGamma(NamedTuple):
    """What spreads is u."""

    def excess(self, i, j, pair):
        """u_i − u_j, J/kg."""
        return i.thermal_energy - j.thermal_energy


class OfUnlikeGamma(NamedTuple):
    """What spreads is p/ρ = (γ − 1) u, each pair with the harmonic mean of its 1/(γ − 1): by the plain one a
    gas of small γ, which has much heat, would set the pace."""

    def excess(self, i, j, pair):
        """Of p/ρ by the harmonic mean of u/(p/ρ), J/kg."""
        own, other = i.pressure * i.specific_volume, j.pressure * j.specific_volume
        return 2.0 * (own - other) / (own / i.thermal_energy + other / j.thermal_energy)


class Conduction(NamedTuple):
    """That of a scene: its ``strength``, by which ``speeds``, and what spreads, the ``heats``."""

    strength: float
    speeds: OfPressure | OfMotion
    heats: OfOneGamma | OfUnlikeGamma


def conduction_in(scene: Facts) -> Conduction:
    """The conduction of a ``scene``, of no strength where it has none."""
    physics = scene.physics
    pulled = physics.self_gravity or physics.central_force or any(scene.gravity)
    gammas = {one.law.gamma for one in scene.species if isinstance(one.law, OfHeat)}
    return Conduction(
        physics.heat_conduction.strength if physics.heat_conduction else 0.0,
        OfMotion() if pulled else OfPressure(),
        OfOneGamma() if len(gammas) < 2 else OfUnlikeGamma(),
    )


_speed, _excess = call_by_type("speed"), call_by_type("excess")


@helper
def conduction(form, own, other, i, j, pair):
    """One neighbour's share of u̇_i by conduction, W/kg; ``own`` and ``other`` are even slopes."""
    both = own * i.specific_volume + other * j.specific_volume
    speed = _speed(form.speeds, i, j, pair)
    return 0.5 * form.strength * speed * _excess(form.heats, i, j, pair) * both * pair.r
