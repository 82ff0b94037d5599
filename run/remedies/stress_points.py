"""Remedy: stress points, where pressure and velocity live at different particles.

A case beside this file says ``use = ["stress_points.py"]``.
"""

from typing import NamedTuple

from psph.acts import SYMMETRY
from psph.fields import VECTOR, Field, Same, Turned
from psph.physics.catalogue import Catalogue, Entry
from psph.physics.fluid.pressure import UNEQUAL
from psph.physics.walls.conditions import MIRROR
from psph.physics.walls.slip import NO_FLUID
from psph.vectors import add, scale, zero_like

TWICE = 2.0
"""Each of the two sets has half of the particles, so that one of them counts for two."""

FOLLOWING = 2.0
"""h/c over the time in which a stress point takes the velocity around it."""

TRANSPORT = Field(
    "transport", "m/s", "velocity of the particle minus that of the fluid", VECTOR, image=Turned
)


def every_other(lattice, position):
    """1 on every other site of the lattice, 0 between."""
    return lattice.odd(position)


STRESS_POINT = Field(
    "stress_point",
    "1",
    "1 where pressure is borne, 0 where velocity is carried",
    start=every_other,
    image=Same,
)


class StressPoints(NamedTuple):
    """Pressure is computed at every other particle, a stress point, and moves the others.

    The sites of the lattice take turns.  A velocity point feels stress points s alone, a_i = −2 Σ_s
    m_s p_s/ρ_s² ∇W_is; one of these sees how velocity points v part, dρ_s/dt = 2 Σ_v m_v u_sv·∇W_sv, and
    moves with their mean ũ_s = Σ_v V_v u_v W_sv/Σ_v V_v W_sv; its own velocity follows, a_s = (2c/h)(ũ_s −
    u_s).  Walls take turns as well.  Dyka & Ingel (1995), Comput. Struct. 57, 573, in one dimension;
    Vignjevic, Campbell &
    Libersky (2000), Comput. Methods Appl. Mech. Eng. 184, 67.  Theirs are extra points; these are half
    of the particles, at twice the spacing in volume.  Momentum and energy are not conserved exactly.
    """

    refuses = UNEQUAL | dict.fromkeys(
        (MIRROR, SYMMETRY),
        "does not work with mirrors, which know no stress points; remove one of the two",
    )

    def density_rate(self, i, j, pair):
        """At a stress point what the sum over velocity points is more than that over all, kg/(m^d s)."""
        more = i.stress_point * (1.0 - TWICE * j.stress_point)
        return more * pair.u_dot_x * pair.m_dw_r

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration of a velocity point, 1/s²."""
        v_j, bearing = j.specific_volume, TWICE * j.stress_point * (1.0 - i.stress_point)
        return -bearing * (j.pressure * v_j * v_j) * pair.m_dw_r

    fixed = (STRESS_POINT,)
    writes = TRANSPORT
    lagged = True

    def displacement(self, i, dt):
        """(ũ − u) Δt, m."""
        return scale(i.transport, dt)

    def start(self, i):
        """Σ V W and Σ V (u_i − u_v) W over velocity points of the fluid."""
        return 0.0, zero_like(i.position)

    def gather(self, total, i, j, pair):
        """Take neighbour j into both."""
        share = j.is_fluid * (1.0 - j.stress_point) * j.mass * j.specific_volume * pair.w
        return total[0] + share, add(total[1], scale(pair.u_ij, share))

    def finish_acceleration(self, total, i):
        """What makes a stress point follow, m/s²."""
        rate = FOLLOWING * i.sound_speed / i.smoothing_length
        return scale(total[1], -rate * i.stress_point / max(total[0], NO_FLUID))

    def finish_value(self, total, i, kernel):
        """ũ − u of a stress point, m/s."""
        return scale(total[1], -i.stress_point / max(total[0], NO_FLUID))

    def longest_step(self, scene):
        """Δt ≤ h/(4c), s: half of the time in which a stress point follows."""
        return 0.5 * scene.smoothing_length / (FOLLOWING * scene.sound_speed)


CATALOGUE = Catalogue(effects=(Entry("physics.pressure_gradient=stress_points", StressPoints),))
