"""Which share of the viscosity a particle of an ideal gas has: all in a shock, little in smooth flow."""

from typing import Any, NamedTuple

import numpy as np

from psph.acts import IDEAL_GASES
from psph.formula import helper
from psph.physics.facts import Facts
from psph.physics.fluid.strain import linear_gradient, no_rate, take_rate
from psph.physics.gas.pressure import slope_by
from psph.physics.gas.shocks import switches
from psph.physics.gas.state import COMPRESSION, ROTATION
from psph.smoothing import unit_kernel
from psph.vectors import dot, skew_part, symmetric_part, trace

CALM = 1e-4
"""Balsara (1995): rates below this part of c/h are noise."""

DECAY = 0.05
"""ℓ of Borrow and others (2022): by what part of itself a share falls while sound crosses a support.
With 0.25, as their text has it, velocities in Sod's tube are 4 % worse, with 0.05 as good as without."""


class FlowOfGas(NamedTuple):
    """How a gas around a particle is compressed, and how it turns: for the switch of its viscosity.

    ∇·v and |∇×v| of G_i = Σ_j m_j u_ij ∇W(h_i)ᵀ (Σ_j m_j x_ij ∇W(h_i)ᵀ)⁻¹, exact where the flow is linear.
    Cullen & Dehnen (2010), MNRAS 408, 669.
    """

    acts = (IDEAL_GASES,)

    kernel: Any = None

    writes = (COMPRESSION, ROTATION)
    lagged = True

    def in_scene(self, scene: Facts):
        """With the kernel for h = 1 m, where particles have unlike shares of the viscosity."""
        if not switches(scene.physics.shock_viscosity):
            return None
        return FlowOfGas(unit_kernel(scene.kernel, scene.dimensions))

    def why_absent(self, scene: Facts):
        """Why it is not there."""
        return "the viscosity is the same everywhere (physics.shock_viscosity.least is 1), or there is none"

    def start(self, i):
        """No neighbour yet."""
        return no_rate(i)

    def gather(self, total, i, j, pair):
        """Take a neighbour."""
        weight = -j.mass * i.specific_volume * slope_by(self.kernel, i.inverse_length, pair)
        return take_rate(total, pair, pair.u_ij, weight, weight)

    def finish_value(self, total, i, kernel):
        """∇·v and |∇×v|, 1/s."""
        gradient = linear_gradient(total, i)
        turning = skew_part(gradient, i.position)
        return (
            trace(symmetric_part(gradient, i.position), i.position),
            np.sqrt(2.0 * dot(turning, turning)),
        )


@helper
def straight(divergence, rotation, sound, h):
    """Balsara's factor B = |∇·v|/(|∇·v| + |∇×v| + 1e-4 c/h): 1 in a shock, near 0 in shear."""
    size = abs(divergence)
    return size / (size + rotation + CALM * sound / h)


@helper
def nearness(divergence, steepens, sound, reach):
    """S/(c² + S), S = H² max(0, −d(∇·v)/dt) where ∇·v < 0: near 1 before and in a shock.

    ``steepens`` is −d(∇·v)/dt, 1/s², ``reach`` the support H, m.
    """
    s = reach * reach * max(0.0, steepens) if divergence < 0.0 else 0.0
    return s / (sound * sound + s)


@helper
def followed(shocked, found, sound, reach, dt):
    """s a step later: what is ``found`` where that is more, else it falls towards it by q = ℓ c Δt/H."""
    q = DECAY * sound * dt / reach
    return found if found > shocked else (shocked + q * found) / (1.0 + q)
