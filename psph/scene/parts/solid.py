"""Elastic solids as parts of a scene: their clamped parts, what they are made of, and what they may hit."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from psph.case import Case
from psph.case.elastic import STRESS, branches
from psph.case.updated import referred_in, updated_in
from psph.particles.reach import Reach
from psph.physics.solid.contact import REACH as CONTACT
from psph.physics.solid.deformation import HOURGLASS, SHARED_HOURGLASS, SMOOTHING
from psph.physics.solid.material import MADE_OF, ElasticSolid, solid_of
from psph.physics.solid.motion import Immersed, Riding
from psph.scene.parts.hookean import HookeanPart, StressedPart
from psph.scene.parts.part import Known, Part

BEYOND = 0.1
"""Spacings: more than two particles approach each other in a step of a fluid."""


class UpdatedPart(StressedPart):
    """A solid whose neighbours are those of the present: updated Lagrangian."""

    keeps_form = True


@dataclass(frozen=True)
class ElasticPart(HookeanPart):
    """A solid whose neighbours are those of the start: total Lagrangian; ``made`` is what it is made of,
    without the damping that depends on the speed of sound."""

    made: Any = None

    keeps_neighbours = True
    keeps_form = True
    looks = "elastic solid"

    @property
    def ends_kernel(self) -> bool:
        """In a fluid."""
        return isinstance(self.motion, Immersed)

    @property
    def may_crack(self) -> bool:
        """Whether its bonds may be cut."""
        return self.made.critical_stretch < math.inf

    @property
    def wave_speed(self) -> float:
        """Of what it is made of."""
        return self.made.wave_speed

    @property
    def wave_modulus(self) -> float:
        """Of what it is made of."""
        return self.made.density * self.made.wave_speed**2

    def reach(self, whole: Reach, spacing: float, contact: bool) -> Reach | None:
        """Alone it touches others within 2.5 spacings, and what the kernel reaches beyond that is skin, one
        spacing at least.  In a fluid it touches before new lists are made: lists then reach a little
        farther."""
        support = CONTACT * spacing
        if not isinstance(self.motion, Immersed):
            return Reach(support, max(whole.cutoff - support, spacing))
        return whole._replace(support=max(whole.support, support + BEYOND * spacing)) if contact else None

    def own(self, known: Known) -> dict[str, Any]:
        """Beside its shear modulus what contacts know of it, and whether fluids stick to it."""
        return super().own(known) | _met(self, known) | {"no_slip": self.table.no_slip}


class ClampPart(HookeanPart):
    """A clamped part of a solid."""

    keeps_form = True
    looks = "elastic solid"

    def borne_by(self, other: Part) -> bool:
        """Whether it is fixed to a body, in which it may be."""
        return isinstance(self.motion, Riding) and other.moves_whole and other.name == self.motion.name

    def own(self, known: Known) -> dict[str, Any]:
        """The same as its solid, whose deviatoric stress does not evolve here."""
        own = super().own(known) | {"no_slip": self.table.no_slip}
        return own if self.bonded is None else own | _met(self, known)


def _met(part: HookeanPart, known: Known) -> dict[str, Any]:
    """The P-wave modulus by which a contact with a solid is stiff, and the true mass of its particles."""
    volume = (known.spacing / part.finer) ** len(known.gravity)
    return {"wave_modulus": known.wave_moduli[part.bonded], "own_mass": part.table.density * volume}


def clamps_in(case: Case) -> Iterator[tuple[str, str, Any]]:
    """Of each clamp the name of its solid, its key in the table of that, and its own table."""
    for name, solid in (updated_in(case) | referred_in(case)).items():
        for key, clamp in solid.grips.items():
            yield name, key, clamp


def solids_in(case: Case) -> tuple[ElasticSolid, ...]:
    """The total Lagrangian solids of a case, without damping.

    What is drawn out along an axis that repeats is a plate and has the hourglass control of 2D, so that both
    do the same.
    """
    shared = case.space.dimensions == 3 and not case.space.periodic
    return tuple(
        solid_of(
            name,
            **{key: getattr(table, key) for key in MADE_OF},
            **_control(table, shared),
            damping=0.0,
            johnson_cook=table.johnson_cook and dict(table.johnson_cook),
            mie_gruneisen=table.mie_gruneisen and dict(table.mie_gruneisen),
            length=SMOOTHING * case.space.spacing / table.finer(case.space.spacing),
            finer=table.finer(case.space.spacing),
            hyperelastic=table.hyperelastic and table.hyperelastic.law,
            sheet=table.plane == STRESS,
            branches=branches(table.relaxation),
        )
        for name, table in referred_in(case).items()
    )


def _control(table, shared: bool) -> dict[str, Any]:
    """The hourglass control of a solid: as given, or by default, which is ``shared`` in bars."""
    if table.hourglass is not None:
        return {"hourglass": table.hourglass, "shared": False}
    return {"hourglass": SHARED_HOURGLASS if shared else HOURGLASS, "shared": shared}
