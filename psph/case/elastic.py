"""How elastic solids of a case resist, by laws with numbers of their own, as sheets, with stress that
relaxes; and what pulls and pushes them."""

from collections.abc import Iterator, Sequence
from typing import Any, ClassVar, Literal, Self

from pydantic import ValidationInfo, create_model, model_validator
from pydantic_core import PydanticCustomError, PydanticKnownError

from psph.case.errors import advise
from psph.case.findings import Finding
from psph.case.keys import Table, Vector, key
from psph.case.parameters import chosen, last_part, table_of
from psph.case.shapes import Shape
from psph.physics.catalogue import ELASTIC_LAWS, Entry
from psph.physics.solid.trial import misfit
from psph.physics.solid.viscous import Branch

OF_METALS = "a solid that yields has a law of its own, Hooke's for the elastic part; remove law"

STRAIN, STRESS = "strain", "stress"
Plane = Literal["strain", "stress"]

SAME = 1e-6
"""How well Young's modulus and Poisson's ratio, where they are given too, have to fit a law."""


class OneLaw(Table):
    """A law of elasticity with numbers of its own: exactly one of these."""

    offered: ClassVar[Sequence[Entry]] = ()

    @property
    def law(self) -> Any:
        """The law (psph.physics.solid.rubber)."""
        [law] = chosen(self, self.offered).values()
        return law

    @model_validator(mode="after")
    def _is_one_law(self) -> Self:
        names = list(map(last_part, self.offered))
        given = [name for name in names if getattr(self, name) is not None]
        if len(given) != 1:
            said = f"{' and '.join(given)} in one solid" if given else "does not say its law"
            raise PydanticCustomError("psph", f"{said}; give one of {', '.join(names)}")
        if len({len(value) for value in self.law if isinstance(value, tuple)}) > 1:
            raise PydanticCustomError("psph", f"{given[0]} has lists of unlike lengths; give as many of each")
        if says := misfit(self.law):
            raise PydanticCustomError(
                "psph", "{says}", {"says": f"{given[0]} {says}; see docs/recipes/law.md"}
            )
        lame, shear = self.law.moduli()
        if shear <= 0.0 or 3.0 * lame + 2.0 * shear <= 0.0:
            raise PydanticCustomError(
                "psph",
                f"{given[0]} has a shear modulus of {shear:.4g} Pa and a bulk modulus of "
                f"{lame + 2.0 * shear / 3.0:.4g} Pa at rest; let both be above 0",
            )
        return self


def hyperelastic(entries: Sequence[Entry] = ELASTIC_LAWS) -> type[OneLaw]:
    """The table of laws that a catalogue offers."""
    meaning = OneLaw.__doc__ or ""
    table: Any = create_model(
        "Hyperelastic", __base__=(OneLaw, table_of("Hyperelastic", meaning, entries)), __doc__=meaning
    )
    table.offered = tuple(entries)
    return table


class Relaxing(Table):
    """A branch beside the law that lasts: a spring behind a dashpot."""

    shear: float = key("shear modulus G of the spring", unit="Pa", gt=0)
    time: float = key("in which it forgets its stress, τ", unit="s", gt=0)


def branches(relaxation: Sequence[Relaxing]) -> tuple[Branch, ...]:
    """What relaxes (psph.physics.solid.viscous)."""
    return tuple(Branch(one.shear, one.time) for one in relaxation)


def modulus(value: Any, info: ValidationInfo) -> Any:
    """E in Pa or ν, which follow from the law of a solid where it has one with numbers of its own."""
    law, name = info.data.get("hyperelastic"), info.field_name
    if law is None:
        if value is None and "hyperelastic" in info.data:
            raise PydanticKnownError("missing")
        return value
    lame, shear = law.law.moduli()
    bulk = lame + 2.0 * shear / 3.0
    young = 9.0 * bulk * shear / (3.0 * bulk + shear)
    found = young if name == "young" else 0.5 * young / shear - 1.0
    if isinstance(value, (int, float)) and abs(value - found) > SAME * max(abs(found), SAME):
        raise PydanticCustomError("psph", f"is {found:.6g} by hyperelastic; remove this key")
    return found


