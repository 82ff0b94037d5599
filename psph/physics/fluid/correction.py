"""Sums over neighbours that are right for linear fields, whatever the order of the particles."""

from typing import Annotated, NamedTuple

from pydantic import Field

from psph.fields import SYMMETRIC, Same, Turned
from psph.fields import Field as Declared
from psph.formula import helper
from psph.moments import first_moment
from psph.physics.facts import Facts
from psph.physics.fluid.buffers import Buffers, NoBuffers, buffers_of, in_front
from psph.physics.fluid.cells import Cells, OneEach, cells_of, sharing
from psph.physics.fluid.parting import Hold, Holding, borne, felt, hold_of
from psph.physics.fluid.several import Facing, facing_of, in_volumes, several, shares
from psph.vectors import (
    add,
    adjugate,
    determinant,
    dot,
    less_diagonal,
    norm_squared,
    outer,
    scale,
    times,
    zero_like,
)

CORRECTED = ("symmetric", "difference")
"""Pressure gradients that work with a corrected kernel gradient."""

CORRECTION = Declared(
    "gradient_correction", "1", "correction of the kernel's gradient, L - 1", SYMMETRIC, image=Turned
)

SIZE = Declared("disorder", "1", "square of the size of L - 1", image=Same, asked=True)
"""Whoever looks at disorder alone fetches this number of each neighbour, and not the whole of its L."""


DISORDER = 0.2
"""Size t of L − 1 from which on particles are wholly in disorder, or at a surface."""

ROUGH = 0.5 / DISORDER**2
"""1/(2t²), as :func:`half_disorder` takes it."""


class GradientCorrection(NamedTuple):
    """Gradients are corrected to be exact for linear fields, in pressure and in continuity.

    ∇W_ij becomes L∇W_ij with L_i = (−Σ_j m_j/ρ_j x_ij ∇W_ijᵀ)⁻¹.  dρ_i/dt takes L_i, the symmetric
    pressure takes p_i/ρ_i² L_i + p_j/ρ_j² L_j, which conserves momentum and does exactly the work
    that compression takes.  Randles & Libersky (1996), Comput. Methods Appl. Mech. Eng. 139, 375;
    Bonet & Lok (1999), 180, 97.  Crossed, p_i L_j + p_j L_i (Zhang, Adams & Hu 2024,
    arXiv:2406.02576), it is exact for linear p in more places, and feeds on the difference of L
    beside a surface.  With D the determinant of the sum, L − 1 = (adjugate − D)/max(D, D₀), so that
    L fades to 1 where neighbours are missing.  L is that of the pass before.
    """

    conserves = ("momentum",)

    least: Annotated[
        float,
        Field(
            gt=0,
            le=1,
            description="D₀: the correction fades where the determinant is below it",
            json_schema_extra={"unit": "1"},
        ),
    ] = 0.5

    writes = CORRECTION, SIZE
    lagged = True
    slow = True

    def in_scene(self, scene: Facts):
        """The form that belongs to the scene's pressure gradient, and to its walls."""
        if scene.physics.pressure_gradient == "difference":
            return DifferenceCorrection(self.least)
        full = -first_moment(scene.kernel, scene.spacing, scene.dimensions) / scene.dimensions
        volume, walls, buffers = scene.spacing**scene.dimensions / full, hold_of(scene), buffers_of(scene)
        if several(scene):
            return VolumeCorrection(self.least, volume, facing_of(scene), walls, buffers)
        if all(one.is_fluid and one.mobile for one in scene.species):
            return self
        return CorrectionBesideWalls(self.least, volume, walls, cells_of(scene), buffers)

    def start(self, i):
        """No neighbour yet."""
        return outer(zero_like(i.position))

    def gather(self, total, i, j, pair):
        """Add −m_j/ρ_j x_ij ∇W_ijᵀ."""
        return add(total, scale(outer(pair.x_ij), -j.mass * j.specific_volume * pair.dw_r))

    def finish_value(self, total, i, kernel):
        """L − 1, and its size."""
        return _correction(total, self.least, i.position)

    def density_rate(self, i, j, pair):
        """What L_i − 1 adds to a neighbour's share of dρ_i/dt, kg/(m^d s)."""
        return pair.m_dw_r * dot(pair.u_ij, times(i.gradient_correction, pair.x_ij))

    def push(self, i, j, pair):
        """What L_i − 1 and L_j − 1 add to the symmetric pressure gradient, m/s²."""
        return _corrected_push(felt(Holding(), i, j), i, j, pair)

    @staticmethod
    def conflicts(physics, kernel):
        """It corrects two forms of the pressure gradient."""
        if physics.pressure_gradient not in CORRECTED:
            yield (
                f'does not work with physics.pressure_gradient = "{physics.pressure_gradient}"; use '
                '"symmetric" or "difference"'
            )


