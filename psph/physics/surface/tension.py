"""Surface tension: a stress along free surfaces and interfaces, exact in momentum.

A particle finds the normal from its own side, n_i = −Σ V_j ∇W_ij over its own fluid and what is none, and
bears the stress T_i = |n_i| 1 − n_i n_iᵀ/|n_i| along the surface, as the diffuse stress of Lafaurie and
others (1994), J. Comput. Phys. 113, 134, in SPH Hu & Adams (2006), J. Comput. Phys. 213, 844.  With the
kernel of the scheme in the force, that stress tears a surface: a row of particles under tension is a chain,
which keeps its order only where the pull of a pair grows with its length.  So the force has a blunt kernel of
its own, k ∝ 1 − (r/R)⁶, R its reach, with which the flat surface of a lattice is neutral.  Only pairs of one
fluid carry tension, of two fluids each the part ρ₀/(ρ₀_1 + ρ₀_2), so that both are accelerated alike.  The
whole is scaled by the tension that a flat surface of the starting lattice has.  The stress acts 1.5 spacings
inside the surface, δ: a tension of σ there would have the pressure of a smaller drop, σ/(R − δ), so each pair
pulls with 1 − δκ of it, κ the curvature along the pair.  psph's own.
"""

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from psph.acts import FLUIDS, SOILS, SOLIDS, UPDATED
from psph.engine.jit import call_by_number
from psph.fields import VECTOR, Turned
from psph.fields import Field as Declared
from psph.formula import helper
from psph.moments import first_moment, sites_around
from psph.physics.facts import Facts
from psph.smoothing import slope_over_r
from psph.vectors import add, dot, excess, multiply, scale, subtract, zero_like

NOISE = 0.05
"""Length of a normal, in 1/dx, that half of it is taken for disorder."""

DEPTH = 1.5
"""How far inside the surface its tension acts, in spacings: of drops at rest, 10 and 20 spacings a radius."""

BENT = 0.5
"""Largest part by which curvature changes the pull of a pair."""

FULL = 0.95
"""Part of a whole neighbourhood of any fluids from which on there is no free surface."""

NOTHING = 1e-12
"""Keeps a mean over no other fluid from dividing by zero."""

SMALL = 1e-30
"""Keeps pairs far from any surface from dividing by zero, m."""

VECTOR_OF_STRESS = Declared(
    "surface_vector", "m^-1/2", "normal n of a surface over the root of its length", VECTOR, image=Turned
)


class SurfaceTension(NamedTuple):
    """Surface tension, at free surfaces and between fluids.

    a_i = −(1/ρ_i) Σ_j V_j (σ_iT_i + σ_jT_j)/C x_ij k_ij (1 − δκ_ij) over the own fluid, T = |n| 1 − n nᵀ/|n|,
    n the normal from the own side, k a blunt kernel, C what a flat surface of the starting lattice would
    have, δ the depth at which the stress acts, κ_ij the curvature along the pair
    (psph.physics.surface.tension).  σ_i is that between the two fluids that meet, times the part of the own
    one.  Walls and bodies count as more of each fluid.
    """

    acts = (FLUIDS,)
    refuses = {
        SOILS: "surface tension knows no soil, which shares its surface; remove one of the two",
        UPDATED: "surface tension knows no updated Lagrangian solid; remove one of the two",
        SOLIDS: "surface tension beside elastic solids has not been tried; remove one of the two",
    }
    conserves = ("momentum",)

    def in_scene(self, scene: Facts):
        """The form that knows the fluids and the lattice; None where all tensions are zero."""
        fluids = [one for one in scene.species if one.tensions]
        rows = [_row(one, fluids) for one in fluids]
        largest = max((max(row.at_surface, *row.beside) for row in rows), default=0.0)
        if not largest > 0.0:
            return None
        blunt = blunt_kernel(scene.kernel, scene.spacing, scene.dimensions)
        tension, vectors = flat_surface(blunt, scene.kernel, scene.spacing, scene.dimensions)
        strength, energy = largest / tension, largest / vectors
        inertia = min(inertias([(one.density, one.tensions) for one in fluids]))
        if len(fluids) == 1:
            return TensionOfOne(strength, energy, blunt, inertia)
        shares = tuple(row.over(largest) for row in (Tensions(0.0, rows[0].beside), *rows))
        full = -first_moment(scene.kernel, scene.spacing, scene.dimensions)
        numbers = tuple(float(one.fluid) for one in fluids)
        ones = (1.0,) * len(fluids)
        limit = FULL * full if scene.has_free_surface else 0.0
        return TensionAmong(strength, energy, blunt, inertia, shares, numbers, ones, limit)

    def why_absent(self, scene: Facts):
        """Nothing pulls."""
        return "all tensions are zero"