class SolidLoad(Table):
    """A force on a part of a solid, the same on each of its particles, whatever its deformation; or a
    pressure on the faces of a part, which follows them."""

    shape: Shape = key("the part of the solid that it pulls or pushes, at the start")
    force: Vector | None = key(
        "the total force; in 2D per metre of depth", None, unit="N", otherwise="a pressure"
    )
    pressure: float | None = key(
        "pushes on the faces of the part, across them as they turn and grow",
        None,
        unit="Pa",
        otherwise="a force",
    )
    facing: Vector | None = key(
        "the side that the pressed faces look to, of any length", None, unit="1", otherwise="any side"
    )

    @model_validator(mode="after")
    def _is_one(self) -> Self:
        if (self.force is None) == (self.pressure is None):
            raise PydanticCustomError("psph", "is a force or a pressure; give one of the two")
        if self.facing is not None and (self.pressure is None or not any(self.facing)):
            says = "has no direction" if self.pressure is not None else "is of a pressure, and there is none"
            raise PydanticCustomError("psph", f"facing {says}; give another, or remove it")
        return self


def elastic_keys(case) -> Iterator[Finding]:
    """Contradictions between these keys and others of a solid."""
    yield from _yielding(case)
    for name, solid in case.solids.items():
        here, yields = ("solids", name), solid.johnson_cook or solid.yield_stress is not None
        if solid.hyperelastic and yields:
            yield (*here, "hyperelastic"), ..., "a solid that yields has Hooke's law; remove one of the two"
        if solid.hyperelastic and solid.law != type(solid).model_fields["law"].default:
            yield (*here, "law"), solid.law, "hyperelastic is the law; remove one of the two"
        if solid.relaxation and yields:
            says = "metals that relax are not known; remove it, or yield_stress"
            yield (*here, "relaxation"), ..., says
        for key_of, clamp in solid.grips.items():
            of = (*here, *key_of.split("."), "body")
            if clamp.body is not None and clamp.body not in case.bodies:
                yield of, clamp.body, f"no rigid body has this name; {advise(clamp.body, case.bodies)}"
            elif clamp.body is not None and clamp.motion:
                yield of, clamp.body, "goes as its body does; remove it, or motion"
            elif clamp.body is not None and solid.is_updated:
                yield of, clamp.body, 'needs description = "total"; remove it'
        if solid.plane == STRESS:
            if case.space.dimensions != 2:
                yield (*here, "plane"), STRESS, "a sheet has two dimensions; remove it, or draw its thickness"
            if yields or solid.relaxation:
                says = "is known of laws without a memory; remove it, or what yields and relaxes"
                yield (*here, "plane"), STRESS, says


def _yielding(case) -> Iterator[Finding]:
    """Contradictions between the keys of a solid that yields."""
    for name, solid in case.solids.items():
        here, table = ("solids", name), solid.johnson_cook
        if table and solid.yield_stress is not None:
            says = "johnson_cook has a yield_stress of its own; remove one of the two"
            yield (*here, "yield_stress"), solid.yield_stress, says
        if solid.mie_gruneisen and not table and solid.yield_stress is None:
            says = "a pressure of metals; give yield_stress too, as large as you like"
            yield (*here, "mie_gruneisen"), ..., says
        if solid.flaws is not None and solid.critical_stretch is None:
            yield (
                (*here, "flaws"),
                solid.flaws,
                "without critical_stretch nothing cracks; give it, or remove flaws",
            )
        if solid.critical_stretch is not None and case.flowing:
            yield (
                (*here, "critical_stretch"),
                ...,
                "nothing is known of cracks in fluids; remove it, or the fluids",
            )
        if solid.hardening and solid.yield_stress is None:
            says = "an elastic solid does not harden; give yield_stress, or put it into johnson_cook"
            yield (*here, "hardening"), solid.hardening, says
        if (table or solid.yield_stress is not None) and solid.law != type(solid).model_fields["law"].default:
            yield (*here, "law"), solid.law, OF_METALS
