"""Forms at another place: scaled, mirrored, turned, moved, repeated."""

import math
from collections.abc import Iterator, Sequence
from functools import reduce
from itertools import product
from typing import NamedTuple

import numpy as np

from psph.case.placing import FlatFace, Placing, Repeat, Turn
from psph.scene.forms.form import Faces, Form, Grid, Room, Triangles, in_its_box
from psph.scene.forms.joined import Together, Union
from psph.scene.forms.plain import BehindPlane, Boxed, Round
from psph.scene.forms.polygon import Polygonal

QUARTER = 90.0


class Map(NamedTuple):
    """x → ``scale`` ``turn`` x + ``shift``: of an orthogonal matrix (dim, dim), and a shift (dim,) in m."""

    scale: float
    turn: np.ndarray
    shift: np.ndarray

    @classmethod
    def none(cls, dimensions: int) -> "Map":
        """That leaves all where it is."""
        return cls(1.0, np.eye(dimensions), np.zeros(dimensions))

    @classmethod
    def about(cls, turn: np.ndarray, point: np.ndarray) -> "Map":
        """A turn that leaves a ``point`` where it is."""
        return cls(1.0, turn, point - turn @ point)

    def after(self, first: "Map") -> "Map":
        """This map of what another has moved."""
        shift = self.scale * (self.turn @ first.shift) + self.shift
        return Map(self.scale * first.scale, self.turn @ first.turn, shift)

    def points(self, x: np.ndarray) -> np.ndarray:
        """Where points (n, dim) come to lie."""
        return self.scale * (x @ self.turn.T) + self.shift

    def back(self, x: np.ndarray) -> np.ndarray:
        """Where points (n, dim) were."""
        return (x - self.shift) @ self.turn / self.scale

    @property
    def keeps_axes(self) -> bool:
        """Whether axes become axes."""
        return bool((np.abs(self.turn).max(axis=0) == 1.0).all())


