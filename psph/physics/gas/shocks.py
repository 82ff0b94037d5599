"""What broadens shocks of an ideal gas: viscosity, and the fastest signal."""

from typing import Annotated, Any, NamedTuple

from pydantic import Field

from psph.acts import IDEAL_GASES
from psph.formula import helper, where
from psph.physics.facts import Facts
from psph.physics.gas.pressure import even_slopes, slope_by
from psph.physics.gas.state import SIGNAL
from psph.smoothing import unit_kernel
from psph.vectors import scale


@helper
def approach(i, j, pair):
    """μ = min(0, u_ij·r̂), m/s, and 1/ρ̄, ρ̄ the mean of both densities, m^d/kg: by one division."""
    both = i.specific_volume + j.specific_volume
    inverse = 1.0 / (pair.r * both)
    mu = min(pair.u_dot_x * (both * inverse), 0.0)
    return mu, 2.0 * i.specific_volume * j.specific_volume * (pair.r * inverse)


@helper
def shock_pressure(alpha, beta, i, j, pair):
    """ν = (−α c̄ μ + β μ²)/ρ̄, m^(d + 2)/(kg s²): 0 where a pair parts."""
    mu, volume = approach(i, j, pair)
    return (beta * mu - 0.5 * alpha * (i.sound + j.sound)) * mu * volume


@helper
def share(i, j):
    """½(σ_i + σ_j), the share of the viscosity that a pair has (psph.physics.gas.switch), 1."""
    return 0.5 * (i.viscosity_share + j.viscosity_share)


@helper
def mean_slope(kernel, i, j, pair):
    """m_j W̄′/r, the mean of both slopes of a pair, kg/m^(d + 2)."""
    own, other = even_slopes(kernel, i, j, pair)
    return 0.5 * (own + other)


def switches(viscosity) -> bool:
    """Whether particles have unlike shares of the ``viscosity`` of a case; None where it has none."""
    return viscosity is not None and viscosity.least < 1.0


class ShockViscosity(NamedTuple):
    """Friction of gas that runs together: it makes shocks a few smoothing lengths wide.

    a_i = −Σ_j m_j ν_ij ∇W̄, ν = (−α c̄ μ + β μ²)/ρ̄, μ = min(0, u_ij·r̂); ∇W̄ the mean of ∇W(h_i)/Ω_i and
    ∇W(h_j)/Ω_j.  With ``least`` below 1 a switch takes it off where nothing shocks
    (:class:`psph.physics.gas.switch.FlowOfGas`).  The heat that it makes is in
    :class:`psph.physics.gas.heat.GasHeat`.  Monaghan (1997), J. Comput. Phys. 136, 298; Price (2012), J.
    Comput. Phys. 231, 759.
    """

    acts = (IDEAL_GASES,)
    conserves = ("momentum", "angular momentum")

    alpha: Annotated[
        float, Field(ge=0, description="coefficient α of c", json_schema_extra={"unit": "1"})
    ] = 1.0
    beta: Annotated[
        float, Field(ge=0, description="coefficient β of the approach", json_schema_extra={"unit": "1"})
    ] = 2.0
    least: Annotated[
        float,
        Field(
            ge=0,
            le=1,
            description="share of both that is left where nothing shocks: 1 constant, 0 a switch",
            json_schema_extra={"unit": "1"},
        ),
    ] = 1.0

    def in_scene(self, scene: Facts):
        """With the kernel for h = 1 m."""
        form = SwitchedViscosity if switches(self) else KernelViscosity
        return form(self.alpha, self.beta, unit_kernel(scene.kernel, scene.dimensions))


class KernelViscosity(NamedTuple):
    """Friction of gas that runs together, as where shocks are; `kernel` is that for h = 1 m."""

    conserves = ShockViscosity.conserves

    alpha: float
    beta: float
    kernel: Any

    def push(self, i, j, pair):
        """Acceleration, m/s²."""
        nu = shock_pressure(self.alpha, self.beta, i, j, pair)
        return scale(pair.x_ij, -nu * mean_slope(self.kernel, i, j, pair))


class SwitchedViscosity(NamedTuple):
    """Friction of gas that runs together, little of it where nothing shocks: of a pair by both its shares."""

    conserves = ShockViscosity.conserves

    alpha: float
    beta: float
    kernel: Any

    def push(self, i, j, pair):
        """Acceleration, m/s²."""
        nu = share(i, j) * shock_pressure(self.alpha, self.beta, i, j, pair)
        return scale(pair.x_ij, -nu * mean_slope(self.kernel, i, j, pair))


class FastestSignal(NamedTuple):
    """The fastest signal between a particle and its neighbours, which sets the time step.

    v = max_j (c_i + c_j − 3μ), of all j within either support.  Springel (2005), MNRAS 364, 1105.
    """

    acts = (IDEAL_GASES,)

    kernel: Any = None

    writes = SIGNAL

    def in_scene(self, scene: Facts):
        """With the kernel for h = 1 m."""
        return FastestSignal(unit_kernel(scene.kernel, scene.dimensions))

    def start(self, i):
        """No neighbour yet: 2c_i, m/s."""
        return 2.0 * i.sound

    def gather(self, total, i, j, pair):
        """The faster of what is known and a neighbour's, m/s."""
        own = slope_by(self.kernel, i.inverse_length, pair)
        other = slope_by(self.kernel, j.inverse_length, pair)
        mu, _ = approach(i, j, pair)
        between = i.sound + j.sound - 3.0 * mu
        return max(total, where(own + other < 0.0, between, 0.0))

    def join(self, a, b):
        """The faster of two, m/s."""
        return max(a, b)

    def finish_value(self, total, i, kernel):
        """v, m/s."""
        return total
