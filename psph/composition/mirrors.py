"""Plane mirrors: what a particle sees of its neighbours, and of itself, behind a plane.

Of two particles on one side of a plane, the image of the second is never nearer to the first than the second
itself.  So the images within reach are those of a particle's own neighbours and of itself: a second look at
the same row, without ghost particles, further lists or messages.  In a right-angled corner the image of an
image is seen the same way.
"""

from collections.abc import Sequence
from itertools import product
from typing import Any, NamedTuple

import numpy as np
from numba.core import types

from psph.engine.jit import overload, register_jitable, tuple_of, unrolled
from psph.engine.simd import AHEAD
from psph.vectors import along

BELOW, ABOVE = -1, 1
"""On which side of the particles a plane is."""


class Plane(NamedTuple):
    """A mirror across ``axis`` at ``at`` m, ``side`` (BELOW or ABOVE) of the particles.

    ``sticks``: images move so that the fluid between has the ``velocity`` of the plane, m/s, on the face;
    else they slide along it.
    """

    axis: int
    side: int
    at: float
    sticks: bool = False
    velocity: tuple[float, ...] = ()


ABSENT = -1
"""Components of an entry that a scene does not need."""


class Mirrors(NamedTuple):
    """All that is seen beside a plane: image m of a particle stands at ``turn[m]`` x + ``shift[m]``, m.

    It moves with ``turn_velocity[m]`` v + ``shift_velocity[m]``, m/s; the first is the particle itself.
    Arrays are (images, dim).  ``gravity`` in m/s², None on an axis without: a still column goes on behind
    the plane.  ``reach`` m: farther from a plane nothing is seen in it.  From entry ``own`` of the lists
    on each column stands once, in order: a particle in a row of its own.
    """

    turn: Any
    shift: Any
    turn_velocity: Any
    shift_velocity: Any
    gravity: tuple
    reach: float
    own: Any

    def seen(self, m: int, point) -> tuple[float, ...]:
        """Image m of a point, m."""
        return tuple((self.turn[m] * point + self.shift[m]).tolist())


def mirrors_of(planes: Sequence[Plane], gravity, reach: float) -> Mirrors | None:
    """What is seen beside some planes, under ``gravity`` m/s², from ``reach`` m on; None without planes."""
    if not planes:
        return None
    dimensions = len(gravity)
    beside: list[list[Plane | None]] = [
        [None, *(plane for plane in planes if plane.axis == d)] for d in range(dimensions)
    ]
    found = [_reflections(chosen, dimensions) for chosen in product(*beside)]
    turn, shift, turn_velocity, shift_velocity = (np.array(rows) for rows in zip(*found))
    pull = tuple(float(g) or None for g in gravity)
    return Mirrors(turn, shift, turn_velocity, shift_velocity, pull, reach, np.uint64(0))


def _reflections(chosen, dimensions: int):
    """One reflection after the other, in the planes among ``chosen``."""
    turn, shift = np.ones(dimensions), np.zeros(dimensions)
    turn_velocity, shift_velocity = np.ones(dimensions), np.zeros(dimensions)
    for plane in filter(None, chosen):
        turn[plane.axis], shift[plane.axis] = -1.0, 2.0 * plane.at
        turned = np.arange(dimensions) == plane.axis
        if plane.sticks:
            turned[:] = True
        sign = np.where(turned, -1.0, 1.0)
        turn_velocity, shift_velocity = sign * turn_velocity, sign * shift_velocity
        if plane.sticks:
            shift_velocity += 2.0 * np.array(plane.velocity)
    return turn, shift, turn_velocity, shift_velocity


def with_own_rows(mirrors: Mirrors | None, columns: int, lists):
    """The mirrors for so many columns, and their ``lists`` (psph.particles.neighbours) with each column
    once more behind them."""
    if mirrors is None:
        return None, lists
    own = np.minimum(np.arange(columns + AHEAD), max(columns - 1, 0)).astype(lists.lists.dtype)
    longer = np.concatenate([lists.lists, own])[: len(lists.lists) + columns]
    return mirrors._replace(own=np.uint64(len(lists.lists))), lists._replace(lists=longer)


def images(mirrors: Mirrors | None) -> int:
    """How many of each particle there are to see, itself among them."""
    return 1 if mirrors is None else len(mirrors.turn)


def looks(mirrors, i) -> int:
    """How often a particle looks at its row: once, and near a plane for each image at the row and at
    itself."""
    return 1 if mirrors is None else _looks(mirrors, i)


@overload(looks)
def _typed_looks(mirrors, i):
    if isinstance(mirrors, types.NoneType):
        return lambda mirrors, i: 1
    return lambda mirrors, i: _looks(mirrors, i)


@register_jitable
def _looks(mirrors, i):
    found = 1
    for m in range(1, len(mirrors.turn)):
        if _near(mirrors, m, i):
            found = 2 * m + 1
    return found


def ends(mirrors, look, lists, row, k, i):
    """The first entry and the one behind the last in ``lists`` of what particle i in column k looks at."""
    begin = lists.begin[row]
    end = begin + np.uint64(lists.lengths[row])
    return (begin, end) if mirrors is None else _ends(mirrors, look, begin, end, k, i)


