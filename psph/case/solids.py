"""Elastic solids of a case, and the rules between their keys."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Field, Strict, create_model

import psph.acts as words
from psph.acts import BODIES, refusals
from psph.case.elastic import STRAIN, Plane, Relaxing, SolidLoad, elastic_keys, hyperelastic, modulus
from psph.case.errors import advise
from psph.case.findings import Finding
from psph.case.hooke import Hookean
from psph.case.keys import Name, Table, Text, Vector, key
from psph.case.motion import PADDLES, Motions
from psph.case.placed import Answering, HardPlane
from psph.case.shapes import Shape
from psph.case.updated import OF_SOLIDS, TOTAL, UPDATED, referred_in, updated, updated_in
from psph.physics.catalogue import ELASTIC_LAWS, Catalogue
from psph.physics.solid.anvil import Anvils
from psph.physics.solid.deformation import HOURGLASS, SHARED_HOURGLASS
from psph.physics.solid.laws import LAWS
from psph.physics.solid.viscous import MOST


class Clamp(Table):
    """A part of a solid that forces do not move: it stays, or moves as a whole as it is told."""

    shape: Shape = key("the part of the solid, at the start")
    motion: Motions | None = key(
        "how it moves, as `walls.NAME.motion`; forces change nothing of it", None, otherwise="not at all"
    )
    body: Name | None = key("the rigid body that it is fixed to and that bears it", None, otherwise="none")


class JohnsonCookTable(Table):
    """The yield stress of Johnson and Cook: (A + B ε^n)(1 + C ln max(rate, 1))(1 − T*^m)."""

    yield_stress: float = key("A, at no plastic strain", unit="Pa", gt=0)
    hardening: float = key("B", 0.0, unit="Pa", ge=0)
    exponent: float = key("n", 1.0, unit="1", gt=0)
    rate: float = key("C, of the resistance to strain faster than 1/s", 0.0, unit="1", ge=0)
    softening: float = key("m, of the softening by heat", 1.0, unit="1", gt=0)
    melting: float = key(
        "how far the melting point is above the temperature at the start", 1e9, unit="K", gt=0
    )
    heat_capacity: float | None = key(
        "heat capacity by mass; plastic work then heats the solid, and no heat flows",
        None,
        unit="J/(kg K)",
        otherwise="the temperature stays",
        gt=0,
    )


class Shocked(Table):
    """A pressure by Mie and Grüneisen, from the Hugoniot curve U_s = c + S u_p; internal energy is booked."""

    slope: float = key(
        "S, how the speed of a shock grows with that of the matter behind it", unit="1", ge=0, le=4
    )
    gruneisen: float = key("Grüneisen's Γ", unit="1", ge=0, le=5)
    sound_speed: float | None = key(
        "c, that of the bulk", None, unit="m/s", otherwise="√(K/ρ), by young and poisson", gt=0
    )


class Anvil(HardPlane):
    """A rigid, frictionless plane, endless, that solids may hit."""

    normal: Vector = key("direction out of it, towards the solids, of any length", unit="1")


Hyperelastic = hyperelastic()


@words.speaks_for(words.SOLIDS)
class Solid(Hookean):
    """An elastic solid: total or updated Lagrangian SPH."""

    velocity: Vector | None = key("velocity at the start", None, unit="m/s", otherwise="zeros")
    spacing: float | None = key(
        "distance of its particles at the start, a half or a third of space.spacing: its shape still follows "
        "the lattice of the scene",
        None,
        unit="m",
        otherwise="space.spacing",
        gt=0,
    )
    density: float = key("density of the undeformed solid", unit="kg/m3", gt=0)
    hyperelastic: Hyperelastic | None = key(  # type: ignore[valid-type]
        "a law of rubber with numbers of its own", None, otherwise="law, with young and poisson"
    )
    young: Annotated[float, BeforeValidator(modulus)] = key(
        "Young's modulus E",
        None,
        unit="Pa",
        otherwise="that of hyperelastic at rest",
        gt=0,
        validate_default=True,
    )
    poisson: Annotated[float, BeforeValidator(modulus)] = key(
        "Poisson's ratio ν",
        None,
        unit="1",
        otherwise="that of hyperelastic at rest",
        gt=-1,
        lt=0.5,
        validate_default=True,
    )
    plane: Plane = key(
        "in 2D: strain, it keeps its length across; stress, a sheet, which nothing holds across", STRAIN
    )
    relaxation: Annotated[tuple[Relaxing, ...], Strict(False), Field(max_length=MOST)] = key(
        "shear moduli beside those of the law, which relax: the series of Prony", ()
    )
    description: Literal[TOTAL, UPDATED] = key(
        "total Lagrangian: its neighbours are those of the start, and its stress is that of its deformation; "
        "updated: its neighbours are those of the present, and its stress follows the flow (Jaumann)",
        TOTAL,
    )
    law: Literal[tuple(LAWS)] = key(
        "saint-venant-kirchhoff: Hooke's law for large rotations; neo-hookean: rubber", next(iter(LAWS))
    )
    yield_stress: float | None = key(
        "von Mises stress at which it yields (J2 plasticity)",
        None,
        unit="Pa",
        otherwise="it is elastic",
        gt=0,
    )
    hardening: float = key(
        "growth H of the yield stress with the equivalent plastic strain", 0.0, unit="Pa", ge=0
    )
    johnson_cook: JohnsonCookTable | None = key(
        "a yield stress that depends on strain, rate and heat, in the place of yield_stress",
        None,
        otherwise="it is elastic, or has yield_stress",
    )
    mie_gruneisen: Shocked | None = key(
        "the pressure of a metal that meets shocks", None, otherwise="linear in the compression"
    )
    damping: float | None = key(
        "viscosity η of the stress ηĖ of Kelvin and Voigt",
        None,
        unit="Pa s",
        otherwise="0; in a fluid enough to damp waves that its steps do not resolve",
        ge=0,
    )
    continues: Name | None = key(
        "the fluid whose density and initial pressure it shows to fluids around it",
        None,
        otherwise="the first fluid",
    )
    no_slip: bool = key("the fluid has the solid's velocity at its face; needs a viscosity", False)
    hourglass: float | None = key(
        "strength α of the control of zigzag modes, which cause no stress",
        None,
        unit="1",
        otherwise=f"{HOURGLASS:g}; in 3D, where no axis repeats, {SHARED_HOURGLASS:g} and shares",
        ge=0,
        le=10,
    )
    critical_stretch: float | None = key(
        "strain of a bond (length over that at the start, minus 1) beyond which it is cut for good: cracks",
        None,
        unit="1",
        otherwise="it holds",
        gt=0,
    )
    flaws: float | None = key(
        "Weibull modulus of the scatter of critical_stretch from particle to particle, by seed",
        None,
        unit="1",
        otherwise="the same everywhere",
        ge=1,
    )
    clamped: Shape | None = key("the part of the solid that stays where it is", None, otherwise="none")
    clamps: dict[Name, Clamp] = key("parts of the solid that stay, or move as they are told, by name", {})
    loads: dict[Name, SolidLoad] = key("forces on parts of the solid, by name", {})
    load_rise: float = key("time in which the loads grow to their full size", 0.0, unit="s", ge=0)

    called: ClassVar = "solid in a fluid"
    keeps_form: ClassVar = True
    not_absorbing: ClassVar = "a clamp"
    refuses: ClassVar = OF_SOLIDS

    @classmethod
    def with_more(cls, catalogue: Catalogue) -> type[Answering]:
        """With further laws."""
        if not catalogue.laws:
            return cls
        told, laws = cls.model_fields["hyperelastic"], hyperelastic((*ELASTIC_LAWS, *catalogue.laws))
        return create_model("Solid", __base__=cls, __doc__=cls.__doc__, hyperelastic=(laws | None, told))

    @classmethod
    def held_parts(cls, entry: Mapping[str, Any]) -> int:
        """Its clamps."""
        return len(entry.get("clamps", ())) + ("clamped" in entry)

    @property
    def word(self) -> str:
        """By its description."""
        return words.UPDATED if self.is_updated else words.SOLIDS

    def pushed(self, case) -> bool:
        """Where it stands in a fluid."""
        return bool(case.fluids)

    def motions(self) -> dict[tuple, Any]:
        """Those of its clamps."""
        return {("clamps", name): clamp.motion for name, clamp in self.clamps.items()}

    def said(self, table: str, name: str) -> tuple[tuple, Any]:
        """Its description, where that is not the usual one."""
        return ((table, name, "description"), self.description) if self.is_updated else ((table,), ...)

    @classmethod
    def contradictions(cls, case) -> Iterator[Finding]:
        """Solids that cannot be."""
        yield from elastic(case)

    @property
    def is_updated(self) -> bool:
        """Whether its neighbours are those of the present."""
        return self.description == UPDATED

    def finer(self, spacing: float) -> int:
        """The ``spacing`` of the scene, m, over its own: 1, 2 or 3."""
        return 1 if self.spacing is None else round(spacing / self.spacing)

    @property
    def grips(self) -> dict[str, Clamp]:
        """All its clamps by their keys: `clamped`, `clamps.NAME`."""
        still = {"clamped": Clamp.model_construct(shape=self.clamped)} if self.clamped else {}
        return still | {f"clamps.{name}": clamp for name, clamp in self.clamps.items()}

    def held(self, clamp: Clamp) -> "Solid":
        """The part in a clamp, at rest."""
        still = (0.0,) * len(self.velocity_center)
        return self.model_copy(
            update={"shape": clamp.shape, "velocity": still, "velocity_gradient": None, "loads": {}}
        )


def clamps_of(solids: dict[str, Solid]) -> list[str]:
    """The keys of the clamps of some solids, in their order: ``solids.beam.clamps.root``."""
    return [f"solids.{name}.{key}" for name, solid in solids.items() for key in solid.grips]


def anvils_of(case) -> list[str]:
    """The keys of the anvils of a case, in their order: ``anvils.floor``."""
    return [f"anvils.{name}" for name in case.anvils]


class Reaction(Table):
    """Force and moment that the supports of solids bear: clamps and anvils."""

    acts: ClassVar = (words.SOLIDS,)
    refuses: ClassVar = {
        words.UPDATED: "of the clamps of an updated Lagrangian solid no force is summed; give it "
        'description = "total"'
    }

    of: Annotated[tuple[Text, ...], Strict(False)] = key(
        "the keys of clamps and anvils, taken together, such as solids.beam.clamped, "
        "solids.beam.clamps.root or anvils.floor",
        min_length=1,
    )
    about: Vector | None = key("point about which moments are taken", None, unit="m", otherwise="zeros")

    def contradictions(self, case) -> Iterator[Finding]:
        """Supports that are not there, or of which no force is known."""
        known = [*clamps_of(referred_in(case)), *anvils_of(case)]
        for place, support in enumerate(self.of):
            if support in clamps_of(updated_in(case)):
                yield ("of", place), support, refusals(self)[words.UPDATED]
            elif support not in known:
                says = f"no clamp or anvil has this key; {advise(support, known)}"
                yield ("of", place), support, says


FINEST, SAME = 3, 1e-6
"""Of how many parts of the scene's spacing that of a solid may be one, and how near rounding has to be."""

