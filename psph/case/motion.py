"""Motions in a case: the parts that ``walls.NAME.motion`` and ``frame.motion`` are made of."""

import math
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self, TypeAlias

import numpy as np
from pydantic import (
    BeforeValidator,
    Field,
    PrivateAttr,
    Strict,
    ValidationInfo,
    create_model,
    model_validator,
)
from pydantic_core import PydanticCustomError

from psph.case.columns import read_columns
from psph.case.files import Found, Unfit, beside
from psph.case.keys import Table, Text, Vector, key
from psph.case.paddles import Absorber, Flap, Irregular, OnHinge, Piston, SolitaryWave, Wavemaker
from psph.case.parameters import Parameters, chosen, last_part, table_of
from psph.physics.rigid.absorption import Absorbing
from psph.physics.rigid.laws import Accelerated, Sinusoidal, SteadyRate, Tabulated
from psph.physics.rigid.motion import UPWARDS, MotionPart, Rigid
from psph.physics.rigid.pose import ZERO, in_space
from psph.physics.rigid.schedule import ActingTime

PADDLES = ("piston", "flap", "irregular", "solitary")
"""Those of the keys of parts that make waves."""

BUILT_IN = ("translation", "rotation", "sinusoid", "acceleration", "series", *PADDLES)
"""Keys of the parts that psph itself has."""

RADIANS = "radians"

MOST_PARTS = 100
"""Of a motion: each is evaluated in every step."""


def _fault(says: str) -> PydanticCustomError:
    return PydanticCustomError("psph", "{says}", {"says": says})


class TurnAbout(Table):
    """What turns: about which point, and in 3D about which axis."""

    center: Vector | None = None
    axis: Vector | None = None

    @property
    def turns(self) -> bool:
        """Whether it turns at all."""
        return True

    @property
    def unit_axis(self) -> tuple[float, ...]:
        """The axis as a unit vector; that of 2D where none is given."""
        length = math.hypot(*self.axis) if self.axis else 0.0
        return tuple(a / length for a in self.axis) if length else UPWARDS

    @property
    def pivot(self) -> tuple[float, ...]:
        """The point, m."""
        return in_space(self.center) if self.center else ZERO

    def misfits(self, dimensions: int) -> str | None:
        """What does not fit a case of so many dimensions, in words."""
        if not self.turns:
            given = [name for name in ("center", "axis") if getattr(self, name) is not None]
            return f"{given[0]} is of a turn, and nothing turns here; remove it" if given else None
        if dimensions == 1:
            return "nothing turns in 1D; give a displacement"
        if self.center is None:
            return "turns about a point; give center"
        if dimensions == 3 and self.axis is None:
            return "turns about an axis in 3D; give axis, such as [0, 0, 1]"
        if dimensions == 2 and self.axis is not None:
            return "turns about z in 2D; remove axis"
        if self.axis is not None and not any(self.axis):
            return "an axis of zeros has no direction; give for example [0, 0, 1]"
        return None


class Translation(Parameters):
    """A constant velocity."""

    velocity: Vector = key("velocity", unit="m/s")

    def law(self) -> SteadyRate:
        """How far it comes."""
        return SteadyRate((*in_space(self.velocity), 0.0))


class Acceleration(Parameters):
    """A constant acceleration from rest; after the end the velocity stays."""

    acceleration: Vector = key("acceleration", unit="m/s2")

    def law(self) -> Accelerated:
        """How far it comes."""
        return Accelerated((*in_space(self.acceleration), 0.0))


CENTER = key("the point that it turns about, fixed in space unless a later part moves it", None, unit="m")
AXIS = key("the axis that it turns about, by the right-hand rule (3D)", None, otherwise="z in 2D")


class Rotation(TurnAbout):
    """A turn at a constant rate about a point."""

    speed: float = key("angular velocity; anticlockwise in 2D, by the right-hand rule in 3D", unit="rad/s")
    center: Vector | None = CENTER
    axis: Vector | None = AXIS

    def law(self) -> SteadyRate:
        """How far it comes."""
        return SteadyRate((*ZERO, self.speed))


class Sinusoid(TurnAbout):
    """An oscillation of place or angle."""

    amplitude: Vector | None = key("amplitude of a displacement", None, unit="m", otherwise="it turns")
    angle: float | None = key("amplitude of a turn", None, unit="rad", otherwise="it is displaced")
    center: Vector | None = CENTER
    axis: Vector | None = AXIS
    period: float | None = key("period", None, unit="s", otherwise="1 / frequency", gt=0)
    frequency: float | None = key("frequency", None, unit="Hz", otherwise="1 / period", gt=0)
    phase: float = key("phase of the sine at the start", 0.0, unit="rad")

    @property
    def turns(self) -> bool:
        """Whether it is one of an angle."""
        return self.angle is not None

    @model_validator(mode="after")
    def _is_one(self) -> Self:
        if (self.amplitude is None) == (self.angle is None):
            raise _fault("give either amplitude, of a displacement, or angle, of a turn")
        if (self.period is None) == (self.frequency is None):
            raise _fault("give either period or frequency")
        return self

    def law(self) -> Sinusoidal:
        """How far it comes."""
        amplitude = (*in_space(self.amplitude or ()), self.angle or 0.0)
        frequency = self.frequency if self.frequency is not None else 1.0 / self.period
        return Sinusoidal(amplitude, 2.0 * math.pi * frequency, self.phase)


