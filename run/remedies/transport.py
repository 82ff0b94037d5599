"""Remedies: particles that are carried by another velocity than that of the fluid.

Each stores ũ − u as ``transport``, from the sums of the pass before.  A case beside this file says
``use = ["transport.py"]``.
"""

from typing import Annotated, NamedTuple

from pydantic import Field

from psph.fields import VECTOR, Turned
from psph.fields import Field as Declared
from psph.formula import helper
from psph.physics.catalogue import Catalogue, Entry
from psph.physics.roles import CARRIER, ORDER
from psph.vectors import add, dot, scale, subtract, zero_like

HALF_STEP = 0.125
"""Half of the time step h/(4c) of Adami, Hu & Adams (2013), over h/c: the push acts so long."""

OWN_PRESSURE = 10.0
"""Largest background pressure over |p| of the particle (Zhang, Hu & Adams 2017)."""


TRANSPORT = Declared(
    "transport", "m/s", "velocity of the particle minus that of the fluid", VECTOR, image=Turned
)


def _conflicts(physics, kernel):
    """Stress points are moved with the velocity around them already."""
    if physics.pressure_gradient == "stress_points":
        yield (
            f'physics.pressure_gradient = "{physics.pressure_gradient}" moves half of the particles too; '
            "choose another form, or remove this key"
        )


def _no_neighbour(self, i):
    """No neighbour yet."""
    return zero_like(i.position)


def moved(self, i, dt):
    """(ũ − u) Δt, m."""
    return scale(i.transport, dt)


def _density_rate(self, i, j, pair):
    """What ũ − u adds to a neighbour's share of dρ_i/dt, kg/(m^d s)."""
    return pair.m_dw_r * dot(subtract(i.transport, j.transport), pair.x_ij)


def _carried(self, i, j, pair):
    """The momentum that particles carry along, m/s²."""
    own = i.specific_volume * dot(i.transport, pair.x_ij)
    other = j.specific_volume * dot(j.transport, pair.x_ij)
    carried = add(scale(i.velocity, own), scale(j.velocity, other))
    return scale(carried, pair.m_dw_r)


class XSPH(NamedTuple):
    """Particles move with the mean velocity around them: they do not pass through each other.

    dx_i/dt = ũ_i = u_i + ε Σ_j m_j/ρ̄_ij (u_j − u_i) W_ij over fluid neighbours; density follows ũ.
    Monaghan (1989), J. Comput. Phys. 82, 1; continuity as in Monaghan (1992), Annu. Rev. Astron.
    Astrophys. 30, 543.  Momentum and angular momentum are conserved, nothing is dissipated.
    """

    roles = (CARRIER,)

    conserves = ("momentum", "angular momentum")

    epsilon: Annotated[
        float,
        Field(ge=0, le=1, description="ε: part of the mean", json_schema_extra={"unit": "1"}),
    ] = 0.5

    writes = TRANSPORT
    lagged = True

    start = _no_neighbour
    displacement = moved
    density_rate = _density_rate

    def gather(self, total, i, j, pair):
        """Add m_j/ρ̄_ij (u_j − u_i) W_ij of a fluid neighbour."""
        v_i, v_j = i.specific_volume, j.specific_volume
        volume = 2.0 * j.mass * v_i * v_j / (v_i + v_j)
        return add(total, scale(pair.u_ij, -volume * pair.w * j.is_fluid))

    def finish_value(self, total, i, kernel):
        """ũ − u of a fluid particle, m/s."""
        return scale(total, self.epsilon * i.mobile)

    conflicts = staticmethod(_conflicts)


class TransportVelocity(NamedTuple):
    """A background pressure moves particles into order without accelerating the fluid.

    dx_i/dt = ũ_i = u_i − (h/8c) p_b Σ_j m_j (1/ρ_i² + 1/ρ_j²) ∇W_ij, h/8c half of the source's time
    step; density follows ũ, and a_i = Σ_j m_j (A_i/ρ_i² + A_j/ρ_j²)·∇W_ij, A = ρ u (ũ − u), carries
    momentum along.  Adami, Hu & Adams (2013), J. Comput. Phys. 241, 292, eqs. (8), (13); they take
    ρ from Σ m W, this one from (12) of Zhang, Hu & Adams (2017).  For closed domains: a free surface
    would fly apart.  Momentum is conserved, angular momentum is not.
    """

    roles = (ORDER, CARRIER)

    conserves = ("momentum",)

    background: Annotated[
        float, Field(ge=0, description="p_b over ρ₀c²", json_schema_extra={"unit": "1"})
    ] = 1.0

    writes = TRANSPORT
    lagged = True

    start = _no_neighbour
    displacement = moved
    density_rate = _density_rate
    push = _carried

    def gather(self, total, i, j, pair):
        """Add m_j (1/ρ_i² + 1/ρ_j²) ∇W_ij."""
        v_i, v_j = i.specific_volume, j.specific_volume
        return add(total, scale(pair.x_ij, (v_i * v_i + v_j * v_j) * pair.m_dw_r))

    def finish_value(self, total, i, kernel):
        """ũ − u of a fluid particle, m/s."""
        return _pushed(self.background * _stiffness(i), total, i)

    conflicts = staticmethod(_conflicts)

    @staticmethod
    def warns(scene):
        """A free surface flies apart."""
        if scene.has_free_surface:
            yield (
                "moves a free surface outwards, and the fluid has one; use "
                "physics.generalised_transport_velocity, or enclose the fluid"
            )


class GeneralisedTransportVelocity(NamedTuple):
    """A background pressure of each particle moves particles into order without accelerating the fluid.

    As :class:`TransportVelocity` with ũ_i = u_i − (h/8c) p_i⁰ Σ_j m_j/ρ_i² ∇W_ij, p_i⁰ =
    min(10|p_i|, p_b): at a free surface, where p is small, it fades.  Zhang, Hu & Adams (2017),
    J. Comput. Phys. 337, 216, eqs. (12), (17); theirs sums over half the support and renews the
    density now and then from Σ m W, this one does neither.
    """

    roles = (ORDER, CARRIER)

    conserves = ("momentum",)

    background: Annotated[
        float, Field(ge=0, description="largest p_b over ρ₀c²", json_schema_extra={"unit": "1"})
    ] = 1.0

    writes = TRANSPORT
    lagged = True

    start = _no_neighbour
    displacement = moved
    density_rate = _density_rate
    push = _carried

    def gather(self, total, i, j, pair):
        """Add m_j/ρ_i² ∇W_ij."""
        own = i.specific_volume * i.specific_volume
        return add(total, scale(pair.x_ij, own * pair.m_dw_r))

    def finish_value(self, total, i, kernel):
        """ũ − u of a fluid particle, m/s."""
        background = min(OWN_PRESSURE * abs(i.pressure), self.background * _stiffness(i))
        return _pushed(background, total, i)

    conflicts = staticmethod(_conflicts)


@helper
def _stiffness(i):
    """ρ₀c², Pa."""
    return i.rest_density * i.sound_speed * i.sound_speed


@helper
def _pushed(background, total, i):
    """−(h/8c) p_b Σ, m/s; 0 in a wall."""
    span = HALF_STEP * i.smoothing_length / i.sound_speed
    return scale(total, -span * background * i.is_fluid)


CATALOGUE = Catalogue(
    effects=(
        Entry("physics.xsph", XSPH),
        Entry("physics.transport_velocity", TransportVelocity),
        Entry("physics.generalised_transport_velocity", GeneralisedTransportVelocity),
    )
)
