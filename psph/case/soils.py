"""Soils of a case, and the rules between their keys."""

import math
from collections.abc import Iterator
from typing import ClassVar

from psph.acts import FRAME, MIXED, ONE, SOILS, SOLIDS, UPDATED, speaks_for
from psph.case.findings import Finding
from psph.case.hooke import Hookean
from psph.case.keys import Vector, key
from psph.physics.stress.strength import MohrCoulomb, pyramid
from psph.physics.walls.conditions import PENALTY, REPULSIVE

ALONE = "soils push no {} and feel none; remove one of the two, or draw it as a wall, which may move"
"""What soils say beside what is rigid or elastic."""


@speaks_for(SOILS)
class Soil(Hookean):
    """Soil: elastic until it yields by friction and cohesion."""

    velocity: Vector | None = key("velocity at the start", None, unit="m/s", otherwise="zeros")
    density: float = key("bulk density, of the soil with its pores and the water in them", unit="kg/m3", gt=0)
    young: float = key("Young's modulus E", unit="Pa", gt=0)
    poisson: float = key("Poisson's ratio ν; in 2D the soil is in plane strain", unit="1", ge=0, lt=0.5)
    friction_angle: float = key("angle of friction φ", unit="degrees", ge=0, lt=90)
    cohesion: float = key("cohesion c", 0.0, unit="Pa", ge=0)
    dilatancy: float = key("angle of dilatancy ψ, no more than that of friction", 0.0, unit="degrees", ge=0)
    tension: float | None = key(
        "largest mean tension that it bears",
        None,
        unit="Pa",
        otherwise="c/tan φ, at the tip of its yield surface; c without friction",
        ge=0,
    )
    geostatic: bool = key(
        "it starts with the stress of its weight below level ground; else without stress", True
    )
    rest_coefficient: float | None = key(
        "K0 at the start: effective stress across gravity over that along it",
        None,
        unit="1",
        otherwise="ν/(1 − ν)",
        gt=0,
    )
    strength_reduction: float = key(
        "divides the cohesion and the tangents of both angles: the largest for which a slope stands is its "
        "factor of safety",
        1.0,
        unit="1",
        gt=0,
    )
    stress_diffusion: float = key(
        "how strongly the deviatoric stress spreads between neighbours; 0 leaves its noise",
        0.1,
        unit="1",
        ge=0,
    )
    water_level: float | None = key(
        "height of the still water in its pores; friction acts on the stress less the pressure of that water",
        None,
        unit="m",
        otherwise="dry",
    )
    water_density: float = key("density of that water", 1000.0, unit="kg/m3", gt=0)

    word: ClassVar = SOILS
    rubs: ClassVar = True
    refuses: ClassVar = {
        ONE: "soils need two or three dimensions",
        **{one: ALONE.format(one) for one in (SOLIDS, UPDATED)},
        MIXED: 'soils are computed in double precision, since strains are small; use "double"',
        FRAME: "soils know of no frame that moves; remove one of the two",
        **dict.fromkeys(
            (REPULSIVE, PENALTY), 'bears no stress of soil; take "dynamic", "extrapolated" or "mirror"'
        ),
    }

    @classmethod
    def contradictions(cls, case) -> Iterator[Finding]:
        """Soils that cannot be."""
        yield from earthen(case)

    @property
    def at_rest(self) -> float:
        """K₀ of the start."""
        given = self.rest_coefficient
        return self.poisson / (1.0 - self.poisson) if given is None else given

    @property
    def pyramid(self) -> tuple[float, float, float]:
        """3α, k in Pa and 3α_ψ of its yield surface, its strength reduced."""
        by = self.strength_reduction
        return pyramid(self._reduced(self.friction_angle), self.cohesion / by, self._reduced(self.dilatancy))

    def _reduced(self, angle: float) -> float:
        """An angle in degrees with its tangent reduced, rad."""
        return math.atan(math.tan(math.radians(angle)) / self.strength_reduction)

    @property
    def tip(self) -> float:
        """The largest mean tension, Pa; without friction k itself where none is given."""
        friction, cohesion, _ = self.pyramid
        if not friction:
            return cohesion if self.tension is None else self.tension
        return min(cohesion / friction, math.inf if self.tension is None else self.tension)

    def law(self, up: tuple[float, ...], pull: float) -> MohrCoulomb:
        """What bounds its stress, under gravity of ``pull`` m/s² against ``up``."""
        friction, cohesion, dilation = self.pyramid
        wet = self.water_level is not None
        return MohrCoulomb(
            friction,
            cohesion,
            dilation,
            self.tip,
            self.shear_modulus,
            self.bulk_modulus,
            self.water_density * pull if wet else 0.0,
            self.water_level if wet else 0.0,
            up,
        )


def earthen(case) -> Iterator[Finding]:
    """Soils that cannot be, in a case with space.dimensions."""
    if not case.soils:
        return
    for name in case.soils.keys() & (case.fluids.keys() | case.walls.keys()):
        yield ("soils", name), ..., "a fluid or a wall has this name too; give the soil another"
    if getattr(case, "regions", None):
        yield ("regions",), ..., "nothing is known of regions in soil; remove the regions or the soils"
    if case.physics.sound_speed is not None and not case.fluids:
        says = "soils have waves of their own, by young and poisson; remove this key"
        yield ("physics", "sound_speed"), case.physics.sound_speed, says
    gravity = case.physics.gravity
    pulled = gravity is not None and any(gravity.acceleration)
    for name, soil in case.soils.items():
        yield from _of_one(("soils", name), soil, pulled)


def _of_one(here, soil: Soil, pulled: bool) -> Iterator[Finding]:
    """What contradicts itself in a soil."""
    if soil.dilatancy > soil.friction_angle:
        says = f"it cannot exceed friction_angle, which is {soil.friction_angle:g} degrees; give less"
        yield (*here, "dilatancy"), soil.dilatancy, says
    if not soil.friction_angle and not soil.cohesion:
        says = "without friction and cohesion it is a liquid; give one of them, or a fluid"
        yield (*here, "friction_angle"), soil.friction_angle, says
    if soil.water_level is not None and not pulled:
        says = "there is no gravity, so no pressure in the pores; give physics.gravity, or remove this key"
        yield (*here, "water_level"), soil.water_level, says
    if soil.water_level is not None and soil.water_density >= soil.density:
        says = (
            f"soil of {soil.density:g} kg/m³ would float in it; give the density of the soil with its water"
        )
        yield (*here, "water_density"), soil.water_density, says