class Series(TurnAbout):
    """Places or angles by time, from a CSV file."""

    file: Text = key("CSV file in the case's folder or below, with a line of names; # begins a comment")
    time: Text = key("name of its column of times, in s from the start of this part", "time")
    displacement: Annotated[tuple[Text, ...], Strict(False)] | None = key(
        "names of its columns of positions, m, one per dimension; the first row is the wall as it was drawn",
        None,
        otherwise="it turns",
        min_length=1,
        max_length=3,
    )
    angle: Text | None = key(
        "name of its column of angles; the first row is the wall as it was drawn",
        None,
        otherwise="it does not turn",
    )
    angle_unit: Literal[RADIANS, "degrees"] = key("the unit of that column", RADIANS)
    center: Vector | None = CENTER
    axis: Vector | None = AXIS

    _found: Found = PrivateAttr()
    _law: Tabulated = PrivateAttr()

    @property
    def found(self) -> Found:
        """The file, and what tells it from another of that name."""
        return self._found

    @property
    def turns(self) -> bool:
        """Whether it has angles."""
        return self.angle is not None

    @property
    def widest_swing(self) -> float:
        """The largest angle of its rows, where some of them turn back; 0 where it turns on and on, rad."""
        always = ActingTime(0.0, math.inf, 0.0)
        angles = [self._law.ways(always, time)[0][3] for time in self._law.times]
        steps = np.diff(angles)
        turns_back = (steps > 0.0).any() and (steps < 0.0).any()
        return max(map(abs, angles)) if turns_back else 0.0

    def law(self) -> Tabulated:
        """How far it comes."""
        return self._law

    def misfits(self, dimensions: int) -> str | None:
        """What does not fit a case of so many dimensions, in words."""
        if self.displacement is not None and len(self.displacement) != dimensions:
            return (
                f"displacement names {len(self.displacement)} columns; give one per dimension, {dimensions}"
            )
        return super().misfits(dimensions)

    @model_validator(mode="after")
    def _read(self, info: ValidationInfo) -> Self:
        """Read the file; the context of the validation is the folder of the case."""
        if self.displacement is None and self.angle is None:
            raise _fault("give displacement or angle: the names of columns")
        if self.angle is None and self.angle_unit != RADIANS:
            raise _fault("angle_unit is of a column of angles; give angle, or remove it")
        try:
            self._found = beside(info.context or Path(), self.file, "a CSV file", (".csv", ".txt", ".dat"))
            self._law = self._tabulated()
        except Unfit as says:
            raise _fault(str(says)) from None
        return self

    def _tabulated(self) -> Tabulated:
        names = [self.time, *(self.displacement or ()), *([self.angle] if self.angle else [])]
        rows = read_columns(self._found.path, names)
        ways = np.zeros((len(rows), 4))
        places = len(self.displacement or ())
        ways[:, :places] = rows[:, 1 : 1 + places]
        if self.angle:
            ways[:, 3] = rows[:, -1] if self.angle_unit == RADIANS else np.radians(rows[:, -1])
        law = Tabulated(rows[:, 0], ways - ways[0])
        if not np.isfinite(law.pieces).all():
            raise Unfit(
                f"{self._found.path}: its numbers are too large, or its times too close; correct them"
            )
        return law


class Motion(Table):
    """A part of a motion: one of its ways, and when it acts."""

    translation: Translation | None = key("a constant velocity", None)
    rotation: Rotation | None = key("a turn at a constant rate about a point", None)
    sinusoid: Sinusoid | None = key("an oscillation of place or angle", None)
    acceleration: Acceleration | None = key("a constant acceleration from rest", None)
    series: Series | None = key("places or angles by time, from a CSV file", None)
    piston: Piston | None = key("a paddle that slides and makes regular waves", None)
    flap: Flap | None = key("a paddle on a hinge that makes regular waves", None)
    irregular: Irregular | None = key("a paddle that makes the waves of a spectrum", None)
    solitary: SolitaryWave | None = key("a paddle that makes a solitary wave", None)
    start: float = key("time from which the part acts", 0.0, unit="s", ge=0)
    end: float | None = key("time until which it acts", None, unit="s", otherwise="it never ends")
    ramp: float = key(
        "time over which it is switched on from its start, and off before its end", 0.0, unit="s", ge=0
    )

    entries: ClassVar[tuple] = ()
    """What extensions of the case bring beside these."""

    @property
    def way(self) -> str:
        """The key that says how it moves."""
        [name] = self.ways
        return name

    @property
    def ways(self) -> list[str]:
        """The keys that it has of those that say how it moves; one, in a case that was checked."""
        return [name for name in self.known() if getattr(self, name) is not None]

    @classmethod
    def known(cls) -> list[str]:
        """All such keys."""
        return [*BUILT_IN, *map(last_part, cls.entries)]

    @property
    def is_rigid(self) -> bool:
        """Whether it moves a wall without deforming it."""
        return self.way in BUILT_IN or hasattr(chosen(self, self.entries)[self.way], "pose")

    @property
    def absorbs(self) -> bool:
        """Whether it is a paddle that takes up waves that come back."""
        asked = getattr(self, self.way)
        return isinstance(asked, Absorber) and asked.absorb is not None

    def part(self, gravity: float) -> Any:
        """The part as the step knows it: with a pose, or by an extension with what that has.

        ``gravity``: the strength g, m/s², by which waves run.
        """
        asked: Any = getattr(self, self.way)
        if self.way not in BUILT_IN:
            return chosen(self, self.entries)[self.way]
        schedule = ActingTime(self.start, math.inf if self.end is None else self.end, self.ramp)
        law = asked.law(gravity) if self.way in PADDLES else asked.law()
        if self.absorbs:
            return Absorbing(MotionPart(law, schedule), asked.heading, asked.absorption(gravity))
        if isinstance(asked, (TurnAbout, Wavemaker)):
            return MotionPart(law, schedule, asked.pivot, asked.unit_axis)
        return MotionPart(law, schedule)