@overload(ends)
def _typed_ends(mirrors, look, lists, row, k, i):
    if isinstance(mirrors, types.NoneType):
        return lambda mirrors, look, lists, row, k, i: (
            lists.begin[row],
            lists.begin[row] + np.uint64(lists.lengths[row]),
        )
    return lambda mirrors, look, lists, row, k, i: _ends(
        mirrors, look, lists.begin[row], lists.begin[row] + np.uint64(lists.lengths[row]), k, i
    )


@register_jitable
def _ends(mirrors, look, begin, end, k, i):
    if look == 0:
        return begin, end
    if begin == end or not _near(mirrors, (look + 1) // 2, i):
        return begin, begin
    if look % 2 == 1:
        return begin, end
    return mirrors.own + np.uint64(k), mirrors.own + np.uint64(k) + np.uint64(1)


@register_jitable
def _near(mirrors, m, i):
    """Whether particle i is near all planes of an image."""
    near = True
    for d in range(mirrors.turn.shape[1]):
        away = abs(2.0 * i.position[d] - mirrors.shift[m, d])
        near = near and (mirrors.turn[m, d] > 0.0 or away < 2.0 * mirrors.reach)
    return near


def image(mirrors, look, i, j):
    """Neighbours j as particle i sees them at a look: a field is a vector, a symmetric
    matrix or a matrix by the number of its components."""
    return j if mirrors is None or look == 0 else _image(mirrors, (look + 1) // 2, i, j)


@overload(image)
def _typed_image(mirrors, look, i, j):
    if isinstance(mirrors, types.NoneType):
        return lambda mirrors, look, i, j: j
    return lambda mirrors, look, i, j: j if look == 0 else _image(mirrors, (look + 1) // 2, i, j)


def _image(mirrors, m, i, j):
    widths = (ABSENT if entry is None else len(entry) if isinstance(entry, tuple) else 0 for entry in j)
    return _seen(type(j), tuple(widths))(mirrors, m, i, j)


@overload(_image)
def _typed_image_of(mirrors, m, i, j):
    widths = (
        ABSENT if isinstance(kind, types.NoneType) else len(kind) if isinstance(kind, types.BaseTuple) else 0
        for kind in j.types
    )
    return _seen(j.instance_class, tuple(widths))


def _seen(view, widths: tuple[int, ...]):
    """The function (mirrors, m, i, j) → image m of a ``view`` j whose entries have so many components."""
    dimensions = widths[view._fields.index("position")]
    parts = (_text(name, width, dimensions) for name, width in zip(view._fields, widths))
    return unrolled("mirrors, m, i, j", f"return View{tuple_of(parts)}", View=view, weight=weight_behind)


def _text(name: str, width: int, dimensions: int) -> str:
    """How an image has the entry ``name``, of ``width`` components, or 0 for a number."""
    axes = range(dimensions)
    if width == ABSENT:
        return f"j.{name}"
    if name == "position":
        return tuple_of(f"mirrors.turn[m, {d}] * j.position[{d}] + mirrors.shift[m, {d}]" for d in axes)
    if name == "velocity":
        return tuple_of(
            f"mirrors.turn_velocity[m, {d}] * j.velocity[{d}] + mirrors.shift_velocity[m, {d}]" for d in axes
        )
    if name == "pressure":
        return "j.pressure + weight(mirrors, m, i, j)"
    if name == "specific_volume":
        squared = "(i.sound_speed * i.sound_speed)"
        return f"j.specific_volume / (1.0 + j.specific_volume * (weight(mirrors, m, i, j) / {squared}))"
    if name == "density":
        return "j.density + weight(mirrors, m, i, j) / (i.sound_speed * i.sound_speed)"
    signs: dict[int, list[tuple[int, ...]]] = {
        dimensions: [(d,) for d in axes],
        dimensions * (dimensions + 1) // 2: [(d, e) for d in axes for e in axes if d <= e],
        dimensions**2: [(d, e) for d in axes for e in axes],
    }
    if not width:
        return f"j.{name}"
    turns = (" * ".join(f"mirrors.turn[m, {d}]" for d in odd) for odd in signs[width])
    return tuple_of(f"{turn} * j.{name}[{place}]" for place, turn in enumerate(turns))


@register_jitable
def weight_behind(mirrors, m, i, j):
    """By how much the pressure of a still column is higher at the image than at j itself, Pa."""
    return i.rest_density * along(_way(mirrors, m, j), mirrors.gravity)


def _way(mirrors, m, j):
    """From j to its image, m."""
    return tuple(mirrors.turn[m, d] * x + mirrors.shift[m, d] - x for d, x in enumerate(j.position))


@overload(_way)
def _typed_way(mirrors, m, j):
    kinds = dict(zip(j.instance_class._fields, j.types))
    parts = (
        f"mirrors.turn[m, {d}] * j.position[{d}] + mirrors.shift[m, {d}] - j.position[{d}]"
        for d in range(len(kinds["position"]))
    )
    return unrolled("mirrors, m, j", f"return {tuple_of(parts)}")
