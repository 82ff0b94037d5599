"""A case: all keys of a case file, typed and frozen."""

import re
from functools import cached_property
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self, TypeAlias

import tomli_w
from pydantic import PrivateAttr, Strict, ValidationError, WrapValidator, model_validator
from pydantic_core import PydanticCustomError

from psph.case.bodies import Body
from psph.case.consistency import contradictions, walk
from psph.case.errors import dotted
from psph.case.extensions import versions
from psph.case.gauges import Gauge
from psph.case.keys import SIDES, Axis, Name, Table, Text, Vector, key
from psph.case.matter import FreeMatter
from psph.case.mesh import Mesh
from psph.case.motion import Motions, series_in
from psph.case.physics import own_law, physics_table
from psph.case.profiles import OFF, PROFILES, choices
from psph.case.rheology import Rheology
from psph.case.running import Checkpoint, GuardKeys, NeighbourLists, Output, Parallel, Perturbation, Probe
from psph.case.schemes import SCHEMES, STABLE, scheme_keys
from psph.case.shapes import Shape
from psph.case.soils import Soil
from psph.case.solids import Anvil, Solid
from psph.case.study import EXACT, Experiment, Study, exact_table
from psph.physics.catalogue import BUILT_IN, Catalogue
from psph.physics.walls.conditions import BEARING, CONDITIONS, DYNAMIC, MIRROR
from psph.smoothing import KERNELS

if TYPE_CHECKING:  # made from the catalogues of effects and solutions
    Physics: TypeAlias = Any
    Exact: TypeAlias = Any
else:
    Physics, Exact = physics_table(), exact_table()

LIST_OVER_LINES = re.compile(r"\[\n((?: +[^\s\[\]{}]+,\n)+) *\]")
"""How tomli_w writes a list of numbers or words, one a line."""


def _pressure(value: Any, validate) -> Any:
    """One message for anything that is not a pressure."""
    try:
        return validate(value)
    except ValidationError as error:
        raise PydanticCustomError(
            "psph", 'not a pressure; give a number in Pa, "hydrostatic" or "exact"'
        ) from error


class Space(Table):
    """Dimensions, resolution and extent."""

    dimensions: int = key("number of dimensions, 1 to 3", ge=1, le=3)
    spacing: float = key("distance between particles at the start", unit="m", gt=0)
    smoothing: float = key(
        "smoothing length h in units of the spacing, h/dx",
        1.4,
        unit="1",
        ge=0.6,
        le=4,
    )
    kernel: Literal[tuple(KERNELS)] = key("smoothing kernel", next(iter(KERNELS)))
    normalised: bool = key(
        "divide the kernel gradient by its first moment on the initial lattice",
        False,
    )
    periodic: Annotated[tuple[Axis, ...], Strict(False)] = key("periodic axes", ())
    symmetry: Annotated[tuple[Literal[SIDES], ...], Strict(False)] = key(
        "sides of the domain that are planes of symmetry: the flow before one is mirrored behind it", ()
    )
    lower: Vector | None = key(
        "lowest corner of the domain; required where an axis is periodic or has a plane of symmetry",
        None,
        unit="m",
        otherwise="found from the shapes",
    )
    upper: Vector | None = key(
        "highest corner of the domain; required where an axis is periodic or has a plane of symmetry",
        None,
        unit="m",
        otherwise="found from the shapes",
    )
    origin: Vector | None = key(
        "origin of the lattice: particles start at origin + (k + 1/2) spacing, k whole",
        None,
        unit="m",
        otherwise="zeros",
    )


class Time(Table):
    """Simulated time and time steps."""

    end: float = key("simulated time at which the run ends", unit="s", gt=0)
    cfl: float = key("time step in units of h/(c + largest speed)", 0.2, unit="1", gt=0, le=0.5)
    gather_every: int = key(
        "corrected gradients and other slow sums are renewed every so many steps", 1, ge=1
    )
    step: float | None = key("a fixed time step", None, unit="s", otherwise="chosen in each step", gt=0)


