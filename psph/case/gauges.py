"""Gauges of a case: numbers that a run measures over time, each in a file of its own."""

from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal, Self

from pydantic import Strict, model_validator
from pydantic_core import PydanticCustomError

from psph.acts import BODIES, FLOWING, IDEAL_GASES, MATTER, SOILS, SOLIDS, UPDATED, refusals
from psph.case.errors import advise
from psph.case.findings import Finding, keys_one_sided
from psph.case.keys import AXES, Axis, Name, Place, Table, Vector, key
from psph.case.placed import Placed
from psph.case.shapes import Shape
from psph.case.sketches import rectangle, ring
from psph.case.solids import Reaction
from psph.physics.walls.conditions import BEARING, CONDITIONS

MOVES_WITH = key(
    "the moving wall or the body that carries it along, and turns it; its places are those of the start",
    None,
    otherwise="it stays where it is in space",
)

OF = key("the fluid or the soil that counts, by its name", None, otherwise="all that flows")


KNOWN = " or ".join(f'"{one}"' for one in BEARING)


class Force(Table):
    """Force and moment of the fluid on walls, bodies and solids."""

    acts: ClassVar = MATTER
    refuses: ClassVar = {
        one: f'a wall with condition = "{one}" bears no force; take {KNOWN}'
        for one in CONDITIONS
        if one not in BEARING
    }

    on: Annotated[tuple[Name, ...], Strict(False)] = key(
        "names of walls, bodies and solids in a fluid, taken together", min_length=1
    )
    about: Vector | None = key("point about which moments are taken", None, unit="m", otherwise="zeros")
    moves_with: Name | None = key(
        "the moving wall or the body that carries this point along; it is then where it is at the start",
        None,
        otherwise="the point stays where it is in space",
    )

    def contradictions(self, case) -> Iterator[Finding]:
        """Where no force is known: by effects that are not pushed back, and of what is not pushed."""
        for one_sided in keys_one_sided(case):
            says = f"{one_sided} does not push back what pushes, so that no force on a wall is known"
            yield (), ..., f"{says}; take another"
        entries = sorted(case.entries, key=lambda entry: not entry.of.rigid)
        pushed = {entry.name: entry.of for entry in entries if entry.of.pushed(case)}
        for place, name in enumerate(self.on):
            if name not in pushed:
                says = f"no {_or_listed(_pushed_words(case))} has this name; {advise(name, pushed)}"
                yield ("on", place), name, says
            elif says := refusals(self).get(pushed[name].word):
                yield ("on", place), name, says


def _pushed_words(case) -> list[str]:
    """What a case can have a force on, in words: what is rigid, and what else it has that may be pushed."""
    here = [type(entry.of).called for entry in case.entries if entry.of.called]
    return list(dict.fromkeys([of.called for of in case.tables_of(Placed).values() if of.rigid] + here))


def _or_listed(words: list[str]) -> str:
    """``a, b or c``."""
    return f"{', '.join(words[:-1])} or {words[-1]}"


def has_a_length(line):
    """Refuse a line that ends where it begins."""
    if line.foot == line.top:
        raise PydanticCustomError("psph", "has no length; let 'top' lie above 'foot'")
    return line


class OfFlow(Table):
    """What is measured of what flows."""

    measures: ClassVar = "fluid or soil"


class Level(OfFlow):
    """Water level along a straight line, as a wave gauge measures it."""

    foot: Vector = key("the lower end of the line, from which the level is counted", unit="m")
    top: Vector = key("its upper end", unit="m")
    of: Name | None = OF
    moves_with: Name | None = MOVES_WITH

    _has_a_length = model_validator(mode="after")(has_a_length)

    def sketch(self) -> Iterator[tuple[Place, ...]]:
        """Its line."""
        yield self.foot, self.top


