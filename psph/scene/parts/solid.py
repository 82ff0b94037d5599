"""Elastic solids as parts of a scene: their clamped parts, what they are made of, and what they may hit."""

import math
from collections.abc import Iterator
from typing import Any

from psph.case import Case
from psph.physics.solid.deformation import HOURGLASS, SHARED_HOURGLASS, SMOOTHING
from psph.physics.solid.material import MADE_OF, ElasticSolid, solid_of
from psph.scene.parts.hookean import HookeanPart, StressedPart
from psph.scene.parts.part import Known


class UpdatedPart(StressedPart):
    """A solid whose neighbours are those of the present: updated Lagrangian."""


class ElasticPart(HookeanPart):
    """A solid whose neighbours are those of the start: total Lagrangian."""

    is_elastic = True

    def own(self, known: Known) -> dict[str, Any]:
        """Beside its shear modulus what contacts know of it."""
        return super().own(known) | _met(self, known)


class ClampPart(HookeanPart):
    """A clamped part of a solid."""

    is_clamp = True

    def own(self, known: Known) -> dict[str, Any]:
        """The same as its solid, whose deviatoric stress does not evolve here."""
        own = super().own(known)
        return own if self.elastic is None else own | _met(self, known)


def _met(part: HookeanPart, known: Known) -> dict[str, Any]:
    """The P-wave modulus by which a contact with a solid is stiff, and the true mass of its particles."""
    volume = known.spacing ** len(known.gravity)
    return {"wave_modulus": known.wave_moduli[part.elastic], "own_mass": part.table.density * volume}


def clamps_in(case: Case) -> Iterator[tuple[str, str, Any]]:
    """Of each clamp the name of its solid, its key in the table of that, and its own table."""
    for name, solid in (case.updated | case.referred).items():
        for key, clamp in solid.grips.items():
            yield name, key, clamp


def solids_in(case: Case, repeats: bool) -> tuple[ElasticSolid, ...]:
    """The total Lagrangian solids of a case, without damping; ``repeats`` says whether an axis does.

    What is drawn out along an axis that repeats is a plate and has the hourglass control of 2D, so that both
    do the same.
    """
    shared = case.space.dimensions == 3 and not repeats
    return tuple(
        solid_of(
            name,
            **{key: getattr(table, key) for key in MADE_OF},
            **_control(table, shared),
            damping=0.0,
            johnson_cook=table.johnson_cook and dict(table.johnson_cook),
            mie_gruneisen=table.mie_gruneisen and dict(table.mie_gruneisen),
            length=SMOOTHING * case.space.spacing,
        )
        for name, table in case.referred.items()
    )


def _control(table, shared: bool) -> dict[str, Any]:
    """The hourglass control of a solid: as given, or by default, which is ``shared`` in bars."""
    if table.hourglass is not None:
        return {"hourglass": table.hourglass, "shared": False}
    return {"hourglass": SHARED_HOURGLASS if shared else HOURGLASS, "shared": shared}


def anvils_in(case: Case) -> tuple[tuple[tuple[float, ...], tuple[float, ...]], ...]:
    """A point of each anvil of a case in m, and the unit vector out of it."""
    tables = case.anvils.values()
    return tuple((one.at, tuple(n / math.hypot(*one.normal) for n in one.normal)) for one in tables)