Law, LAW = own_law()


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
    equation_of_state: Law = LAW
    pressure: Annotated[Literal["hydrostatic", EXACT] | float, WrapValidator(_pressure)] = key(
        'pressure at the start: a number, "hydrostatic" (needs gravity) or "exact" (needs [exact])',
        0.0,
        unit="Pa",
    )

    @property
    def rubs(self) -> bool:
        """Whether it has a friction of its own."""
        return bool(self.viscosity) or self.rheology is not None


class Wall(Table):
    """A wall: particles that stay where they are, or move as they are told."""

    shape: Shape = key("where the wall is")
    velocity: Vector | None = key(
        "velocity at which its surface drags viscous fluid along, as a belt does: the wall itself stays",
        None,
        unit="m/s",
        otherwise="zeros",
    )
    motion: Motions | None = key(
        "how the wall moves: one part, or a list of parts that act one after the other",
        None,
        otherwise="it stays where it is",
    )
    no_slip: bool = key(
        "the fluid has the wall's velocity at the face of the wall; needs a viscosity",
        False,
    )
    condition: Literal[CONDITIONS] = key(
        "dynamic: the density of the wall's particles evolves as that of the fluid; extrapolated: their "
        "pressure is that of the nearby fluid, continued hydrostatically; repulsive: they repel the fluid; "
        "penalty: they push back what is nearer than half a spacing (these two bear no pressure); mirror: "
        "there are no particles, and the fluid is mirrored at a plane: the shape is a box along a whole side "
        "of the fluids, or a box around them minus a box",
        DYNAMIC,
    )
    continues: Name | None = key(
        "the fluid, or soil, whose density and initial pressure the wall has",
        None,
        otherwise="the first fluid, or soil",
    )
    displaces: bool = key("it replaces fluid and soil where they overlap at the start, as a body does", False)

    @model_validator(mode="after")
    def _has_particles_to_displace(self) -> Self:
        if self.displaces and self.condition == MIRROR:
            raise PydanticCustomError(
                "psph", "displaces is of a wall with particles, which a mirror has not; remove it"
            )
        return self


class ReferenceFrame(Table):
    """A frame of reference that moves: places and velocities are told in it."""

    motion: Motions | None = key(
        "how the frame moves, as `walls.NAME.motion`: the fluid feels forces of inertia, and gravity turns",
        None,
        otherwise="it rests",
    )


MANY = 100
"""Limit on fluids and on walls: a material is stored as one byte."""