class RunUp(OfFlow):
    """How far the tongue of the fluid reaches up a slope: along the slope, and in height."""

    foot: Vector = key("the lower end of a line on the slope, from which the run-up is counted", unit="m")
    top: Vector = key("its upper end", unit="m")
    of: Name | None = OF
    moves_with: Name | None = MOVES_WITH

    _has_a_length = model_validator(mode="after")(has_a_length)

    def sketch(self) -> Iterator[tuple[Place, ...]]:
        """Its line."""
        yield self.foot, self.top


class Highest(OfFlow):
    """The largest coordinate of the fluid along an axis: its front, or its highest drop."""

    axis: Axis = key("the axis")
    shape: Shape | None = key("the region in which fluid counts", None, otherwise="everywhere")
    of: Name | None = OF


class VolumeIn(OfFlow):
    """Volume and mass of the fluid in a region."""

    shape: Shape = key("the region")
    of: Name | None = OF
    moves_with: Name | None = MOVES_WITH


class Overtopping(OfFlow):
    """Volume of the fluid beyond the crest of a structure, by the metre of crest."""

    at: float = key("place of the crest along the axis of 'towards'", unit="m")
    towards: Literal["+x", "-x", "+y", "-y", "+z", "-z"] = key("the direction over the crest")
    width: float | None = key(
        "length of the crest; required in 3D", None, unit="m", otherwise="1, of 2D a metre of depth", gt=0
    )
    shape: Shape | None = key(
        "the region in which fluid counts, such as the basin behind the crest", None, otherwise="everywhere"
    )
    of: Name | None = OF

    def contradictions(self, case) -> Iterator[Finding]:
        """A direction that is none, and a width that is not known."""
        dimensions = case.space.dimensions
        if self.towards[1] not in AXES[:dimensions]:
            yield ("towards",), self.towards, f"there are {dimensions} axes; give one of them"
        elif self.towards[1] in case.space.periodic:
            says = "the domain repeats along this axis, so that nothing is beyond; give another"
            yield ("towards",), self.towards, says
        if dimensions == 3 and self.width is None:
            yield (), ..., "needs width in 3D, the length of the crest in m; add it"


class Point(Table):
    """Fields of the fluid at a point."""

    acts: ClassVar = (*FLOWING, IDEAL_GASES)

    position: Vector = key("where", unit="m")
    fields: Annotated[tuple[Literal["pressure", "density", "velocity"], ...], Strict(False)] = key(
        "what is measured", ("pressure", "velocity"), min_length=1
    )
    moves_with: Name | None = MOVES_WITH

    def sketch(self) -> Iterator[tuple[Place, ...]]:
        """Its place."""
        yield (self.position,)


class Sensor(Table):
    """Mean pressure over a round sensor on a wall; parts of it that no fluid reaches bear none."""

    position: Vector = key("its centre, on the face of the wall", unit="m")
    axis: Axis = key("the direction that it faces, across the wall")
    diameter: float = key("its diameter", unit="m", gt=0)
    moves_with: Name | None = MOVES_WITH

    def sketch(self) -> Iterator[tuple[Place, ...]]:
        """Its rim, in 2D its line."""
        yield ring(self.position, self.axis, 0.5 * self.diameter)


class Flow(OfFlow):
    """Flow of the fluid through a section across an axis, positive along it."""

    lower: Vector = key("lowest corner of the section; along one axis equal to 'upper'", unit="m")
    upper: Vector = key("its highest corner", unit="m")
    of: Name | None = OF

    @model_validator(mode="after")
    def _is_a_section(self) -> Self:
        flat = [low == up for low, up in zip(self.lower, self.upper)]
        if sum(flat) != 1 or any(low > up for low, up in zip(self.lower, self.upper)):
            raise PydanticCustomError(
                "psph",
                "is no section across an axis; let 'lower' and 'upper' be equal along that axis, and 'upper' "
                "the larger along the others",
            )
        return self

    def sketch(self) -> Iterator[tuple[Place, ...]]:
        """Its rim."""
        yield rectangle(self.lower, self.upper)


class MotionOf(Table):
    """Place, turn, speed of a rigid body, and what acts on it."""

    acts: ClassVar = (BODIES,)
    measures: ClassVar = "body"

    of: Name = key("the name of the body")