class Blunt(NamedTuple):
    """k = ``steep`` (1 − (r/R)⁶) for r < R, with Σ dx^d r² k = 1 on the lattice of the start; m^-(d+2).

    ``inverse`` is 1/R², ``noise2`` the square of the length of a normal that is half disorder, 1/m², and
    ``depth`` δ that at which the stress acts, m.
    """

    steep: float
    inverse: float
    noise2: float
    depth: float


class Tensions(NamedTuple):
    """Tensions of a fluid: at a free surface, and its parts of those beside each fluid, N/m or over the
    largest."""

    at_surface: float
    beside: tuple[float, ...]

    def over(self, largest: float) -> "Tensions":
        """The same over the largest."""
        return Tensions(self.at_surface / largest, tuple(one / largest for one in self.beside))

    def mean(self, shares, void, ones):
        """Of what is around: the ``shares`` of fluids, and the ``void``."""
        return (dot(self.beside, shares) + self.at_surface * void) / max(dot(ones, shares) + void, NOTHING)


mean = call_by_number("mean")
"""(rows, number of the fluid, shares, void, ones) → its tension over the largest."""


@helper
def blunt(of, pair):
    """k of a pair, m^-(d+2)."""
    q2 = min(pair.r2 * of.inverse, 1.0)
    return of.steep * (1.0 - q2 * q2 * q2)


@helper
def vector_of(of, normal, tension):
    """n/√|n| times the root of the ``tension`` over the largest, m^-1/2, with n = N |N|²/(|N|² + ``noise2``)
    of the ``normal`` N."""
    size2 = dot(normal, normal)
    return scale(normal, np.sqrt(np.sqrt(size2) / (size2 + of.noise2) * tension))


@helper
def borne(vector, x):
    """T x = (m·m) x − m (m·x) with m = n/√|n|."""
    return subtract(scale(x, dot(vector, vector)), scale(vector, dot(vector, x)))


@helper
def unbent(of, i, j, pair):
    """1 − δκ of a pair, with κ = (n_i/|n_i| − n_j/|n_j|)·x_ij/r² times the geometric mean of both |n| over
    the arithmetic one."""
    m_i, m_j = i.surface_vector, j.surface_vector
    size2_i, size2_j = dot(m_i, m_i), dot(m_j, m_j)
    turn = np.sqrt(size2_j) * dot(m_i, pair.x_ij) - np.sqrt(size2_i) * dot(m_j, pair.x_ij)
    part = 2.0 * of.depth * turn / max((size2_i + size2_j) * pair.r2, SMALL)
    return 1.0 - min(max(part, -BENT), BENT)


@helper
def pulled(of, i, j, pair, alike):
    """Acceleration by a neighbour, m/s²; ``alike``: 1 of the same fluid, else 0."""
    both = add(borne(i.surface_vector, pair.x_ij), borne(j.surface_vector, pair.x_ij))
    weight = of.strength * alike * blunt(of.kernel, pair) * unbent(of.kernel, i, j, pair)
    return scale(both, -weight * (i.specific_volume * j.specific_volume * j.mass))


@helper
def capillary_step(of, scene):
    """Δt ≤ ¼ √(ρ h³/(2πσ)), s, of the shortest waves: Brackbill, Kothe & Zemach (1992), J. Comput. Phys. 100,
    335."""
    return 0.25 * (of.inertia * scene.smoothing_length**3 / (2.0 * math.pi)) ** 0.5


class TensionOfOne(NamedTuple):
    """Surface tension of one fluid at its free surface.

    The form of :class:`SurfaceTension` in a scene: its ``strength`` σ/C and its ``energy`` in N/m, the
    ``kernel`` of the force, and the ``inertia`` ρ₀/σ, s²/m³.
    """

    conserves = ("momentum",)

    strength: float
    energy: float
    kernel: Blunt
    inertia: float

    writes = VECTOR_OF_STRESS

    def start(self, i):
        """No neighbour yet."""
        return zero_like(i.position)

    def gather(self, total, i, j, pair):
        """Add −V_j ∇W."""
        return add(total, scale(pair.x_ij, -j.specific_volume * pair.m_dw_r))

    def finish_value(self, total, i, kernel):
        """n/√|n| in a fluid, 0 elsewhere."""
        return vector_of(self.kernel, total, i.is_fluid)

    def push(self, i, j, pair):
        """Acceleration by a neighbour, m/s²."""
        return pulled(self, i, j, pair, i.is_fluid * j.is_fluid)

    def potential(self, i):
        """Energy of the surface by mass, J/kg."""
        return self.energy * i.specific_volume * dot(i.surface_vector, i.surface_vector)

    def longest_step(self, scene):
        """That of capillary waves, s."""
        return capillary_step(self, scene)


