"""Open ends of a case, through which fluid comes and goes, and the rules between their keys."""

from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from pydantic import Field, Strict

from psph.acts import FLUIDS
from psph.case.courses import AcrossFace, Course
from psph.case.errors import advise
from psph.case.findings import Finding
from psph.case.keys import AXES, Name, Table, key
from psph.case.placed import Answering

GIVENS = ("velocity", "flow", "pressure", "pump", "level")
"""The keys of which an end has one; a level beside another says where the surface is."""

LEVEL = GIVENS[-1]

MOST_GROUPS = 250
"""Fluids, walls, bodies and the buffers of ends together: particles know theirs by one byte."""

Span = Annotated[tuple[float, ...], Strict(False), Field(min_length=2, max_length=2)]


class Spans(Table):
    """How far an end reaches along the axes across it."""

    x: Span | None = key("from and to along x", None, unit="m", otherwise="all of the domain")
    y: Span | None = key("from and to along y", None, unit="m", otherwise="all of the domain")
    z: Span | None = key("from and to along z", None, unit="m", otherwise="all of the domain")


class OpenEnd(Answering):
    """A plane through which fluid comes and goes, both ways."""

    at: float = key("where its plane stands along its axis", unit="m")
    inward: Literal["+x", "-x", "+y", "-y", "+z", "-z"] = key("the direction into the domain")
    on: Name | None = key("the wall with which its plane moves, along its axis", None)
    span: Spans = key("how far it reaches across that", make=Spans)
    velocity: float | Course | None = key(
        "mean speed inward: a number, or a table with the file of a series; below 0 it flows out",
        None,
        unit="m/s",
    )
    flow: float | Course | None = key(
        "volume that comes in by time; in 2D per metre of depth", None, unit="m3/s"
    )
    pressure: float | Course | None = key(
        "pressure at its plane; under gravity across it that in the middle of its height", None, unit="Pa"
    )
    level: float | Course | Literal["found"] | None = key(
        "height of the water's surface along the axis of gravity, or found: that of the water in front; by "
        "itself pressure is hydrostatic below, beside a speed or a flow it says how high these reach",
        None,
        unit="m",
    )
    pump: Name | None = key("the end whose flow comes in here: what leaves there", None)
    profile: Literal["uniform", "parabola", "pipe"] | AcrossFace = key(
        "shape of what comes in: uniform; parabola: zero at the sides of the end; pipe: of a round one; or a "
        "table with the file of a profile, of which the shape counts alone",
        "uniform",
    )
    ramp: float = key("time over which what is given grows from zero at the start", 0.0, unit="s", ge=0)
    filled: Name | None = key(
        "the fluid with which all of it is filled at the start",
        None,
        otherwise="what stands in front of it",
    )
    layers: int | None = key(
        "rows of particles behind the plane", None, otherwise="as many as the kernel reaches", ge=2, le=20
    )
    waves: Literal["out", "back"] | None = key(
        "out: waves leave; back: what is given holds at every moment, and waves come back from it",
        None,
        otherwise="out, where what is given is a number without a ramp; else back",
    )
    settle: float | None = key(
        "time after which waves count as a change of the flow",
        None,
        unit="s",
        otherwise="twice that of sound, or of a wave under gravity, through the domain along its axis",
        gt=0,
    )

    called: ClassVar = "open end"
    beside_sizes: ClassVar = True

    @property
    def axis(self) -> int:
        """That of its normal."""
        return AXES.index(self.inward[1])

    @property
    def sign(self) -> int:
        """Of its inward direction."""
        return 1 if self.inward[0] == "+" else -1

    @property
    def given(self) -> str:
        """The key that says what is given."""
        return next((name for name in GIVENS if getattr(self, name) is not None), "")

    @property
    def moves_rows(self) -> bool:
        """Whether its level fills and empties rows behind its plane."""
        return self.level is not None or self.given in ("flow", "pump")

    @property
    def steady(self) -> bool:
        """Whether what is given is a number from the start."""
        return not self.ramp and isinstance(getattr(self, self.given), float)

    @property
    def lets_waves_out(self) -> bool:
        """Whether waves leave."""
        return self.waves == "out" if self.waves else self.steady

    def depth(self, rows: int, spacing: float) -> float:
        """Of its buffer where the kernel asks for so many ``rows``, m."""
        return (self.layers or rows) * spacing

    @classmethod
    def contradictions(cls, case) -> Iterator[Finding]:
        """Ends that cannot be, in a case with space.dimensions."""
        dimensions, across = case.space.dimensions, AXES[: case.space.dimensions]
        count = len(case.entries) + len(case.ends) * len(case.fluids)
        if case.ends and count > MOST_GROUPS:
            says = f"give {count} groups of particles with a buffer for each fluid; {MOST_GROUPS} at most"
            yield ("ends",), ..., f"{len(case.ends)} ends and {len(case.fluids)} fluids {says}"
        if case.ends and case.frame.motion:
            yield ("ends",), ..., "stand in a frame that rests; remove frame.motion, or the ends"
        for entry in case.movers if case.ends else ():
            if entry.of.flows and entry.of.word != FLUIDS:
                says = (
                    f"let fluids through, and {entry.table}.{entry.name} would come there; remove one of them"
                )
                yield ("ends",), ..., says
        for name, end in case.ends.items():
            loc = ("ends", name)
            given = [one for one in GIVENS if getattr(end, one) is not None]
            if len(given) == 2 and given[-1] == LEVEL and given[0] != "pressure":
                given.pop()
            if len(given) != 1:
                said = f"{' and '.join(given)} are given" if given else "nothing is given"
                yield loc, ..., f"{said}; give one of {', '.join(GIVENS)}"
                continue
            if end.axis >= dimensions:
                yield (*loc, "inward"), end.inward, f"there are {dimensions} axes; give one of them"
                continue
            if end.inward[1] in case.space.periodic:
                says = "the domain repeats along this axis; remove it from space.periodic, or the end"
                yield (*loc, "inward"), end.inward, says
            yield from end._spans(loc, across)
            yield from end._givens(loc, case)

    def _spans(self, loc, across) -> Iterator[Finding]:
        for axis in AXES:
            told = getattr(self.span, axis)
            if told is None:
                continue
            where = (*loc, "span", axis)
            if axis == self.inward[1] or axis not in across:
                yield where, told, "is not an axis across the end; remove it"
            elif not told[0] < told[1]:
                yield where, told, "has no inside; let the second number be the larger one"

    def _givens(self, loc, case) -> Iterator[Finding]:
        fluids = [*case.fluids]
        if self.filled is not None and self.filled not in fluids:
            yield (*loc, "filled"), self.filled, f"no fluid has this name; {advise(self.filled, fluids)}"
        if self.on is not None and self.on not in case.walls:
            yield (*loc, "on"), self.on, f"no wall has this name; {advise(self.on, [*case.walls])}"
        if self.pump is not None:
            others = [name for name in case.ends if name != loc[1]]
            if self.pump not in others:
                says = f"no other end has this name; {advise(self.pump, others)}"
                yield (*loc, "pump"), self.pump, says
            elif case.ends[self.pump].given == "pump":
                yield (*loc, "pump"), self.pump, "is fed by a pump itself; give it a flow, pressure or level"
        gravity = case.physics.gravity.acceleration if case.physics.gravity else ()
        if self.level is not None and not any(g for d, g in enumerate(gravity) if d != self.axis):
            says = "a level needs gravity across the end; set physics.gravity, or give a pressure"
            yield (*loc, "level"), self.level, says
        if self.given == LEVEL and self.ramp:
            says = "would let the level grow from a height of 0; give a series of levels"
            yield (*loc, "ramp"), self.ramp, says
        if self.profile == "pipe" and case.space.dimensions != 3:
            yield (*loc, "profile"), self.profile, "is of 3D; give parabola"
        across = [axis for axis in AXES[: case.space.dimensions] if axis != self.inward[1]]
        if isinstance(self.profile, AcrossFace) and self.profile.along not in across:
            says = f"is no axis across the end; give {' or '.join(across)}" if across else "is of 2D and 3D"
            yield (*loc, "profile", "along"), self.profile.along, says