NOT_MET = "nothing is known of contact between solids and these; remove one of the two"


def elastic(case) -> Iterator[Finding]:
    """Solids that cannot be, in a case with space.dimensions."""
    if not case.solids:
        if case.anvils:
            yield ("anvils",), ..., "nothing feels them but solids; remove them, or give [solids.NAME]"
        return
    yield from elastic_keys(case)
    yield from _finer(case)
    yield from updated(case) if updated_in(case) else _meeting(case)
    for name, anvil in case.anvils.items():
        if not any(anvil.normal):
            yield ("anvils", name, "normal"), anvil.normal, "has no direction; give the way out of the plane"
    here = ("solids",)
    for name in ("regions", *(["anvils"] if case.fluids else [])):
        if getattr(case, name, None):
            yield (name,), ..., NOT_MET
    if case.physics.sound_speed is not None and not case.fluids:
        says = "solids have waves of their own, by young and poisson; remove this key"
        yield ("physics", "sound_speed"), case.physics.sound_speed, says
    for name, solid in case.solids.items():
        if solid.continues is not None and solid.continues not in case.fluids:
            says = f"no fluid has this name; {advise(solid.continues, case.fluids)}"
            says = says if case.fluids else "there is no fluid to see the solid; remove it"
            yield (*here, name, "continues"), solid.continues, says


