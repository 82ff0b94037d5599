"""Particles that step aside to stay in order."""

from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from psph.acts import FLUIDS, MADE_FOR_FLUIDS, SOILS
from psph.fields import VECTOR, Turned
from psph.fields import Field as Declared
from psph.formula import helper, where
from psph.moments import first_moment
from psph.physics.facts import Facts
from psph.physics.fluid.buffers import Buffers, NoBuffers, buffers_of, stands_behind
from psph.physics.fluid.cells import Cells, OneEach, cells_of, sharing
from psph.physics.roles import ORDER
from psph.physics.walls.conditions import BEARING, MIRROR
from psph.smoothing import slope_over_r, weight
from psph.vectors import add, dot, scale, zero_like

CROWDING = 0.2
"""Weight R of the term that keeps pairs from clumping (Monaghan 2000)."""

SURFACE = 0.85
"""Kernel sum below which a particle counts as surface."""

NEAR_SURFACE = 0.7
"""Part of a full neighbourhood, by its first moment, below which a position shift stops: the row of
a surface has 0.64, the next one 0.94."""

LEAST = 1e-12
"""Floor of (V W(dx))⁴, for a kernel that hardly reaches the nearest particle."""


CROWDED = Declared("crowding", "1", "h times the gradient of how crowded it is", VECTOR, image=Turned)


class ParticleShifting(NamedTuple):
    """Particles shift from where they crowd to where they are few.

    δx_i = −2 U Δt h Σ_j m_j/ρ_j [1 + 0.2 (W_ij/W(dx))⁴] ∇W_ij, U a part of the speed of sound, and
    |δx_i| ≤ U Δt; none where the kernel sum, the particle included, is below 0.85.  Velocity and
    density change to those at the new place: du_i/dt = (δx_i/Δt·∇)u, dρ_i/dt = δx_i/Δt·∇(ρ − ρ₀), with
    gradients from differences.  Lind, Xu, Stansby & Rogers (2012), J. Comput. Phys. 231, 1499; Sun,
    Colagrossi, Marrone & Zhang (2017), Comput. Methods Appl. Mech. Eng. 315, 25.  The sum is that
    of the pass before.  Walls stay, and so does their density.  Momentum and angular momentum are not
    conserved exactly.
    """

    refuses = MADE_FOR_FLUIDS

    roles = (ORDER,)

    strength: Annotated[
        float,
        Field(
            ge=0,
            le=1,
            description="U over the speed of sound; 0.1: U is the largest speed",
            json_schema_extra={"unit": "1"},
        ),
    ] = 0.1

    writes = CROWDED
    lagged = True

    def start(self, i):
        """Kernel sum, Σ V ∇W and Σ V (WV)⁴ ∇W."""
        return 0.0, zero_like(i.position), zero_like(i.position)

    def gather(self, total, i, j, pair):
        """Take neighbour j into all three."""
        volume = j.mass * j.specific_volume
        share = pair.w * volume
        gradient = scale(pair.x_ij, j.specific_volume * pair.m_dw_r)
        return total[0] + share, add(total[1], gradient), add(total[2], scale(gradient, share**4))

    def finish_value(self, total, i, kernel):
        """h Σ_j V_j [1 + 0.2 (W/W(dx))⁴] ∇W, zero at a surface; dx from the particle's volume."""
        volume = i.mass * i.specific_volume
        spacing = volume ** (1.0 / len(i.position))
        near = max((weight(kernel, spacing) * volume) ** 4, LEAST)
        inside = where(total[0] + weight(kernel, 0.0) * volume < SURFACE, 0.0, 1.0)
        crowding = add(total[1], scale(total[2], CROWDING / near))
        return scale(crowding, inside * i.smoothing_length * i.is_fluid)

    def displacement(self, i, dt):
        """δx, m; proportional to Δt."""
        return scale(_velocity(self.strength * i.sound_speed, i), dt)

    def shear(self, i, j, pair):
        """Coefficient of u_ij in (δx/Δt·∇)u, 1/s."""
        along = dot(_velocity(self.strength * i.sound_speed, i), pair.x_ij)
        return -j.specific_volume * pair.m_dw_r * along

    def density_rate(self, i, j, pair):
        """One neighbour's share of δx/Δt·∇(ρ − ρ₀), kg/(m^d s)."""
        along = dot(_velocity(self.strength * i.sound_speed, i), pair.x_ij)
        level = 1.0 / i.specific_volume + (j.rest_density - i.rest_density)
        excess = 1.0 - j.specific_volume * level
        return excess * pair.m_dw_r * along


