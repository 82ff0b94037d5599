"""Where surfaces of fluids meet walls and bodies: what holds them there, and the contact angle.

A surface ends at a wall, and the wall bears the part of its pull that goes into it: without that, a drop
would be lifted off by its own pressure.  Along the wall it pulls the line of contact with σ cos φ, so that
the surface is at rest at the angle φ: Young (1805), Phil. Trans. R. Soc. 95, 65; as a force at the line Huber
and others (2016), J. Comput. Phys. 310, 459.  Both forces act between pairs of a fluid and a wall particle.
psph's own.
"""

import math
from itertools import product
from typing import NamedTuple

import numpy as np

from psph.acts import FLUIDS
from psph.fields import VECTOR, Same, Turned
from psph.fields import Field as Declared
from psph.formula import helper, where
from psph.moments import first_moment, sites_around
from psph.physics.facts import Facts
from psph.physics.surface.tension import (
    FULL,
    NOTHING,
    Blunt,
    SurfaceTension,
    blunt,
    blunt_kernel,
    borne,
    by_r2,
    same,
    vector_of,
)
from psph.smoothing import slope_over_r
from psph.vectors import add, dot, scale, subtract, zero_like

LEVEL = 1e-3
"""Length of a sum over walls, in 1/dx, that tells no direction."""

COSINES = (-0.5, 0.0, 0.5)
"""Of the angles at which a lattice is cut."""

CUTS = 16
"""Places at which it is cut."""

TO_WALLS = Declared("to_walls", "1/m", "sum of V grad W over walls and bodies", VECTOR, image=Turned)
SIDE = Declared(
    "heavy_side",
    "1",
    "1 in the heavier of the two that meet, -1 in the lighter, also at a free surface 1",
    image=Same,
)


class ContactLine(NamedTuple):
    """Walls and bodies hold the surfaces of fluids that end at them.

    a_i = −(2/ρ_i) Σ_w V_w (σ_i/C) k_iw (ê·T_i x_iw) ê over walls, ê the direction to them, T, C and k as in
    :class:`SurfaceTension <psph.physics.surface.tension.SurfaceTension>`; the opposite force acts on the
    wall.
    """

    acts = (FLUIDS,)
    refuses = SurfaceTension.refuses
    conserves = ("momentum",)

    def in_scene(self, scene: Facts):
        """The form that knows the tension; None without one, and without walls."""
        tension = SurfaceTension().in_scene(scene)
        if tension is None or all(one.is_fluid for one in scene.species):
            return None
        return HeldByWalls(2.0 * tension.strength, tension.kernel, (LEVEL / scene.spacing) ** 2)

    def why_absent(self, scene: Facts):
        """What it lacks."""
        return "there is no wall of particles and no body, or no tension"


class HeldByWalls(NamedTuple):
    """Walls and bodies hold the surfaces of fluids that end at them.

    The form of :class:`ContactLine` in a scene: twice the ``strength`` of the tension in N/m, the ``kernel``
    of its force, and ``level2`` in 1/m², the square of a sum over walls that is none.
    """

    conserves = ("momentum",)

    strength: float
    kernel: Blunt
    level2: float

    writes = TO_WALLS

    def start(self, i):
        """No neighbour yet."""
        return zero_like(i.position)

    def gather(self, total, i, j, pair):
        """Add V_j ∇W of a wall."""
        return add(total, scale(pair.x_ij, (1.0 - j.is_fluid) * (j.specific_volume * pair.m_dw_r)))

    def finish_value(self, total, i, kernel):
        """The sum in a fluid, 0 elsewhere."""
        return scale(total, i.is_fluid)

    def push(self, i, j, pair):
        """Acceleration by a neighbour, m/s²."""
        wets, wetted = met(i, j)
        held = add(scale(_held(i, pair, self), wets), scale(_held(j, pair, self), wetted))
        weight = self.strength * blunt(self.kernel, pair)
        return scale(held, -weight * (i.specific_volume * j.specific_volume * j.mass))


class ContactAngle(NamedTuple):
    """Surfaces of fluids meet walls and bodies at an angle, told through the heavier of the two fluids.

    a_i = (1/ρ_i) Σ_w V_w (σ_i cos φ_w/D) s_i k_iw (n_i − ê ê·n_i), n_i the normal of
    :class:`SurfaceTension <psph.physics.surface.tension.SurfaceTension>`, s = 1 in the heavier fluid and at a
    free surface and −1 in the lighter one, D(φ) that by which the line of a lattice cut at φ is pulled by σ.
    """

    acts = (FLUIDS,)
    refuses = SurfaceTension.refuses
    conserves = ("momentum",)

    def in_scene(self, scene: Facts):
        """The form that knows the tension and the lattice; None without a tension."""
        tension = SurfaceTension().in_scene(scene)
        if tension is None:
            return None
        dx, dimensions = scene.spacing, scene.dimensions
        largest = max(max(one.tensions) for one in scene.species if one.tensions)
        blunt = blunt_kernel(scene.kernel, dx, dimensions)
        full = -first_moment(scene.kernel, dx, dimensions)
        steep, upright, flat = (pulled_line(blunt, scene.kernel, dx, dimensions, cos) for cos in COSINES)
        remembered = any(one.wetting_range for one in scene.species)
        form = AtRememberedAngle if remembered else AtAngle
        return form(
            largest / upright,
            (flat - steep) / upright,
            blunt,
            (LEVEL / dx) ** 2,
            FULL * full if scene.has_free_surface else 0.0,
        )

    def why_absent(self, scene: Facts):
        """What it lacks."""
        return "no fluid has a tension"