class TensionAmong(NamedTuple):
    """Surface tension between several fluids, and at their free surface.

    The form of :class:`SurfaceTension` in a scene: ``strength`` of the largest tension over C and its
    ``energy`` in N/m, the ``kernel`` of the force, the smallest ``inertia`` ρ₀/σ in s²/m³; the ``tensions``
    over the largest of what is no fluid and of each, by the ``numbers`` of the fluids; as many ``ones``; and
    ``full``, that Σ V r W′ from which on there is no free surface.
    """

    conserves = ("momentum",)

    strength: float
    energy: float
    kernel: Blunt
    inertia: float
    tensions: tuple[Tensions, ...]
    numbers: tuple[float, ...]
    ones: tuple[float, ...]
    full: float

    writes = VECTOR_OF_STRESS

    def start(self, i):
        """No neighbour yet."""
        return zero_like(i.position), scale(self.ones, 0.0), 0.0

    def gather(self, total, i, j, pair):
        """−V_j ∇W of the own fluid and of what is none, −V_j r W′ of each other one, and of all."""
        weight = -j.specific_volume * pair.m_dw_r
        own, share = 1.0 - j.is_fluid * (1.0 - same(i, j)), weight * pair.r2
        away = subtract(self.numbers, scale(self.ones, j.fluid))
        others = scale(excess(self.ones, multiply(away, away)), (1.0 - own) * share)
        return add(total[0], scale(pair.x_ij, own * weight)), add(total[1], others), total[2] + share

    def finish_value(self, total, i, kernel):
        """n/√|n| in a fluid, 0 elsewhere."""
        normal, others, around = total
        void = max(self.full - around, 0.0)
        tension = mean(self.tensions, i.fluid, others, void, self.ones)
        return vector_of(self.kernel, normal, i.is_fluid * tension)

    def push(self, i, j, pair):
        """Acceleration by a neighbour, m/s²."""
        return pulled(self, i, j, pair, i.is_fluid * j.is_fluid * same(i, j))

    potential, longest_step = TensionOfOne.potential, TensionOfOne.longest_step


@helper
def same(i, j):
    """1 between two of one fluid, or two that are none; else 0."""
    apart = i.fluid - j.fluid
    return max(1.0 - apart * apart, 0.0)


def blunt_kernel(kernel, spacing: float, dimensions: int) -> Blunt:
    """The kernel of the force for the lattice of ``spacing`` m; it reaches as far as the smoothing
    ``kernel``."""
    inverse = (kernel.inverse_h / kernel.support) ** 2
    made = Blunt(1.0, inverse, (NOISE / spacing) ** 2, DEPTH * spacing)
    r2 = _squares(kernel, spacing, dimensions)
    return made._replace(steep=1.0 / float((r2 * by_r2(made, r2)).sum() * spacing**dimensions))


def flat_surface(of: Blunt, kernel, spacing: float, dimensions: int) -> tuple[float, float]:
    """Of a flat surface of the lattice of ``spacing`` m for a strength of one: its tension C, and Σ V |n| by
    area.

    C = Σ dx |n| Σ dx^d x_t² k over the rows below the surface, x_t along it; 0.158 in 2D at h/dx 1.4.
    """
    sites = np.array([*sites_around(kernel, spacing, dimensions)], float) * spacing
    r2, volume = (sites**2).sum(axis=1), spacing**dimensions
    slopes = np.array([float(slope_over_r(kernel, r, 1.0 / r)) for r in np.sqrt(r2)])
    weights, tension, vectors = by_r2(of, r2), 0.0, 0.0
    for depth in range(round(sites.max() / spacing) + 1):
        below = sites[:, -1] < (depth + 0.5) * spacing
        normal = -volume * (slopes[below, None] * sites[below]).sum(axis=0)
        vector = np.array(vector_of(of, tuple(normal.tolist()), 1.0))
        along = volume * float((sites[:, 0] ** 2 * weights)[below].sum())
        tension += spacing * float(vector @ vector) * along
        vectors += spacing * float(vector @ vector)
    return tension, vectors


def _squares(kernel, spacing: float, dimensions: int) -> np.ndarray:
    sites = np.array([*sites_around(kernel, spacing, dimensions)], float) * spacing
    return (sites**2).sum(axis=1)


def by_r2(of: Blunt, r2: np.ndarray) -> np.ndarray:
    """k at these r², m^-(d+2)."""
    return of.steep * (1.0 - np.minimum(r2 * of.inverse, 1.0) ** 3)


def _row(one, fluids) -> Tensions:
    """The tensions of a fluid by its part of them, N/m."""
    parts = (one.density / (one.density + other.density) for other in fluids)
    return Tensions(one.tensions[0], tuple(part * tension for part, tension in zip(parts, one.tensions[1:])))


def inertias(fluids: Sequence[tuple[float, tuple[float, ...]]]) -> Iterator[float]:
    """ρ₀/σ of each surface that there can be, of the heavier fluid, s²/m³; of each of the ``fluids`` its
    density and its tensions."""
    for density, tensions in fluids:
        densities = (density, *(max(density, other) for other, _ in fluids))
        yield from (rho / sigma for rho, sigma in zip(densities, tensions) if sigma > 0.0)