class PositionShift(NamedTuple):
    """Particles shift from where they crowd to where they are few, with unchanged velocity.

    δx_i = −2 U Δt h Σ_j m_j/ρ_j [n + 0.2 n⁴] ∇W_ij, |δx_i| ≤ U Δt, n = m_j/ρ_j W′/r over what it is at
    dx on the lattice.  None where −Σ_j m_j/ρ_j r W′ is below 0.7 of what it is on the lattice.  U is no
    larger than the largest speed of the flow: still water is left alone, where the shift of a constant U
    would stir a lattice under tension.  What stands behind an open end counts as missing there: rows that
    step aside at its plane part, and stir an eddy that shuts it.  The weight n is psph's own: the usual 1
    also sees the rows that are missing above the second row of a surface, and would push that row outwards
    for ever (a rotating patch gains 1.5 % of angular momentum, with n 0.5 %).  Two spacings off n is 0.09.
    It is left out beside walls that bear no pressure: against them it pumps energy.
    Velocity and density go along unchanged, so that momentum is conserved to round-off.  Lind, Xu,
    Stansby & Rogers (2012), J. Comput. Phys. 231, 1499; Sun et al. (2017), Comput. Methods Appl.
    Mech. Eng. 315, 25.
    """

    acts = (FLUIDS, SOILS, *BEARING, MIRROR)
    refuses = MADE_FOR_FLUIDS

    roles = (ORDER,)

    conserves = ("momentum",)

    strength: Annotated[
        float,
        Field(
            ge=0,
            le=1,
            description="largest U over the speed of sound",
            json_schema_extra={"unit": "1"},
        ),
    ] = 0.1

    def in_scene(self, scene: Facts):
        """The shift that knows what a full neighbourhood sums up to."""
        if not all(one.bearing for one in scene.species):
            return None
        made = lattice_shift(self.strength, scene.kernel, scene.spacing, scene.dimensions)
        return made._replace(cells=cells_of(scene), buffers=buffers_of(scene))

    def why_absent(self, scene: Facts):
        """Why it has no form in the scene."""
        return "it pumps energy beside walls that bear no pressure"


class LatticeShift(NamedTuple):
    """Particles shift from where they crowd to where they are few, with unchanged velocity.

    The form of :class:`PositionShift` for the lattice of a scene, with or without ``buffers`` of open ends.
    ``full`` is Σ dx^d r W′ over the lattice of the start; ``near`` 1/(dx^d W′(dx)/dx), m².  Where particles
    share ``cells`` n is that of the cell of which each fills a part.
    """

    conserves = ("momentum",)

    strength: float
    full: float
    near: float
    cells: Cells = OneEach()
    buffers: Buffers = NoBuffers()

    writes = CROWDED
    lagged = True

    def start(self, i):
        """Σ V r W′ and Σ V [n + 0.2 n⁴] ∇W."""
        return 0.0, zero_like(i.position)

    def gather(self, total, i, j, pair):
        """Take neighbour j into both."""
        share = j.specific_volume * pair.m_dw_r
        n = share * (sharing(self.cells, j) * self.near)
        pull = share * n * (1.0 + CROWDING * n * (n * n))
        whole = share * pair.r2 * (1.0 - stands_behind(self.buffers, j))
        return total[0] + whole, add(total[1], scale(pair.x_ij, pull))

    def finish_value(self, total, i, kernel):
        """h Σ_j V_j [n + 0.2 n⁴] ∇W, zero near a surface."""
        inside = where(total[0] > NEAR_SURFACE * self.full, 0.0, 1.0)
        return scale(total[1], inside * i.smoothing_length)

    def displacement(self, i, dt):
        """δx, m; proportional to Δt."""
        return scale(_velocity(min(i.largest_speed, self.strength * i.sound_speed), i), dt)


def lattice_shift(strength: float, kernel, dx: float, dimensions: int) -> LatticeShift:
    """The shift of strength U/c on the row, square or cube lattice of spacing dx, m."""
    near = dx**dimensions * float(slope_over_r(kernel, dx, 1.0 / dx))
    return LatticeShift(strength, first_moment(kernel, dx, dimensions), 1.0 / near)


@helper
def _velocity(speed, i):
    """δx/Δt for U = ``speed``, m/s."""
    # Without a branch: with one here, numbers of ranks differed in the last bits.
    size = 2.0 * np.sqrt(dot(i.crowding, i.crowding))
    return scale(i.crowding, -2.0 * speed / max(size, 1.0))
