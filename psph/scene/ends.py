"""Open ends of a scene: where each stands, what it gives, and whose particles are its buffers."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from psph.case.courses import AcrossFace, Course
from psph.case.ends import OpenEnd
from psph.case.keys import AXES
from psph.physics.open_ends import grown, parabola, pipe
from psph.scene.end_columns import Column, column_of
from psph.scene.end_rides import Ride, ride_of
from psph.scene.end_rows import SurfaceRows, raised, rows_behind
from psph.scene.layout import NONE, Layout
from psph.scene.parts.end import EndPart, rows_of

PLACES = 1001
"""Places between the sides of a face at which a profile from a file is averaged."""

FRONT = 3.0
"""Spacings in front of a plane within which the slope of the pressure is taken."""

SEEN = FRONT + 2.0
"""Spacings in front of a plane up to which an end asks for particles."""

BEYOND = 2.0
"""Spacings behind the last layer up to which fluid behind a plane is taken for what went out."""

UNLIKE = 10.0
"""Between fluids whose ρ₀c differ by more, one answer of the whole face to waves would tear the lighter."""

SLOW = 10.0
"""Times the settling time in which the slope of the pressure along the normal is followed."""

SETTLE = 2.0
"""Times that a wave runs through the domain until it counts as a change of the flow."""


@dataclass(frozen=True, eq=False)
class EndFace:
    """An open end as the step needs it.

    ``number`` among the ends; its plane stands ``at`` m along ``axis`` at the start and goes
    on by its ``ride``, ``sign`` is that of its inward
    direction; ``lower`` and ``upper`` (dim,) m are the corners of the box in which its buffers may be, which
    are ``layers`` spacings deep, ``middle`` (dim,) m that of where they are at the start; they do not move
    out of ``sides`` (2, dim), m, infinite where the domain repeats.  ``groups`` has, for each fluid, the
    number of its buffer.  ``kind`` is the key
    of what is given, ``given`` its value by time, ``level`` that of its surface, no number where it is found,
    ``feeding`` the number of the end that a pump takes from.
    ``shape`` has, of places (n, dim), m, the speed of what comes in over its mean, which is not 1 everywhere
    where it is ``shaped``.  ``settle`` in s is None where waves come back; slopes of the pressure are
    followed in the time ``follows``, s.  ``height`` in m is that of the face along gravity, 0 without a
    surface above it; ``wave_speed`` in m/s is that of the waves that it lets out; ``spacing`` dx, m; ``rows``
    of particles stand behind it at the start; ``column`` has the fluids there, the lowest first; ``surface``
    has the rows that its level fills, None without a surface.
    """

    name: str
    number: int
    axis: int
    at: float
    ride: Ride
    sign: int
    lower: np.ndarray
    upper: np.ndarray
    middle: np.ndarray
    sides: np.ndarray
    layers: int
    groups: tuple[int, ...]
    kind: str
    given: Callable[[float], float]
    level: Callable[[float], float]
    feeding: int | None
    shape: Callable[[np.ndarray], np.ndarray]
    shaped: bool
    settle: float | None
    follows: float
    height: float
    wave_speed: float
    spacing: float
    rows: float
    column: Column
    surface: SurfaceRows | None

    @property
    def by_pressure(self) -> bool:
        """Whether it gives a pressure."""
        return self.kind in ("pressure", "level")

    @cached_property
    def fluid_of(self) -> np.ndarray:
        """The fluid of which each group of particles is the buffer (256,)."""
        found = np.zeros(NONE + 1, np.uint8)
        found[list(self.groups)] = np.arange(len(self.groups))
        return found

    def depth(self, along: np.ndarray, place: float) -> np.ndarray:
        """How far behind the plane, which stands at a ``place``, coordinates ``along`` its axis are, m."""
        return (place - along) * self.sign

    def pace(self, time: float) -> float:
        """How fast the plane goes inward, m/s."""
        return self.sign * self.ride.pace(time)


def faces_of(scene) -> tuple[EndFace, ...]:
    """The open ends of a scene (psph.scene.scene.Scene)."""
    names = [*scene.case.ends]
    return tuple(_face(scene, names, name) for name in names)


def groups_of(layout: Layout, name: str) -> tuple[int, ...]:
    """The numbers of the buffers of an end, in the order of the fluids."""
    return tuple(
        part.number for part in layout.parts if isinstance(part, EndPart) and part.key == f"ends.{name}"
    )


def _face(scene, names: list[str], name: str) -> EndFace:
    layout, end = scene.layout, scene.case.ends[name]
    groups = groups_of(layout, name)
    box = layout.parts[groups[0]].shape.form
    lower, upper = np.array(box.lower), np.array(box.upper)
    held = [n for n in groups if scene.census.sizes[n]]
    half = 0.5 * layout.spacing
    wet_low = scene.census.lowest[held].min(axis=0) - half if held else lower
    wet_high = scene.census.highest[held].max(axis=0) + half if held else upper
    column, _ = column_of(scene, end, groups, lower, upper)
    height, layers = _height(scene, end, wet_low, wet_high), rows_of(scene.case, end)
    if height:
        lower, upper = raised(layout, end, lower, upper)
    surface = rows_behind(layout, end, groups, lower, upper) if height and end.moves_rows else None
    return EndFace(
        name=name,
        number=names.index(name),
        axis=end.axis,
        at=end.at,
        ride=ride_of(scene, end),
        sign=end.sign,
        lower=lower,
        upper=upper,
        middle=0.5 * (wet_low + wet_high),
        sides=_sides(layout, end, wet_low, wet_high),
        layers=layers,
        groups=groups,
        kind=end.given,
        given=_by_time(getattr(end, end.given), end.ramp),
        level=_by_time(end.level),
        feeding=names.index(end.pump) if end.pump else None,
        shaped=end.profile != "uniform",
        shape=_shape(layout, end, wet_low, wet_high),
        settle=_settle(scene, end, height) if end.lets_waves_out and not unlike(scene) else None,
        follows=SLOW * _settle(scene, end, height),
        height=height,
        wave_speed=wave_speed(scene, height),
        spacing=layout.spacing,
        rows=float(scene.census.sizes[list(groups)].sum()) / layers,
        column=column,
        surface=surface,
    )


def _sides(layout: Layout, end: OpenEnd, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """How far across the end the particles behind it may move (2, dim), m."""
    free = [d == end.axis or layout.periods[d] is not None for d in range(layout.dimensions)]
    half = 0.5 * layout.spacing
    return np.array([np.where(free, -np.inf, low + half), np.where(free, np.inf, high - half)])


def _by_time(told: float | str | Course | None, ramp: float = 0.0) -> Callable[[float], float]:
    """What is told, by time in s; no number where it is found."""

    def value(time: float) -> float:
        now = float(told.at(time)) if isinstance(told, Course) else float(told or 0.0)
        return now * grown(time, ramp) if ramp else now

    return (lambda time: math.nan) if told is None or isinstance(told, str) else value


def _height(scene, end: OpenEnd, low: np.ndarray, high: np.ndarray) -> float:
    """How far a face reaches along gravity where there is air above it, m; else 0."""
    layout, half = scene.layout, 0.5 * scene.spacing
    up = np.abs(layout.up)
    up[end.axis] = 0.0
    if end.filled is not None or not up.any():
        return 0.0
    axis = int(up.argmax())
    above = high[axis] + half if layout.up[axis] > 0.0 else low[axis] - half
    grid = []
    for d in range(layout.dimensions):
        x = np.arange(low[d] + half, high[d], scene.spacing)
        x = np.array([above]) if d == axis else x[:1] if d == end.axis else x
        grid.append(x.reshape([-1 if k == d else 1 for k in range(layout.dimensions)]))
    shape = np.broadcast_shapes(*(x.shape for x in grid))
    open_above = end.level is not None or (layout.held(grid, shape) == NONE).any()
    return float(high[axis] - low[axis]) if open_above else 0.0


def _shape(layout: Layout, end: OpenEnd, low: np.ndarray, high: np.ndarray) -> Callable:
    """The speed of what comes in over its mean, of places (n, dim), m; ``low`` and ``high`` are its sides."""
    told = end.profile
    if isinstance(told, AcrossFace):
        axis = AXES.index(told.along)
        mean = mean_of(told, low[axis], high[axis])
        return lambda x: told.at(x[:, axis]) / mean
    low, high = _whole(layout, low, high)
    across = [d for d in range(layout.dimensions) if d != end.axis and low[d] > -math.inf]
    if told == "uniform" or not across:
        return lambda x: np.ones(len(x))
    form = pipe if told == "pipe" and len(across) > 1 else parabola
    return lambda x: form(x[:, across], low[across], high[across])


def _whole(layout: Layout, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The sides of a face with its images behind planes of symmetry, m; -inf and inf where it has none."""
    least, most = low.copy(), high.copy()
    for d, period in enumerate(layout.periods):
        size = high[d] - low[d]
        begins, ends = (f"{AXES[d]}.{side}" in layout.case.space.symmetry for side in ("lower", "upper"))
        begins &= abs(low[d] - layout.lower[d]) < 0.5 * layout.spacing
        ends &= abs(high[d] - layout.upper[d]) < 0.5 * layout.spacing
        if (begins and ends) or (period is not None and size > period - 0.5 * layout.spacing):
            least[d], most[d] = -math.inf, math.inf
        elif begins:
            least[d] -= size
        elif ends:
            most[d] += size
    return least, most


def mean_of(profile: AcrossFace, low: float, high: float) -> float:
    """The mean of a ``profile`` from a file between the sides of a face, at ``low`` and ``high`` m."""
    return float(np.mean(profile.at(np.linspace(low, high, PLACES))))


def unlike(scene) -> bool:
    """Whether ρ₀c of the fluids differ by more than one answer to waves serves."""
    found = [one.density * one.sound_speed for one in scene.species if one.is_fluid]
    return max(found) > UNLIKE * min(found)


def _settle(scene, end: OpenEnd, height: float) -> float:
    """The time in which references follow, s."""
    if end.settle is not None:
        return end.settle
    layout = scene.layout
    length = layout.upper[end.axis] - layout.lower[end.axis]
    return SETTLE * length / wave_speed(scene, height)


def wave_speed(scene, height: float) -> float:
    """The speed of the waves that leave through a face of this ``height`` below a surface, m/s."""
    pull = math.hypot(*scene.gravity)
    return math.sqrt(pull * height) if height and pull else scene.sound_speed
