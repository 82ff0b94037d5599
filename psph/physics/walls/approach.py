"""From where on a wall counts what comes nearer as compression."""

from typing import Annotated, NamedTuple

from pydantic import Field

from psph.acts import FLUIDS, MADE_FOR_FLUIDS
from psph.formula import where
from psph.physics.facts import Facts
from psph.physics.fluid.several import several
from psph.physics.walls.conditions import DYNAMIC

WALL = 1.0
"""Number of a wall among what is solid (psph.fields)."""

BLENDS = 1.4
"""Spacings over which the approach comes to count.  Over 0.5 the sum over a row that slides along a wall has
ripples of 1.3 %, on which a film of one row leaves it; over 1.4 of 0.05 %, as the whole sum."""


class WallApproach(NamedTuple):
    """A wall counts as compression the approach of fluid that is near, and not of what is on its way.

    dρ_i/dt of a wall particle i has less by (1 − φ) m_j u_ij·∇W_ij of each fluid particle j, φ = x²(3 − 2x)
    with x = (R − r_ij)/(1.4 dx) between 0 and 1, R = ``reach`` dx.  By the whole sum a dry wall is compressed
    by what comes within the support, stops it there, and gives the excess back in some milliseconds: a tongue
    glides one to two spacings above a dry bed, and strikes the next wall from there.  Of fluid that touches
    the wall the rows behind the first hardly count either; their pressure comes by diffusion.  The fluid
    feels the wall as before.  Rigid bodies count all: the film under one that sinks to a floor would be
    crushed between two that do not.  So do walls beside a fluid with a tension: a short bridge between plates
    would lean on and break (Vogel's limit).  psph's own.
    """

    acts = (FLUIDS, DYNAMIC)
    refuses = MADE_FOR_FLUIDS

    reach: Annotated[
        float,
        Field(
            ge=1.5,
            le=4,
            description="R: spacings within which the approach of fluid counts",
            json_schema_extra={"unit": "1"},
        ),
    ] = 2.2

    def in_scene(self, scene: Facts):
        """The form that knows the spacing, where a fluid with a free surface may come to dynamic walls."""
        walls = [one for one in scene.species if one.solid == WALL and one.bearing and not one.extrapolated]
        bears = any(one.shear_modulus or one.bonded is not None for one in scene.species)
        pulls = any(any(one.tensions) for one in scene.species)
        if not walls or bears or pulls or several(scene) or not scene.has_free_surface:
            return None
        h = scene.smoothing_length / scene.spacing
        return NearApproach(self.reach / h, h / BLENDS)

    def why_absent(self, scene: Facts):
        """Why it has no form in the scene."""
        return (
            "it needs dynamic walls, one fluid with a free surface and without tension, and no solid or soil"
        )


class NearApproach(NamedTuple):
    """A wall counts as compression the approach of fluid that is near, and not of what is on its way.

    The form of :class:`WallApproach` in a scene: x = (``reach`` − r/h) ``steepness`` between 0 and 1.
    """

    reach: float
    steepness: float

    on_walls = True

    def density_rate(self, i, j, pair):
        """What a wall leaves out of one neighbour's share of dρ_i/dt, kg/(m^d s)."""
        x = min(max((self.reach - pair.r / i.smoothing_length) * self.steepness, 0.0), 1.0)
        left = (1.0 - x * x * (3.0 - 2.0 * x)) * j.is_fluid
        return where(i.solid == WALL, -left * (pair.u_dot_x * pair.m_dw_r), 0.0)

    def linear(self, scene: Facts):
        """Linear theory knows of no walls."""
        return None
