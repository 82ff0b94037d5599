"""Fluids of a case, and the rules between their keys."""

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, ValidationError, WrapValidator, create_model
from pydantic_core import PydanticCustomError

from psph.acts import FLUIDS
from psph.case.findings import Finding, frictions_of
from psph.case.keys import AXES, Name, key
from psph.case.matter import RELAXED, FreeMatter, relaxed_findings
from psph.case.physics import own_law
from psph.case.placed import Answering
from psph.case.rheology import Rheology
from psph.case.shapes import Shape
from psph.case.study import EXACT
from psph.case.tensions import tension_findings
from psph.physics.catalogue import BUILT_IN, Catalogue
from psph.theory.solutions.catalogue import SOLUTIONS, is_compressible, known

HYDROSTATIC = "hydrostatic"
"""The pressure at the start of a fluid that is under its own weight."""

Law, LAW = own_law()


def _pressure(value: Any, validate) -> Any:
    """One message for anything that is not a pressure."""
    try:
        return validate(value)
    except ValidationError as error:
        raise PydanticCustomError(
            "psph", 'not a pressure; give a number in Pa, "hydrostatic" or "exact"'
        ) from error


class Fluid(FreeMatter):
    """A fluid: where it is at the start, and what it is."""

    shape: Shape = key("where the fluid is at the start")
    density: float = key("density at zero pressure", 1000.0, unit="kg/m3", gt=0)
    viscosity: float = key("kinematic viscosity; 0: inviscid", 0.0, unit="m2/s", ge=0)
    rheology: Rheology | None = key(
        "a viscosity that depends on the rate of strain, as that of mud or grains",
        None,
        otherwise="the constant `viscosity`",
    )
    start: Literal["lattice", RELAXED] = key(
        'where particles are at the start: "lattice", or "relaxed", without order but evenly crowded',
        "lattice",
    )
    surface_tension: float | None = key(
        "surface tension at its free surface", None, unit="N/m", otherwise="0", ge=0
    )
    interfacial_tension: dict[Name, Annotated[float, Field(ge=0)]] = key(
        "tension between it and other fluids, by their names: { oil = 0.03 }, in the table of either", {}
    )
    equation_of_state: Law = LAW
    sound_speed: float | None = key(
        "numerical speed of sound of this fluid: a light one that may be trapped needs more than the others",
        None,
        unit="m/s",
        otherwise="physics.sound_speed",
        gt=0,
    )
    pressure: Annotated[Literal[HYDROSTATIC, EXACT] | float, WrapValidator(_pressure)] = key(
        'pressure at the start: a number, "hydrostatic" (needs gravity) or "exact" (needs [exact])',
        0.0,
        unit="Pa",
    )

    word: ClassVar = FLUIDS
    poured: ClassVar = True

    @property
    def rubs(self) -> bool:
        """Whether it has a friction of its own."""
        return bool(self.viscosity) or self.rheology is not None

    @classmethod
    def with_more(cls, catalogue: Catalogue) -> type[Answering]:
        """With further equations of state."""
        if catalogue.states == BUILT_IN.states:
            return cls
        law = own_law(catalogue.states)
        return create_model("Fluid", __base__=cls, __doc__=cls.__doc__, equation_of_state=law)

    @classmethod
    def contradictions(cls, case) -> Iterator[Finding]:
        """Pressures, flows and laws that cannot be, and names of walls."""
        yield from _hydrostatic(case)
        yield from _exact(case)
        yield from _rheologies(case)
        for name, fluid in case.fluids.items():
            yield from relaxed_findings(case, ("fluids", name), fluid)
        yield from tension_findings(case)
        for name in case.walls.keys() & case.fluids.keys():
            yield ("walls", name), ..., "a fluid has this name too; give the wall another"


def _hydrostatic(case) -> Iterator[Finding]:
    gravity = case.physics.gravity
    pulls = zip(AXES, gravity.acceleration) if gravity is not None else ()
    if any(g for axis, g in pulls if axis not in case.space.periodic):
        return
    says = "there is no gravity; give physics.gravity, or a pressure in Pa"
    if gravity is not None and any(gravity.acceleration):
        says = "gravity pulls along periodic axes alone, where nothing has a height; give a pressure in Pa"
    for name, fluid in case.fluids.items():
        if fluid.pressure == HYDROSTATIC:
            yield ("fluids", name, "pressure"), fluid.pressure, says


def _exact(case) -> Iterator[Finding]:
    """What a fluid asks of an exact solution that does not have it."""
    solution = next((name for name, value in case.exact if value is not None), None)
    fields = known(SOLUTIONS[solution]) if solution else ()
    if solution and is_compressible(solution) and case.fluids:
        yield ("exact", solution), ..., "is of ideal gases, not of fluids; remove this table"
    for name, fluid in case.fluids.items():
        for field in ("velocity", "pressure"):
            if getattr(fluid, field) == EXACT and field not in fields:
                yield (
                    ("fluids", name, field),
                    EXACT,
                    (
                        f"the exact solution {solution} has no {field}; give numbers"
                        if solution
                        else "the case has no exact solution; give [exact], or numbers"
                    ),
                )


def _rheologies(case) -> Iterator[Finding]:
    fluids = case.fluids
    for name in () if any(fluid.rubs for fluid in fluids.values()) else frictions_of(case):
        yield (
            ("physics", name),
            ...,
            "no fluid has a viscosity; set fluids.NAME.viscosity or .rheology, or remove this key",
        )
    for name, fluid in fluids.items():
        if fluid.rheology is None:
            continue
        if case.physics.laplacian_friction is not None:
            yield (
                ("physics", "laplacian_friction"),
                ...,
                f"is for constant viscosities; remove it, or fluids.{name}.rheology",
            )
        if fluid.viscosity:
            yield (
                ("fluids", name, "viscosity"),
                fluid.viscosity,
                "the fluid also has a rheology, which gives its viscosity; remove one of the two",
            )
        grains = fluid.rheology.granular
        if grains is not None and grains.grain_density < fluid.density:
            yield (
                ("fluids", name, "rheology", "granular", "grain_density"),
                grains.grain_density,
                f"grains with room between them weigh {fluid.density:g} kg/m³ (fluids.{name}.density), and a "
                "grain itself less; give a larger grain_density",
            )
