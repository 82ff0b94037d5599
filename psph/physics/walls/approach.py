"""From where on a wall counts what comes nearer as compression."""

from typing import Annotated, NamedTuple

from pydantic import Field

from psph.acts import FLUIDS, MADE_FOR_FLUIDS
from psph.formula import where
from psph.physics.facts import Facts
from psph.physics.fluid.several import several
from psph.physics.fluid.summation import around_a_surface, rows_below_a_surface, sums_fullness
from psph.physics.walls.conditions import BEARING

BLENDS = 0.5
"""Spacings over which the approach comes to count."""


class WallApproach(NamedTuple):
    """A dry wall counts as compression the approach of fluid that is near, and not of what is on its way.

    dρ_i/dt of a wall particle i has less by (1 − φ)(1 − χ) m_j u_ij·∇W_ij of each fluid particle j,
    φ = (R − r_ij)/(½ dx) between 0 and 1, R = ``reach`` dx; χ grows from 0 to 1 as its fullness f_i
    (:class:`psph.physics.fluid.summation.SummationDensity`) does from that of the second row below a free
    surface to what tells a surface from the inside.  By the whole sum a dry wall is compressed by what comes
    within the support, stops it there, and gives the excess back in some milliseconds: a tongue glides one to
    two spacings above a dry bed, and strikes the next wall from there.  A wall under water counts all: else
    streams along it lose speed.  The fluid feels the wall as before.  psph's own.
    """

    acts = (FLUIDS, *BEARING)
    refuses = MADE_FOR_FLUIDS

    reach: Annotated[
        float,
        Field(
            gt=0.5,
            le=4,
            description="R: spacings within which the approach of fluid counts",
            json_schema_extra={"unit": "1"},
        ),
    ] = 1.8

    def in_scene(self, scene: Facts):
        """The form that knows the lattice, where a fluid with a free surface may come to walls."""
        walls = [one for one in scene.species if not one.is_fluid]
        held = any(one.bonded is not None for one in scene.species)
        if not walls or held or several(scene) or not scene.has_free_surface or not sums_fullness(scene):
            return None
        h = scene.smoothing_length / scene.spacing
        rows, _ = rows_below_a_surface(scene)
        sparse, _ = around_a_surface(rows)
        dry = max(row for row in rows if row < sparse)
        return NearApproach(self.reach / h, h / BLENDS, dry, 1.0 / (sparse - dry))

    def why_absent(self, scene: Facts):
        """Why it has no form in the scene."""
        return (
            "it needs walls or bodies, all of which bear pressure, one fluid with a free surface, no solid "
            "or soil, and physics.summation_density"
        )


class NearApproach(NamedTuple):
    """A dry wall counts as compression the approach of fluid that is near, and not of what is on its way.

    The form of :class:`WallApproach` in a scene: φ = (``reach`` − r/h) ``steepness`` and
    χ = (f_i − ``dry``) ``rise``, both between 0 and 1.
    """

    reach: float
    steepness: float
    dry: float
    rise: float

    def density_rate(self, i, j, pair):
        """What a wall leaves out of one neighbour's share of dρ_i/dt, kg/(m^d s)."""
        near = min(max((self.reach - pair.r / i.smoothing_length) * self.steepness, 0.0), 1.0)
        touched = min(max((i.fullness - self.dry) * self.rise, 0.0), 1.0)
        left = (1.0 - near) * (1.0 - touched) * j.is_fluid
        return where(i.is_fluid > 0.0, 0.0, -left * (pair.u_dot_x * pair.m_dw_r))

    def linear(self, scene: Facts):
        """Linear theory knows of no walls."""
        return None
