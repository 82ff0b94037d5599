"""What a softening that follows sizes adds to the forces between particles of a gas."""

from typing import Any, NamedTuple

from psph.acts import MATTER
from psph.fields import Field, Same
from psph.physics.facts import Facts
from psph.physics.gas.pressure import slope_by
from psph.physics.self_gravity import BY_SIZE, SelfGravity
from psph.smoothing import unit_kernel
from psph.vectors import scale

DEEPENING = Field(
    "softening_change", "m5/s2", "how the depth of a particle's pull grows with its number", image=Same
)
"""Y_i = h_i/(d n_i Ω_i) G Σ_j m_j D(r_ij/H_i)/H_i², D the function growing_depth of self_gravity."""


class SofteningChange(NamedTuple):
    """Softening lengths of a gas change with its density, and with them the energy of its own pull.

    a_i = Σ_j [Y_i ∇W(h_i) + (m_j/m_i) Y_j ∇W(h_j)], Y_i = h_i/(d n_i Ω_i) ∂φ_i/∂h_i, φ_i = −G Σ_j m_j
    f(H_i): what follows from the energy ½ Σ_i m_i φ_i as h_i follows n_i.  Price & Monaghan (2007), MNRAS
    374, 1347."""

    acts = MATTER
    refuses = SelfGravity.refuses

    constant: float
    softening: float | str
    method: str = ""
    accuracy: float = 0.0

    def in_scene(self, scene: Facts):
        """With the kernel for h = 1 m, where softening goes by size."""
        if self.softening != BY_SIZE:
            return None
        return ChangingSoftening(unit_kernel(scene.kernel, scene.dimensions))

    def why_absent(self, scene: Facts):
        """Why it is not there."""
        return "softening is the same for all"


class ChangingSoftening(NamedTuple):
    """Softening lengths of a gas change with its density.

    :class:`SofteningChange` with its kernel for h = 1 m.
    """

    conserves = ("momentum", "angular momentum")

    kernel: Any

    def push(self, i, j, pair):
        """Acceleration, m/s²."""
        own = i.softening_change * slope_by(self.kernel, i.inverse_length, pair)
        other = j.softening_change * slope_by(self.kernel, j.inverse_length, pair)
        return scale(pair.x_ij, own + (j.mass / i.mass) * other)