def _meeting(case) -> Iterator[Finding]:
    """What contact knows nothing of."""
    contact = case.physics.contact is not None
    if contact or not case.flowing:
        yield from _rigid(case)
    rigid = [entry for entry in case.entries if entry.of.rigid]
    carried = {clamp.body for solid in case.solids.values() for clamp in solid.grips.values()}
    for table, name, _ in rigid:
        if not contact and name not in carried and (name in case.bodies or not case.flowing):
            says = f"solids do not feel {table} without contact; give physics.contact = {{}}"
            yield (table, name), ..., says
    if case.flowing:
        return
    for table, name, one in rigid:
        here = (table, name)
        given = {
            "velocity": name in case.walls and any(one.velocity or ()),
            "condition": one.condition != type(one).model_fields["condition"].default,
            "no_slip": one.no_slip,
        }
        for key_of, asks in given.items():  # the copy of a case in its run's folder names all keys
            if asks:
                yield (*here, key_of), ..., "says what a fluid meets, and there is none; remove this key"
    for name, gauge in case.gauges.items():
        if gauge.kind == "force":
            says = "knows of forces by fluids alone, and there are none; give gauges.NAME.reaction"
            yield ("gauges", name, "force"), ..., says
    for name in case.probes:
        says = "measures fluids, and there are none; give gauges.NAME.displacement, or plot the frames"
        yield ("probes", name), ..., says