class CorrectionBesideWalls(NamedTuple):
    """Gradients are corrected to be exact for linear fields, in pressure and in continuity, beside walls too.

    As :class:`GradientCorrection`, but in a wall L is that of a whole lattice of its density, whose sum is
    1·(m/ρ)/``volume``: behind a wall there is nothing, and an L of what is there would push the fluid in
    front of it, under a pressure that is the same everywhere.  ``volume`` is dx^d over the mean of the
    lattice's −Σ_j dx^d x_ij ∇W_ijᵀ, m^d.  ``walls`` say what stands for p beside them
    (psph.physics.fluid.parting).  Where particles share ``cells`` the m of all of a cell counts, and each has
    the same L.  What stands behind open ends, ``buffers``, has that of a lattice too.
    """

    conserves = ("momentum",)

    least: float
    volume: float
    walls: Hold = Holding()
    cells: Cells = OneEach()
    buffers: Buffers = NoBuffers()

    writes = CORRECTION, SIZE
    lagged = True
    slow = True

    start = GradientCorrection.start
    gather = GradientCorrection.gather

    def finish_value(self, total, i, kernel):
        """L − 1, and its size."""
        return in_walls(total, i, sharing(self.cells, i) * i.mass, self)

    density_rate = GradientCorrection.density_rate

    def push(self, i, j, pair):
        """What L_i − 1 and L_j − 1 add to the symmetric pressure gradient, m/s²."""
        return _corrected_push(felt(self.walls, i, j), i, j, pair)


class VolumeCorrection(NamedTuple):
    """Gradients are corrected to be exact for linear fields, between fluids of several densities.

    As :class:`CorrectionBesideWalls`, L from all neighbours alike: dρ_i/dt takes
    ρ_i Σ V_j θ_ij u_ij·(L_i − 1)∇W_ij more, the pressure gradient
    1/ρ_i Σ V_j [θ_ij p_i (L_i − 1) + θ_ji p_j (L_j − 1)] ∇W_ij (psph.physics.fluid.several).
    """

    conserves = ("momentum",)

    least: float
    volume: float
    facing: Facing
    walls: Hold = Holding()
    buffers: Buffers = NoBuffers()

    writes = CORRECTION, SIZE
    lagged = True
    slow = True

    start = GradientCorrection.start
    gather = GradientCorrection.gather

    def finish_value(self, total, i, kernel):
        """L − 1, and its size."""
        return in_walls(total, i, i.mass, self)

    def density_rate(self, i, j, pair):
        """What L_i − 1 adds to a neighbour's share of dρ_i/dt, kg/(m^d s)."""
        weight = pair.m_dw_r * (shares(self.facing, i, j)[0] * (j.specific_volume / i.specific_volume))
        return weight * dot(pair.u_ij, times(i.gradient_correction, pair.x_ij))

    def push(self, i, j, pair):
        """What L_i − 1 and L_j − 1 add to the symmetric pressure gradient, m/s²."""
        theta_ij, theta_ji = shares(self.facing, i, j)
        own, other = borne(self.walls, i, j)
        both = add(
            scale(i.gradient_correction, theta_ij * own), scale(j.gradient_correction, theta_ji * other)
        )
        return scale(times(both, pair.x_ij), -in_volumes(i, j, pair))


class DifferenceCorrection(NamedTuple):
    """Gradients are corrected to be exact for linear fields, in pressure differences too.

    As :class:`GradientCorrection`; the pressure gradient from differences takes L_i alone, and is
    exact for linear p whatever the order of the particles.  Randles & Libersky (1996).
    """

    least: float

    writes = CORRECTION, SIZE
    lagged = True
    slow = True

    start = GradientCorrection.start
    gather = GradientCorrection.gather
    finish_value = GradientCorrection.finish_value
    density_rate = GradientCorrection.density_rate

    def push(self, i, j, pair):
        """What L_i − 1 adds to the pressure gradient from differences, m/s²."""
        weight = (i.pressure - j.pressure) * i.specific_volume
        weight = weight * (j.specific_volume * pair.m_dw_r)
        return scale(times(i.gradient_correction, pair.x_ij), weight)


def needs_correction(physics):
    """What contradicts an effect that takes corrected gradients of the symmetric form, in words."""
    if physics.gradient_correction is None or physics.pressure_gradient != "symmetric":
        yield (
            "takes corrected gradients; set physics.gradient_correction, and physics.pressure_gradient = "
            '"symmetric"'
        )


@helper
def in_walls(total, i, mass, of):
    """L − 1 and its size, in a wall that of a lattice with the ``mass`` in a cell."""
    whole, front = mass * i.specific_volume / of.volume, in_front(of.buffers, i)
    behind = less_diagonal(outer(zero_like(i.position)), -whole * (1.0 - front), i.position)
    return _correction(add(scale(total, front), behind), of.least, i.position)


@helper
def _corrected_push(felt_by_both, i, j, pair):
    """−m_j (p_i (L_i − 1)/ρ_i² + p_j (L_j − 1)/ρ_j²) ∇W_ij, m/s², with what both feel of p/ρ²."""
    own, other = felt_by_both
    both = add(scale(i.gradient_correction, own), scale(j.gradient_correction, other))
    return scale(times(both, pair.x_ij), -pair.m_dw_r)


@helper
def half_disorder(half, i):
    """½ min(|L − 1|²/t², 1) with ``half`` = 1/(2t²): of both ends of a pair together between 0, where
    neighbours are in order all around, and 1."""
    return min(half * i.disorder, 0.5)


@helper
def _correction(total, least, like):
    size = determinant(total, like)
    correction = scale(less_diagonal(adjugate(total, like), size, like), 1.0 / max(size, least))
    return correction + (norm_squared(correction, like),)
