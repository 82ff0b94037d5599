"""What a free surface does to its particles."""

from typing import Annotated, NamedTuple

from pydantic import Field

from psph.acts import FLUIDS, MADE_FOR_FLUIDS, SOILS
from psph.fields import Field as Declared
from psph.fields import Same
from psph.formula import where
from psph.physics.facts import Facts
from psph.physics.fluid.several import several
from psph.smoothing import weight

NOT_YET_SUMMED = 2.0
"""A kernel sum that no threshold calls a surface, until the first pass knows better."""


class FreeSurface(NamedTuple):
    """A particle at a free surface feels no pressure.

    Where Σ_j W_ij m_j/ρ_j (with the particle itself, and the walls) < β, ρ_i = ρ₀ and hence p_i = 0.
    SSPH paper, eq. (14), β = 0.9.  The sum is gathered in the same pass as the forces: it acts on
    the density at the end of that step, and on the pressure that the next forces feel.  Resetting ρ
    costs mass-consistency: a still surface without it
    is quieter.
    """

    threshold: Annotated[
        float, Field(gt=0, lt=2, description="β: below this kernel sum a particle is surface")
    ] = 0.9

    writes = Declared(
        "kernel_sum",
        "1",
        "sum of W m/rho over the support, the particle included",
        start=NOT_YET_SUMMED,
        image=Same,
    )
    lagged = True

    def start(self, i):
        """No neighbour yet."""
        return 0.0

    def gather(self, total, i, j, pair):
        """Add W_ij m_j/ρ_j."""
        return total + j.mass * j.specific_volume * pair.w

    def finish_value(self, total, i, kernel):
        """Σ_j W_ij m_j/ρ_j with the particle's own share, stored as ``kernel_sum``."""
        return total + weight(kernel, 0.0) * i.mass * i.specific_volume

    def limit_density(self, i, rho):
        """ρ₀ on the surface, ρ inside, kg/m^d."""
        return i.rest_density if i.kernel_sum < self.threshold else rho

    def idle(self, scene: Facts, effects):
        """Why it has no influence, or None."""
        if scene.has_free_surface:
            return None
        return (
            "the fluid has no free surface at the start; remove physics.free_surface, and the pair loop "
            "has one sum less"
        )


class TensionFloor(NamedTuple):
    """A lower bound of the density limits the tension of the fluid; walls bear no tension at all.

    ρ_i ≥ f ρ₀_i: below, the density is set to it.  The pressure of a wall is that of max(ρ_i, ρ₀_i),
    while its density stays what the water makes it.  Where a fluid has a free surface a splash would
    otherwise be held together, or pulled to a wall, by pressures that water does not bear.
    """

    acts = (FLUIDS, SOILS)
    refuses = MADE_FOR_FLUIDS

    least: Annotated[
        float,
        Field(
            gt=0,
            le=1,
            description="f: least density of the fluid over its rest density",
            json_schema_extra={"unit": "1"},
        ),
    ] = 0.98

    def in_scene(self, scene: Facts):
        """None in a closed domain, where a fluid may be under tension; beside matter with a strength the form
        that lets that open, beside a gas that which lets it expand."""
        if not scene.has_free_surface:
            return None
        if several(scene):
            return FloorOfLiquids(self.least, GAS * max(one.density for one in scene.species))
        return FloorBesideStrength(self.least) if scene.strengths else self

    def why_absent(self, scene: Facts):
        """What the fluid lacks."""
        return "the fluid has no free surface, and in a closed domain it may be under tension"

    def limit_density(self, i, rho):
        """ρ or its floor, kg/m^d."""
        return max(rho, self.least * i.rest_density)

    limit_wall_density = limit_density

    def bearing_density(self, i, rho):
        """ρ that a wall's pressure is taken from, kg/m^d."""
        return max(rho, i.rest_density)

    def linear(self, scene: Facts):
        """It does not act on a small disturbance."""
        return None


def under_tension(scene: Facts) -> float:
    """1 if the walls of a scene may have a pressure below zero, else 0."""
    return float(scene.physics.tension_floor is None or not scene.has_free_surface)


GAS = 0.1
"""Rest density over the largest of the scene below which a fluid expands as a gas does."""


class FloorOfLiquids(NamedTuple):
    """A lower bound of the density limits the tension of liquids, while a gas beside them expands.

    The form of :class:`TensionFloor` in a scene with several fluids: those whose rest density is at least
    ``lightest``, kg/m^d.
    """

    least: float
    lightest: float

    def limit_density(self, i, rho):
        """ρ or its floor, kg/m^d."""
        return where(i.rest_density < self.lightest, rho, max(rho, self.least * i.rest_density))

    limit_wall_density = limit_density
    bearing_density = TensionFloor.bearing_density
    linear = TensionFloor.linear


LOOSEST = 0.9
"""Least density of soil that is torn apart, over its rest density, as between loose and dense packings: wider
gaps are forgotten, or grains that fly would thin out and bear nothing where they land.  Of 0.99 a silo swells
in its stream, and gives less and less."""


class FloorBesideStrength(NamedTuple):
    """Water that is torn apart holds no more tension than this, and walls hold none; soil may open.

    The form of :class:`TensionFloor` in a scene with soils, which have their own limit of tension
    (:class:`psph.physics.stress.strength.Strength`).
    """

    least: float

    def limit_density(self, i, rho):
        """ρ or its floor, kg/m^d."""
        return max(rho, where(i.strength > 0.0, LOOSEST, self.least) * i.rest_density)

    limit_wall_density = limit_density
    bearing_density = TensionFloor.bearing_density
    linear = TensionFloor.linear