def _as_list(value: Any) -> Any:
    """One part is a list of one."""
    return (value,) if isinstance(value, (dict, Motion)) else value


@cache
def motions_type(entries: tuple = ()) -> Any:
    """The type of a motion: a part, or a list of parts; with those that extensions bring."""
    kind = Motion
    if entries:
        brought = table_of("Motion", "", entries).model_fields
        fields: dict[str, Any] = {name: (field.annotation, field) for name, field in brought.items()}
        kind = create_model("Motion", __base__=Motion, __doc__=Motion.__doc__, **fields)
        kind.entries = entries
    bounds = Field(min_length=1, max_length=MOST_PARTS)
    several = Annotated[tuple[kind, ...], Strict(False), bounds]  # type: ignore[valid-type]
    return Annotated[several, BeforeValidator(_as_list, json_schema_input_type=kind | several)]


def motion_of(parts: tuple[Motion, ...] | None, gravity: tuple[float, ...] = ()) -> Any:
    """The motion that is made of these parts (psph.physics.motion), or None where there are none.

    ``gravity`` in m/s², by which waves run.
    """
    if not parts:
        return None
    made = tuple(one.part(math.hypot(*gravity)) for one in parts)
    if len(made) == 1 and (parts[0].way not in BUILT_IN or parts[0].absorbs):
        return made[0]
    return Rigid(made)


def series_in(parts: tuple[Motion, ...]) -> list[Series]:
    """The series among these parts."""
    return [one.series for one in parts if one.series is not None]


def way_and_turn(part: Motion) -> tuple[tuple[float, ...], bool]:
    """The direction of a part's displacement, empty where its keys do not tell, and whether it turns."""
    asked = getattr(part, part.way)
    if isinstance(asked, TurnAbout) and asked.turns:
        return (), True
    if isinstance(asked, Wavemaker):
        turns = isinstance(asked, OnHinge) and asked.center is not None
        return ((), True) if turns else (asked.heading, False)
    key = {"translation": "velocity", "sinusoid": "amplitude"}.get(part.way, part.way)
    return getattr(asked, key, ()), False


def misfits(parts: tuple[Motion, ...], dimensions: int, gravity: tuple[float, ...]):
    """What is wrong with a motion in a case of so many dimensions: (place, key or None, words).

    ``gravity`` in m/s², empty where there is none.
    """
    for place, one in enumerate(parts):
        names = one.ways
        if len(names) != 1:
            how = f"a part moves in one way, not in {len(names)}" if names else "does not say how it moves"
            yield place, None, f"{how}; give one of: {', '.join(one.known())}"
            continue
        asked = getattr(one, one.way)
        if isinstance(asked, TurnAbout) and (says := asked.misfits(dimensions)):
            yield place, one.way, says
        if isinstance(asked, Wavemaker) and (says := asked.misfits(dimensions, gravity)):
            yield place, one.way, says
        if one.absorbs and len(parts) > 1:
            yield place, one.way, "moves by what it measures if it is to absorb; let it be the only part"
        if one.solitary and (one.ramp or one.end is not None):
            yield place, one.way, "begins and ends by itself; remove ramp and end"
        if one.way not in BUILT_IN:
            if one.start or one.end is not None or one.ramp:
                yield place, one.way, "start, end and ramp are of psph's own parts; remove them"
            if len(parts) > 1 and not one.is_rigid:
                yield place, one.way, "is no rigid motion, which alone add up; let it be the only part"
        elif one.end is not None and one.end - one.start < max(2.0 * one.ramp, 1e-30):
            yield place, "end", "is no later than the start and two ramps; give a later end"


if TYPE_CHECKING:  # made from what psph offers
    Motions: TypeAlias = Any
else:
    Motions = motions_type()