class Case(Table):
    """A case with every default filled in that does not depend on the particles.

    Made by :func:`psph.case.load`.  ``file`` is where it came from, ``name`` its stem.
    """

    title: Text = key("title of the case, one line", "")
    use: Annotated[tuple[Text, ...], Strict(False)] = key(
        "Python files in the folder of the case or below that bring effects, motions or regions", ()
    )
    scheme: Literal[tuple(SCHEMES)] = key(
        "stable: the default; sph: plain SPH; ssph: the paper's; solid: for updated Lagrangian solids; "
        "for keys that the case does not give",
        STABLE,
    )
    profile: Literal[tuple(PROFILES)] | None = key(
        "changes of the default scheme by one name", None, otherwise="no profile"
    )
    precision: Literal["double", "mixed"] = key(
        "mixed: pairs in single precision, particles and time integration in double", "double"
    )
    space: Space = key("dimensions, resolution and extent")
    time: Time = key("simulated time and time steps")
    physics: Physics = key("forces and other effects on the fluids", make=Physics)
    fluids: dict[Name, Fluid] = key(
        "the fluids by name: where each is at the start, and what it is",
        {},
        max_length=MANY,
    )
    soils: dict[Name, Soil] = key("the soils by name: alone, or beside fluids", {}, max_length=MANY)
    solids: dict[Name, Solid] = key("the elastic solids by name: alone, or in fluids", {}, max_length=MANY)
    anvils: dict[Name, Anvil] = key("rigid planes that solids may hit, by name", {}, max_length=MANY)
    walls: dict[Name, Wall] = key(
        "the walls by name: particles that the fluid runs into", {}, max_length=MANY
    )
    bodies: dict[Name, Body] = key("the rigid bodies by name", {}, max_length=MANY)
    frame: ReferenceFrame = key("a frame of reference that moves", make=ReferenceFrame)
    probes: dict[Name, Probe] = key("the probes by name: points where fields are measured over time", {})
    gauges: dict[Name, Gauge] = key(
        "the gauges by name: forces, levels, flows and others, each with a table of its own", {}
    )
    perturbations: Annotated[tuple[Perturbation, ...], Strict(False)] = key(
        "kicks and shifts of single particles", ()
    )
    output: Output = key("intervals of output", make=Output)
    checkpoint: Checkpoint = key(
        "when a run writes a checkpoint, besides the one at a signal", make=Checkpoint
    )
    guards: GuardKeys = key("bounds that a run checks, and what it does when one is exceeded", make=GuardKeys)
    parallel: Parallel = key("how the domain is divided among ranks", make=Parallel)
    neighbours: NeighbourLists = key("the neighbour lists", make=NeighbourLists)
    exact: Exact = key("an exact solution of the case, for its initial state and its errors", make=Exact)
    experiments: dict[Name, Experiment] = key("experiments by name: measured curves to compare with", {})
    study: Study = key("the keys that `python -m psph study` varies, and its measure of error", make=Study)

    offered: ClassVar[Catalogue] = BUILT_IN
    _file: str = PrivateAttr("case")

    @property
    def file(self) -> str:
        """The file as the person named it."""
        return self._file

    @property
    def catalogue(self) -> Catalogue:
        """Everything that the case can ask for."""
        return self.offered

    @property
    def name(self) -> str:
        """The file's name without folder and ending."""
        return Path(self._file).stem

    @property
    def loaded(self) -> set[str]:
        """Names of walls, bodies and solids on which the fluid's push is asked for; with a wall all that bear
        it, since parts that meet share it."""
        gauged = {name for gauge in self.gauges.values() if gauge.force for name in gauge.force.on}
        if not gauged.isdisjoint(self.boundaries):
            gauged |= {name for name, one in self.boundaries.items() if one.condition in BEARING}
        return gauged | set(self.bodies)

    @property
    def flowing(self) -> dict[str, Any]:
        """What moves freely and finds its neighbours in space, by name: fluids, soils, then solids that are
        updated Lagrangian."""
        return {**self.fluids, **self.soils, **self.updated}

    @property
    def updated(self) -> dict[str, Solid]:
        """The solids whose neighbours are those of the present, by name."""
        return {name: solid for name, solid in self.solids.items() if solid.is_updated}

    @property
    def referred(self) -> dict[str, Solid]:
        """The solids whose neighbours are those of the start, by name: total Lagrangian."""
        return {name: solid for name, solid in self.solids.items() if not solid.is_updated}

    @property
    def boundaries(self) -> dict[str, Wall | Body]:
        """Walls and bodies by name."""
        return {**self.walls, **self.bodies}

    def table_of(self, name: str) -> str:
        """The table that holds what has this name: solids may share it with others, which come first."""
        tables = ("walls", "bodies", "fluids", "soils", "solids")
        return next(table for table in tables if name in getattr(self, table))

    @property
    def series(self) -> list:
        """The series of motions that the case names (psph.case.motion.Series)."""
        return [series for parts in self.motions.values() for series in series_in(parts)]

    @property
    def motions(self) -> dict[tuple[str, ...], tuple]:
        """The parts of each motion of the case, by the location of its key."""
        found = {(self.table_of(name), name): one.motion for name, one in self.boundaries.items()}
        for name, solid in self.solids.items():
            found |= {("solids", name, "clamps", grip): one.motion for grip, one in solid.clamps.items()}
        found[("frame",)] = self.frame.motion
        return {(*loc, "motion"): parts for loc, parts in found.items() if parts}

    @cached_property
    def meshes(self) -> dict[str, Mesh]:
        """The shapes that geometry files draw, by their dotted keys."""
        return {dotted(loc): value for loc, value in walk(self) if isinstance(value, Mesh)}

    @property
    def versions(self) -> list[str]:
        """A word for each file that the case uses: another content gives another word."""
        named = (*self.series, *self.meshes.values())
        return [*versions(self.catalogue), *(one.found.digest for one in named)]

    @cached_property
    def presets(self) -> dict[str, tuple[str, Any]]:
        """Dotted keys that the case's profile or scheme sets: the name of that, and the value."""
        space, surface = self.space, self.physics.free_surface is not None
        named = [(f"scheme {self.scheme}", scheme_keys(self.scheme, surface))]
        if self.profile:
            keys = choices(self.profile, space.dimensions, space.periodic)
            named.append((f"profile {self.profile}", keys))
        return {key: (name, value) for name, keys in named for key, value in keys.items()}

    def preset(self, dotted: str) -> str | None:
        """The profile or scheme that gave a key its value, or None."""
        name, wanted = self.presets.get(dotted, (None, None))
        if name is None:
            return None
        value = attrgetter(dotted)(self)
        if isinstance(value, Table) and wanted != OFF:
            return name if value == type(value).model_validate(wanted) else None
        return name if (OFF if value is None else value) == wanted else None

    def under(self, name: str) -> Self:
        """This case as from a file of that ``name`` in the same folder."""
        case = self.model_copy()
        case._file = str(Path(self._file).with_name(f"{name}.toml"))
        return case

    def to_toml(self) -> str:
        """This case as TOML that :func:`psph.case.load` reads back to an equal case."""
        text = tomli_w.dumps(self.as_tables())
        return LIST_OVER_LINES.sub(lambda found: f"[{' '.join(found[1].split())[:-1]}]", text)

    def as_tables(self) -> dict[str, Any]:
        """What :meth:`to_toml` writes: all keys that have a value."""
        tables = self.model_dump(by_alias=True, exclude_none=True)
        for name in self.presets:
            table, _, effect = name.rpartition(".")
            if table:  # what the case switched off must not return with a profile or scheme
                tables[table].setdefault(effect, OFF)
        return {name: value for name, value in tables.items() if value}

    @model_validator(mode="after")
    def _agree(self) -> Self:
        if found := contradictions(self):
            raise ValidationError.from_exception_data("case", found)
        return self

    @model_validator(mode="after")
    def _resolve(self) -> Self:
        end, zeros = self.time.end, (0.0,) * self.space.dimensions
        _fill(self.space, origin=zeros)
        _fill(self.output, frames=end / 50, probes=end / 1000, log=end / 200)
        for matter in (*self.flowing.values(), *self.referred.values()):
            _fill(matter, velocity=zeros, velocity_center=zeros)
        for solid in self.referred.values():
            _fill(solid, continues=next(iter(self.fluids), None))
        for gauge in self.gauges.values():
            _fill(gauge, every=self.output.probes)
            if turned := gauge.force or gauge.reaction:
                _fill(turned, about=zeros)
        for one in self.perturbations:
            _fill(one, velocity=zeros, shift=zeros)
        for solid in self.boundaries.values():
            _fill(solid, velocity=zeros, continues=next(iter(self.flowing), None))
        return self


def _fill(table: Table, **defaults: Any) -> None:
    """Give keys that were left out what depends on other tables."""
    for name, value in defaults.items():
        if getattr(table, name) is None:
            table.__dict__[name] = value  # the table is frozen, but the case is not complete yet


def schema() -> dict[str, Any]:
    """The JSON schema of a case: every key with its description, unit and default."""
    return Case.model_json_schema()