class Moved(Form):
    """A form that a ``map`` moves."""

    def __init__(self, of: Form, map: Map):
        self.of, self.map, self.dimensions = of, map, of.dimensions

    def holds(self, grid: Grid, by: np.ndarray, slack: float) -> np.ndarray:
        """As psph.scene.forms.form says; of a grid only the points in the box around it are looked at."""
        return in_its_box(self, self._holds, grid, by, slack)

    def _holds(self, grid: Grid, by: np.ndarray, slack: float) -> np.ndarray:
        scale, turn, shift = self.map
        shape = np.broadcast_shapes(*(np.shape(x) for x in grid))
        moved = [x - s for x, s in zip(grid, shift)]
        inner = [sum(x * c for x, c in zip(moved, column) if c) / scale for column in turn.T]
        return np.broadcast_to(self.of.holds(inner, by @ turn / scale, slack / scale), shape)

    def support(self, way: np.ndarray) -> float:
        """As psph.scene.forms.form says."""
        return self.map.scale * self.of.support(way @ self.map.turn) + float(self.map.shift @ way)

    def faces(self, points: np.ndarray, room: Room | None = None) -> Faces:
        """As psph.scene.forms.form says."""
        found = self.of.faces(self.map.back(points), None if room is None else self._inner(*room))
        return Faces(self.map.scale * found.away, found.normal @ self.map.turn.T)

    def _inner(self, lower: np.ndarray, upper: np.ndarray) -> Room:
        """The box around a box, as the form lies."""
        ends = self.map.back(np.array([*product(*zip(lower, upper))]))
        return ends.min(axis=0), ends.max(axis=0)

    def corners(self, apart: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        return self.map.points(self.of.corners(apart / self.map.scale))

    def straight(self, apart: float) -> np.ndarray:
        """As psph.scene.forms.form says."""
        return self.map.points(self.of.straight(apart / self.map.scale))

    def endless(self, lower: np.ndarray, upper: np.ndarray, periods: Sequence[float | None]) -> Form:
        """As psph.scene.forms.form says, along axes that stay axes."""
        to = np.abs(self.map.turn).argmax(axis=0)
        stays = np.abs(self.map.turn).max(axis=0) == 1.0
        inner = [periods[d] if stay else None for d, stay in zip(to, stays)]
        return Moved(self.of.endless(*self._inner(lower, upper), inner), self.map)

    def pieces(self) -> Iterator[Form]:
        """As psph.scene.forms.form says."""
        return (placed(one, self.map) for one in self.of.pieces())

    def surface(self, spacing: float, lines: Sequence[np.ndarray]) -> Triangles:
        """As psph.scene.forms.form says."""
        fine = spacing / self.map.scale
        ends = self.map.back(np.array([*product(*((x[0], x[-1]) for x in lines))]))
        own = [np.clip(end, *far) for end, far in zip(zip(*self.of.bounds), zip(ends.min(0), ends.max(0)))]
        inner = [np.union1d(end, np.arange(*end, fine)) for end in own]
        faces = self.of.surface(fine, inner)
        return self.map.points(faces.reshape(-1, 3)).reshape(-1, 3, 3)

    def outline(self, spacing: float) -> list[np.ndarray]:
        """As psph.scene.forms.form says."""
        return [self.map.points(line) for line in self.of.outline(spacing / self.map.scale)]


def placed(form: Form, map: Map) -> Form:
    """A form that a map moves: what stays of its kind is drawn anew, so that a box turned by a right angle is
    a box."""
    match form:
        case Moved(of=of):
            return placed(of, map.after(form.map))
        case Round(center=center, radius=radius):
            return Round(map.points(np.array([center]))[0], map.scale * radius)
        case Polygonal(points=points):
            return Polygonal(map.points(np.array(points)))
        case BehindPlane(at=at, normal=normal):
            return BehindPlane(map.points(at[None])[0], map.turn @ normal)
        case Boxed(lower=lower, upper=upper) if map.keeps_axes:
            ends = map.points(np.array([lower, upper]))
            return Boxed(ends.min(axis=0), ends.max(axis=0))
        case Boxed(lower=(left, down), upper=(right, up)):
            corners = np.array([(left, down), (right, down), (right, up), (left, up)])
            return Polygonal(map.points(corners))
        case Together() if map.keeps_axes:
            return form.each(lambda one: placed(one, map))
    return Moved(form, map)


def placed_as(form: Form, keys: Placing) -> Form:
    """A form where the keys of a shape put it."""
    if not keys.is_placed:
        return form
    none = Map.none(form.dimensions)
    steps = [none._replace(scale=keys.scale)] if keys.scale else []
    steps += [mirrored(keys.mirror)] if keys.mirror else []
    steps += [turned(turn, form.dimensions) for turn in keys.rotate]
    steps += [none._replace(shift=np.array(keys.move))] if keys.move else []
    whole = reduce(lambda first, then: then.after(first), steps, none)
    copies = [placed(form, whole)] if steps else [form]
    for one in keys.repeat:
        maps = [*repeated(one, form.dimensions)]
        copies = [placed(copy, map) for map in maps for copy in copies]
    return copies[0] if len(copies) == 1 else Union(copies)


def mirrored(face: FlatFace) -> Map:
    """The mirror image at a plane."""
    normal = np.array(face.normal) / math.hypot(*face.normal)
    return Map.about(np.eye(len(normal)) - 2.0 * np.outer(normal, normal), np.array(face.at))


def turned(turn: Turn, dimensions: int) -> Map:
    """A turn about an axis through a point (Rodrigues); by a right angle to the last bit."""
    cosine, sine = cosine_and_sine(turn.degrees)
    if dimensions < 3:
        matrix = np.array([[cosine, -sine], [sine, cosine]])[:dimensions, :dimensions]
    else:
        x, y, z = axis = np.array(turn.axis) / math.hypot(*turn.axis)
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        matrix = cosine * np.eye(3) + sine * cross + (1.0 - cosine) * np.outer(axis, axis)
    return Map.about(matrix, np.array(turn.about or (0.0,) * dimensions))


def cosine_and_sine(degrees: float) -> tuple[float, float]:
    """Of an angle; of right angles to the last bit."""
    quarters, rest = divmod(degrees, QUARTER)
    cosine, sine = math.cos(math.radians(rest)), math.sin(math.radians(rest))
    for _ in range(int(quarters) % 4):
        cosine, sine = -sine, cosine
    return cosine, sine


def repeated(one: Repeat, dimensions: int) -> Iterator[Map]:
    """The maps of all copies, the first where the shape is; turns are taken from the first, so that rounding
    does not add up."""
    for k in range(one.count):
        turn = (
            turned(one.turn.model_copy(update={"degrees": k * one.turn.degrees}), dimensions)
            if one.turn
            else Map.none(dimensions)
        )
        step = k * np.array(one.step) if one.step else np.zeros(dimensions)
        yield turn._replace(shift=turn.shift + step)


def frame_of(axis: str | Sequence[float], axes: Sequence[str]) -> np.ndarray:
    """A turn (3, 3) that brings z to a direction, given by name or as a vector; of axes by name to axes."""
    ahead = np.eye(3)[axes.index(axis)] if isinstance(axis, str) else np.array(axis) / math.hypot(*axis)
    if (np.abs(ahead) == 1.0).any():
        d = int(np.abs(ahead).argmax())
        return np.column_stack([np.eye(3)[(d + 1) % 3], np.eye(3)[(d + 2) % 3], ahead]) * [1, ahead[d], 1]
    aside = np.cross(ahead, np.eye(3)[int(np.abs(ahead).argmin())])
    aside /= np.linalg.norm(aside)
    return np.column_stack([aside, np.cross(ahead, aside), ahead])