class JointOf(Table):
    """What a joint does to the first of its bodies, and how far it has gone."""

    acts: ClassVar = (BODIES,)

    of: Name = key("the name of the joint")

    def contradictions(self, case) -> Iterator[Finding]:
        """A joint that is none."""
        if self.of not in case.joints:
            yield ("of",), self.of, f"no joint has this name; {advise(self.of, case.joints)}"


class Displacement(Table):
    """How far a point of a solid has moved, by the straight line fitted to the particles around it."""

    acts: ClassVar = (UPDATED, SOLIDS)
    measures: ClassVar = "solid"

    of: Name = key("the name of the solid")
    at: Vector = key("the point, on or in the solid, where it is at the start", unit="m")

    def sketch(self) -> Iterator[tuple[Place, ...]]:
        """Its point."""
        yield (self.at,)


class StressAt(Table):
    """Stress at a point of a solid or a soil, by the straight function fitted to the particles around it."""

    acts: ClassVar = (SOILS, UPDATED, SOLIDS)
    measures: ClassVar = "solid or soil"

    of: Name = key("the name of the solid or the soil")
    at: Vector = key(
        "the point: of a solid where it is at the start, and it moves with that; of a soil or an updated "
        "Lagrangian solid it stays in space",
        unit="m",
    )

    def sketch(self) -> Iterator[tuple[Place, ...]]:
        """Its point."""
        yield (self.at,)


ANOTHER_KIND = "one kind of gauge is required"
"""The default of a gauge's kinds, of which one is given."""


class Gauge(Table):
    """A gauge: exactly one of these kinds, and how often it is read."""

    KINDS: ClassVar = (
        "force",
        "level",
        "run_up",
        "highest",
        "volume",
        "overtopping",
        "point",
        "sensor",
        "flow",
        "motion",
        "joint",
        "displacement",
        "reaction",
        "stress",
    )

    force: Force | None = key("force and moment of the fluid", None, otherwise=ANOTHER_KIND)
    level: Level | None = key("water level along a line", None, otherwise=ANOTHER_KIND)
    run_up: RunUp | None = key("run-up along a slope", None, otherwise=ANOTHER_KIND)
    highest: Highest | None = key("largest coordinate of the fluid", None, otherwise=ANOTHER_KIND)
    volume: VolumeIn | None = key("volume of the fluid in a region", None, otherwise=ANOTHER_KIND)
    overtopping: Overtopping | None = key("volume beyond a crest", None, otherwise=ANOTHER_KIND)
    point: Point | None = key("fields at a point", None, otherwise=ANOTHER_KIND)
    sensor: Sensor | None = key("mean pressure over a round sensor", None, otherwise=ANOTHER_KIND)
    flow: Flow | None = key("flow through a section", None, otherwise=ANOTHER_KIND)
    motion: MotionOf | None = key("motion of a rigid body", None, otherwise=ANOTHER_KIND)
    joint: JointOf | None = key("what a joint bears", None, otherwise=ANOTHER_KIND)
    displacement: Displacement | None = key("how far a point of a solid moves", None, otherwise=ANOTHER_KIND)
    reaction: Reaction | None = key("what clamps and anvils bear", None, otherwise=ANOTHER_KIND)
    stress: StressAt | None = key("stress at a point of a solid or a soil", None, otherwise=ANOTHER_KIND)
    every: float | None = key("time between rows", None, unit="s", otherwise="output.probes", gt=0)

    @property
    def kind(self) -> str:
        """The name of its kind."""
        [name] = (name for name in self.KINDS if getattr(self, name) is not None)
        return name

    @model_validator(mode="after")
    def _has_one_kind(self) -> Self:
        given = [name for name in self.KINDS if getattr(self, name) is not None]
        if len(given) != 1:
            said = f"{' and '.join(given)} in one gauge" if given else "does not say what it measures"
            raise PydanticCustomError("psph", f"{said}; give one of {', '.join(self.KINDS)}")
        return self