def _rigid(case) -> Iterator[Finding]:
    """Walls and bodies that solids cannot meet."""
    for name, wall in case.walls.items():
        if not all(part.is_rigid for part in wall.motion or () if len(part.ways) == 1):
            says = "solids meet walls that move as a whole, and this one deforms; remove this key"
            yield ("walls", name, "motion"), ..., says
        if not case.flowing and any(part.way in PADDLES for part in wall.motion or () if len(part.ways) == 1):
            yield ("walls", name, "motion"), ..., "a paddle makes waves, and there is no fluid; take another"
    for name in case.bodies.keys() & case.solids.keys():
        yield ("bodies", name), ..., "a solid has this name too; give the body another"
    if case.bodies and case.anvils:
        yield ("anvils",), ..., refusals(Anvils)[BODIES]


def _finer(case) -> Iterator[Finding]:
    """Spacings of solids that are no part of the scene's, or beside what knows of one alone."""
    dx = case.space.spacing
    for name, solid in case.solids.items():
        if solid.spacing is None:
            continue
        here = ("solids", name, "spacing")
        if abs(dx / solid.spacing - solid.finer(dx)) > SAME or not 1 <= solid.finer(dx) <= FINEST:
            fits = " or ".join(f"{dx / n:.6g}" for n in range(2, FINEST + 1))
            yield here, solid.spacing, f"is no half or third of space.spacing; give {fits}, or remove it"
        elif solid.finer(dx) > 1 and not case.fluids:
            yield here, solid.spacing, "there is no fluid of another spacing; give space.spacing instead"
        elif solid.finer(dx) > 1 and case.physics.contact is not None:
            yield here, solid.spacing, "contact knows of one spacing; remove this key, or physics.contact"