class AtAngle(NamedTuple):
    """Surfaces of fluids meet walls and bodies at an angle, told through the heavier of the two fluids.

    The form of :class:`ContactAngle` in a scene: ``strength`` σ/D(90°) of the largest tension, ``lean`` with
    D(φ) = D(90°) (1 + lean cos φ), ``kernel`` and ``level2`` as in :class:`HeldByWalls`, and ``full``, that
    Σ V r W′ from which on there is no free surface.
    """

    conserves = ("momentum",)

    strength: float
    lean: float
    kernel: Blunt
    level2: float
    full: float

    writes = SIDE

    def start(self, i):
        """Σ V r W′ of lighter fluids less heavier ones, of other fluids, and of all."""
        return 0.0, 0.0, 0.0

    def gather(self, total, i, j, pair):
        """Take neighbour j into each."""
        share = -j.specific_volume * pair.m_dw_r * pair.r2
        other = share * j.is_fluid * (1.0 - same(i, j))
        return total[0] + other * _heavier(i, j), total[1] + other, total[2] + share

    def finish_value(self, total, i, kernel):
        """Between −1 and 1; 0 in a wall."""
        void = max(self.full - total[2], 0.0)
        return i.is_fluid * (total[0] + void) / max(total[1] + void, NOTHING)

    def push(self, i, j, pair):
        """Acceleration by a neighbour, m/s²."""
        wets, wetted = met(i, j)
        return _pulled_along(self, i, j, pair, wetted * i.wetting, wets * j.wetting)


class AtRememberedAngle(NamedTuple):
    """Surfaces of fluids meet walls and bodies at an angle between two, which these remember.

    :class:`AtAngle`, where the angle of a line is that of its place (psph.physics.surface.hysteresis).
    """

    conserves = ("momentum",)

    strength: float
    lean: float
    kernel: Blunt
    level2: float
    full: float

    writes = SIDE
    start, gather, finish_value = AtAngle.start, AtAngle.gather, AtAngle.finish_value

    def push(self, i, j, pair):
        """Acceleration by a neighbour, m/s²."""
        wets, wetted = met(i, j)
        return _pulled_along(self, i, j, pair, wetted * i.line_cosine, wets * j.line_cosine)


@helper
def _pulled_along(of, i, j, pair, own, other):
    """Acceleration of a particle by a neighbour along the wall that one of them is of, m/s²; ``own`` and
    ``other``: cos φ where i, where j is the wall, else 0."""
    pull = subtract(scale(_along(i, of), _pull(of, other)), scale(_along(j, of), _pull(of, own)))
    weight = of.strength * blunt(of.kernel, pair)
    return scale(pull, weight * (i.specific_volume * j.specific_volume * j.mass))


@helper
def _pull(of, wetting):
    """cos φ/D(φ) over 1/D(90°)."""
    return wetting / (1.0 + of.lean * wetting)


@helper
def met(i, j):
    """1 where i is a fluid and j is none, else 0; and the other way round."""
    return i.is_fluid * (1.0 - j.is_fluid), j.is_fluid * (1.0 - i.is_fluid)


@helper
def _heavier(i, j):
    """1 where the fluid of i is heavier, or the first of two that are alike, else −1."""
    heavy = where(i.rest_density > j.rest_density, 1.0, -1.0)
    alike = where(j.fluid > i.fluid, 1.0, -1.0)
    differs = max(i.rest_density, j.rest_density) > min(i.rest_density, j.rest_density)
    return where(differs, heavy, alike)


@helper
def _held(i, pair, of):
    """What a fluid particle's stress bears across its wall, ê ê·T x."""
    across = dot(borne(i.surface_vector, pair.x_ij), i.to_walls)
    return scale(i.to_walls, across / (dot(i.to_walls, i.to_walls) + of.level2))


@helper
def _along(i, of):
    """s (n − ê ê·n) of a fluid particle, 1/m."""
    n = scale(i.surface_vector, np.sqrt(dot(i.surface_vector, i.surface_vector)))
    across = dot(n, i.to_walls) / (dot(i.to_walls, i.to_walls) + of.level2)
    return scale(subtract(n, scale(i.to_walls, across)), i.heavy_side)


def pulled_line(of: Blunt, kernel, spacing: float, dimensions: int, cos: float) -> float:
    """D: by what the line is pulled, by its length, where a flat surface through the lattice of ``spacing`` m
    meets a flat wall at an angle with this cosine; for a strength of one.

    Σ dx² n Σ_w dx^d k over the sites above the wall and on the fluid's side, in the mean over its places.
    """
    sites = np.array([*sites_around(kernel, spacing, dimensions)], float) * spacing
    volume, reach = spacing**dimensions, round(sites.max() / spacing) + 1
    slopes = np.array([float(slope_over_r(kernel, r, 1.0 / r)) for r in np.linalg.norm(sites, axis=1)])
    weights, outward = by_r2(of, (sites**2).sum(axis=1)), np.array([math.sqrt(1.0 - cos * cos), cos])
    places = np.array([*product(range(-3 * reach, 3 * reach), range(reach), range(CUTS))], float)
    here = (places[:, :2] + 0.5) * spacing
    here[:, 0] -= places[:, 2] * (spacing / CUTS)
    here = here[here @ outward < 0.0]
    wall = sites[:, -1] < -here[:, 1:]
    held = wall | ((here[:, None] + sites[:, [0, -1]]) @ outward < 0.0)
    normal = volume * (held @ (slopes[:, None] * sites))
    vector = np.array(vector_of(of, tuple(normal.T), 1.0))
    along = vector[0] * np.linalg.norm(vector, axis=0)
    return float(along @ (wall @ weights)) * spacing**2 * volume / CUTS
