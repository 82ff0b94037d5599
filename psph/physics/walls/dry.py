"""What a wall is where no fluid touches it."""

from typing import NamedTuple

from psph.fields import Field, Same
from psph.formula import where
from psph.physics.facts import Facts
from psph.physics.fluid.several import several


class DryWall(NamedTuple):
    """A wall that no fluid touches bears nothing: it has its rest density.

    ρ_i = ρ₀_i in a wall particle without a fluid particle within the kernel's support.  The places of each
    step decide which those are, and the pair loop knows nothing of it (psph.particles.wetting.mark_wet).
    A wall that was dry becomes wet where fluid comes within 0.95 of the support: were it one distance, still
    water would tremble, for a wall at the edge of reach would lose its pressure again and again.  Without
    it a wall would keep for ever the pressure that it had when the fluid left.  Nothing is summed for a wall
    that is dry (psph.simulation.wetting).
    A wall whose condition bears no pressure (psph.physics.walls.conditions) is always dry.
    """

    marks = Field(
        "wet",
        "1",
        "0 in a wall without fluid in reach, 0.5 beside fluids alone that it does not continue, else 1",
        start=1.0,
        image=Same,
    )
    """The field that says whether there is fluid in reach."""
    told_by = "is_fluid"
    """The field of a neighbour that tells fluid from wall."""

    def in_scene(self, scene: Facts):
        """Nothing where no wall has particles; beside several fluids the form that tells them apart."""
        if all(one.is_fluid for one in scene.species):
            return None
        return DryBesideOthers() if several(scene) else self

    @staticmethod
    def served(wall, species) -> list[bool]:
        """Whether what has the number 0, 1 ... in ``told_by`` makes a wall among some ``species`` wet."""
        return [False, wall.bearing]

    def why_absent(self, scene: Facts):
        """Why it has no form in the scene."""
        return "no wall has particles"

    def limit_wall_density(self, i, rho):
        """ρ of a wall with fluid in reach, ρ₀ without, kg/m^d."""
        return where(i.wet > 0.0, rho, i.rest_density)

    def linear(self, scene: Facts):
        """Linear theory includes it as it is."""
        return None


class DryBesideOthers(NamedTuple):
    """A wall that no fluid touches which it continues bears nothing: it has its rest density.

    The form of :class:`DryWall` in a scene with several fluids.  To a fluid of another density a wall is a
    rigid mirror without a pressure of its own (psph.physics.fluid.several), so where such fluids alone are in
    reach nothing would change the pressure that it has.
    """

    marks = DryWall.marks
    told_by = "fluid"
    """The field of a neighbour that tells fluids from each other and from walls."""

    @staticmethod
    def served(wall, species) -> list[bool]:
        """Whether the fluid with the number 0, 1 ... makes a wall among some ``species`` wet."""
        fluids = sorted((one for one in species if one.fluid), key=lambda one: one.fluid)
        own = (wall.density, wall.sound_speed)
        return [False, *(wall.bearing and own == (one.density, one.sound_speed) for one in fluids)]

    def limit_wall_density(self, i, rho):
        """ρ of a wall with fluid in reach that it continues, else ρ₀, kg/m^d."""
        return where(i.wet < 1.0, i.rest_density, rho)

    def linear(self, scene: Facts):
        """Linear theory includes it as it is."""
        return None
