"""A case: all keys of a case file, typed and frozen."""

import re
from functools import cached_property
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Self, TypeAlias, TypeVar, get_args

import tomli_w
from pydantic import PrivateAttr, Strict, ValidationError, model_validator

from psph.case.consistency import contradictions, walk
from psph.case.courses import Columned
from psph.case.drawing import Drawing
from psph.case.errors import dotted
from psph.case.extensions import versions
from psph.case.findings import keys_one_sided
from psph.case.gauges import Gauge
from psph.case.keys import Name, Table, key
from psph.case.mesh import Mesh
from psph.case.motion import Motions, series_in
from psph.case.numbers import NumberOf
from psph.case.placed import Answering, Named, Placed
from psph.case.profiles import OFF, choices
from psph.case.refined import finer_of
from psph.case.running import Checkpoint, GuardKeys, NeighbourLists, Output, Parallel, Perturbation, Probe
from psph.case.schemes import scheme_keys
from psph.case.shapes import Shell
from psph.case.study import Experiment, Study, exact_table
from psph.case.tables import WithMatter
from psph.physics.catalogue import BUILT_IN, Catalogue
from psph.physics.walls.conditions import BEARING

if TYPE_CHECKING:  # made from the catalogue of solutions
    Exact: TypeAlias = Any
else:
    Exact = exact_table()

T = TypeVar("T", bound=Answering)

LIST_OVER_LINES = re.compile(r"\[\n((?: +[^\s\[\]{}]+,\n)+) *\]")
"""How tomli_w writes a list of numbers or words, one a line."""


class ReferenceFrame(Table):
    """A frame of reference that moves: places and velocities are told in it."""

    motion: Motions | None = key(
        "how the frame moves, as `walls.NAME.motion`: the fluid feels forces of inertia, and gravity turns",
        None,
        otherwise="it rests",
    )


class Case(WithMatter):
    """A case with every default filled in that does not depend on the particles.

    Made by :func:`psph.case.load`.  ``file`` is where it came from, ``name`` its stem.
    """

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
    numbers: dict[Name, NumberOf] = key("numbers of what is measured over time, by name", {})
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
        """Names of walls, bodies and solids on which the fluid's push is asked for; with a wall or a sensor
        all that bear it, since parts that meet share it."""
        gauged = {name for gauge in self.gauges.values() if gauge.force for name in gauge.force.on}
        sensed = any(gauge.sensor for gauge in self.gauges.values()) and not any(keys_one_sided(self))
        rigid = {name: one for _, name, one in self.entries if one.rigid}
        if sensed or not gauged.isdisjoint(rigid):
            gauged |= {name for name, one in rigid.items() if one.condition in BEARING}
        return gauged | {name for _, name, one in self.entries if one.always_loaded}

    @classmethod
    def tables_of(cls, kind: type[T]) -> dict[str, type[T]]:
        """The tables whose entries are of this ``kind``, with the type of these, in their order."""
        types = {name: get_args(field.annotation)[-1:] for name, field in cls.model_fields.items()}
        return {
            name: of
            for name, last in types.items()
            for of in last
            if isinstance(of, type) and issubclass(of, kind)
        }

    @property
    def entries(self) -> tuple[Named, ...]:
        """All that holds particles: what flows, what else moves freely, then what is rigid."""
        entries = [
            Named(table, *one) for table in self.tables_of(Placed) for one in getattr(self, table).items()
        ]
        return tuple(sorted(entries, key=lambda entry: (not entry.of.moves_freely, not entry.of.flows)))

    @property
    def flowing(self) -> dict[str, Any]:
        """What moves freely and finds its neighbours in space, by name."""
        return {name: one for _, name, one in self.entries if one.flows}

    @property
    def boundaries(self) -> dict[str, Any]:
        """What is rigid, by name."""
        return {name: one for _, name, one in self.entries if one.rigid}

    @property
    def movers(self) -> tuple[Named, ...]:
        """All whose particles forces move one by one."""
        return tuple(entry for entry in self.entries if entry.of.moves_freely)

    @property
    def series(self) -> list:
        """The series of motions that the case names (psph.case.motion.Series)."""
        return [series for parts in self.motions.values() for series in series_in(parts)]

    @property
    def motions(self) -> dict[tuple[str, ...], tuple]:
        """The parts of each motion of the case, by the location of its key."""
        motions = {
            (*entry.loc, *within): parts
            for entry in sorted(self.entries, key=lambda entry: not entry.of.rigid)
            for within, parts in entry.of.motions().items()
        }
        motions[("frame",)] = self.frame.motion
        return {(*loc, "motion"): parts for loc, parts in motions.items() if parts}

    @cached_property
    def courses(self) -> list[Columned]:
        """The columns of files that the case gives over time or a place."""
        return [value for _, value in walk(self) if isinstance(value, Columned)]

    @cached_property
    def meshes(self) -> dict[str, Mesh]:
        """The shapes that geometry files draw, by their dotted keys."""
        return {dotted(loc): value for loc, value in walk(self) if isinstance(value, Mesh)}

    @cached_property
    def drawings(self) -> list[Drawing]:
        """The shapes that files draw."""
        return [value for _, value in walk(self) if isinstance(value, Drawing)]

    @property
    def versions(self) -> list[str]:
        """A word for each file that the case uses: another content gives another word."""
        named = (*self.series, *self.courses, *self.drawings)
        return [*versions(self.catalogue), *(one.found.digest for one in named)]

    @cached_property
    def presets(self) -> dict[str, tuple[str, Any]]:
        """Dotted keys that the case's profile or scheme sets: the name of that, and the value."""
        space, surface = self.space, self.physics.free_surface is not None
        named = [(f"scheme {self.scheme}", scheme_keys(self.scheme, surface, dict(space)))]
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
        return LIST_OVER_LINES.sub(lambda listed: f"[{' '.join(listed[1].split())[:-1]}]", text)

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
        if contradicting := contradictions(self):
            raise ValidationError.from_exception_data("case", contradicting)
        return self

    @model_validator(mode="after")
    def _resolve(self) -> Self:
        end, zeros = self.time.end, (0.0,) * self.space.dimensions
        _fill(self.space, origin=zeros)
        _fill(self.output, frames=end / 50, probes=end / 1000, log=end / 200)
        self.space.__dict__["refine"] = finer_of(self.space.refine)  # all that reads a case has these alone
        deep = self.space.layers * self.space.spacing
        for one in (value for _, value in walk(self) if isinstance(value, Shell)):
            _fill(one, thickness=deep)
        for mover in self.movers:
            _fill(mover.of, velocity=zeros, velocity_center=zeros)
        for gauge in self.gauges.values():
            _fill(gauge, every=self.output.probes)
            if turned := gauge.force or gauge.reaction:
                _fill(turned, about=zeros)
            if gauge.overtopping:
                _fill(gauge.overtopping, width=1.0)
        for one in self.perturbations:
            _fill(one, velocity=zeros, shift=zeros)
        first = next((entry.name for entry in self.movers if entry.of.flows), None)
        for _, _, one in self.entries:
            if not one.flows:
                _fill(one, continues=first)
            if one.rigid:
                _fill(one, velocity=zeros)
        return self


def _fill(table: Table, **defaults: Any) -> None:
    """Give keys that were left out what depends on other tables."""
    for name, value in defaults.items():
        if getattr(table, name) is None:
            table.__dict__[name] = value  # the table is frozen, but the case is not complete yet


def schema() -> dict[str, Any]:
    """The JSON schema of a case: every key with its description, unit and default."""
    return Case.model_json_schema()
