"""Plane mirrors: what a particle sees of its neighbours, and of itself, behind a plane.

Of two particles on one side of a plane, the image of the second is never nearer to the first than the second
itself.  So the images within reach are those of a particle's own neighbours and of itself: a second look at
the same row, without ghost particles, further lists or messages.  In a right-angled corner the image of an
image is seen the same way.
"""

from functools import cache

import numpy as np
from numba.core import types

from psph.composition.reflections import Mirrors
from psph.engine.jit import overload, register_jitable, tuple_of, unrolled
from psph.engine.simd import AHEAD
from psph.fields import (
    Continued,
    Drifting,
    Moving,
    Numbered,
    Place,
    Same,
    StillDensity,
    StillPressure,
    StillSlope,
    StillVolume,
    StrainRate,
    Stress,
    StressUnderWeight,
    Turned,
    VelocityGradient,
    indices,
)
from psph.vectors import along

ABSENT = -1
"""Components of an entry that a scene does not need."""


def with_own_rows(mirrors: Mirrors | None, columns: int, lists):
    """The mirrors for so many columns, and their ``lists`` (psph.particles.neighbours) with each column
    once more behind them."""
    if mirrors is None:
        return None, lists
    own = np.minimum(np.arange(columns + AHEAD), max(columns - 1, 0)).astype(lists.lists.dtype)
    longer = lists._replace(lists=_extended(lists.lists, own))
    return mirrors._replace(own=np.uint64(len(lists.lists))), longer


def _extended(entries: np.ndarray, more: np.ndarray) -> np.ndarray:
    """The ``entries`` and ``more`` behind them, the last of which only serve to be looked ahead into; without
    a copy where psph.particles.neighbours has left room."""
    begin, end, whole = len(entries), len(entries) + len(more), entries.base
    if whole is None or len(whole) < end:
        whole = np.concatenate([entries, more])
    whole[begin:end] = more
    return whole[: end - AHEAD]


def images(mirrors: Mirrors | None) -> int:
    """How many of each particle there are to see, itself among them."""
    return 1 if mirrors is None else len(mirrors.reflections)


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
    for m in range(1, len(mirrors.reflections)):
        if _near(mirrors.reflections[m], mirrors.reach, i):
            found = 2 * m + 1
    return found


def ends(mirrors, look, begin, end, k, i):
    """The first entry of the lists and the one behind the last of what particle i in column k looks at;
    its row is from ``begin`` to ``end``."""
    return (begin, end) if mirrors is None or look == 0 else _ends(mirrors, look, begin, end, k, i)


@overload(ends)
def _typed_ends(mirrors, look, begin, end, k, i):
    if isinstance(mirrors, types.NoneType):
        return lambda mirrors, look, begin, end, k, i: (begin, end)
    return lambda mirrors, look, begin, end, k, i: _ends(mirrors, look, begin, end, k, i)


@register_jitable
def _ends(mirrors, look, begin, end, k, i):
    if look == 0:
        return begin, end
    if begin == end or not _near(mirrors.reflections[(look + 1) // 2], mirrors.reach, i):
        return begin, begin
    if look % 2 == 1:
        return begin, end
    return mirrors.own + np.uint64(k), mirrors.own + np.uint64(k) + np.uint64(1)


@register_jitable
def _near(reflection, reach, i):
    """Whether particle i is near all planes of an image."""
    near = True
    for d in range(len(reflection.turn)):
        away = abs(2.0 * i.position[d] - reflection.shift[d])
        near = near and (reflection.turn[d] > 0.0 or away < 2.0 * reach)
    return near


def at_look(mirrors, look):
    """The reflection that a particle sees at a look; None where there are no mirrors."""
    return None if mirrors is None else mirrors.reflections[(look + 1) // 2]


@overload(at_look)
def _typed_at_look(mirrors, look):
    if isinstance(mirrors, types.NoneType):
        return lambda mirrors, look: None
    return lambda mirrors, look: mirrors.reflections[(look + 1) // 2]


def image(reflection, i, j):
    """Neighbours j as particle i sees them in a reflection: each field turns as it declares, and is a vector,
    a symmetric matrix or a matrix by the number of its components."""
    return j if reflection is None else _image(reflection, i, j)


@overload(image)
def _typed_image(reflection, i, j):
    if isinstance(reflection, types.NoneType):
        return lambda reflection, i, j: j
    return lambda reflection, i, j: _image(reflection, i, j)


def _image(reflection, i, j):
    widths = (ABSENT if entry is None else len(entry) if isinstance(entry, tuple) else 0 for entry in j)
    rules = reflection.rules
    return _seen(type(j), tuple(widths), rules._fields, tuple(map(type, rules)))(reflection, i, j)


@overload(_image)
def _typed_image_of(reflection, i, j):
    widths = (
        ABSENT if isinstance(kind, types.NoneType) else len(kind) if isinstance(kind, types.BaseTuple) else 0
        for kind in j.types
    )
    rules = dict(zip(reflection.instance_class._fields, reflection.types))["rules"]
    kinds = (getattr(kind, "instance_class", type(None)) for kind in rules.types)
    return _seen(j.instance_class, tuple(widths), rules.instance_class._fields, tuple(kinds))


@cache
def _seen(view, widths: tuple[int, ...], names: tuple[str, ...], kinds: tuple[type, ...]):
    """The function (reflection, i, j) → the image of a ``view`` j whose entries have so many components, by
    the rules of the ``names``, which are of these ``kinds``."""
    rules = dict(zip(names, kinds))
    dimensions = widths[view._fields.index("position")]
    told = dict(zip(view._fields, widths))
    # Of one matter no loop need read them of a neighbour; of several each image is of its own.
    known = all(told.get(name, ABSENT) != ABSENT and rules[name] is not type(None) for name in OF_COLUMN)
    if told.get("pressure", ABSENT) == ABSENT:
        rules = {name: Stress if rule is StressUnderWeight else rule for name, rule in rules.items()}
    parts = (
        f"j.{name}" if width == ABSENT else _text(name, rules[name], width, dimensions, "ij"[known])
        for name, width in told.items()
    )
    return unrolled(
        "reflection, i, j",
        f"return View{tuple_of(parts)}",
        View=view,
        weight=weight_behind,
        slope=slope_behind,
        steeper=steeper_behind,
    )


OF_COLUMN = ("rest_density", "sound_speed")
STILL = "weight(reflection, {of}, j)"
SQUARED = "({of}.sound_speed * {of}.sound_speed)"

OF_NUMBERS = {
    Same: "j.{name}",
    StillPressure: f"j.{{name}} + {STILL}",
    StillDensity: f"j.{{name}} + {STILL} / {SQUARED}",
    StillVolume: f"j.{{name}} / (1.0 + j.{{name}} * ({STILL} / {SQUARED}))",
    Numbered: "{least} * j.{name}",
    Continued: "reflection.goes_on * j.{name}",
}
"""How an image has a number, by the rule that its field declares."""

OF_COMPONENTS = {
    Place: "reflection.turn[{d}] * j.{name}[{n}] + reflection.shift[{d}]",
    Moving: "reflection.turn_velocity[{d}] * j.{name}[{n}] + reflection.shift_velocity[{d}]",
    Drifting: "reflection.turn_velocity[{d}] * j.{name}[{n}]",
    Turned: "{turn} * j.{name}[{n}]",
    VelocityGradient: "reflection.turn_velocity[{d}] * reflection.turn[{e}] * j.{name}[{n}]",
    StrainRate: "reflection.turn_strain[{n}] * j.{name}[{n}]",
    Stress: "reflection.turn_stress[{n}] * j.{name}[{n}]",
    StressUnderWeight: "steeper(reflection, {of}, j) * (reflection.turn_stress[{n}] * j.{name}[{n}])",
    StillSlope: "reflection.turn[{d}] * j.{name}[{n}] + slope(reflection, {of})[{d}]",
}
"""How it has component n of a vector along axis d, or of a matrix of axes d and e."""


def _text(name: str, rule: type, width: int, dimensions: int, of: str) -> str:
    """How an image has the entry ``name``, of ``width`` components, or 0 for a number, by a ``rule``; ``of``
    is which of i and j a still column is made of."""
    axes = range(dimensions)
    if rule is type(None):  # nobody reads it of a neighbour: psph.simulation.reading
        return "None"
    if not width:
        least = f"min({', '.join(f'reflection.turn[{d}]' for d in axes)})"
        return OF_NUMBERS[rule].format(name=name, least=least, of=of)
    shapes = {len(at): at for at in indices(dimensions).values()}
    parts = (
        OF_COMPONENTS[rule].format(
            name=name, n=n, d=at[0], e=at[-1], of=of, turn=" * ".join(f"reflection.turn[{d}]" for d in at)
        )
        for n, at in enumerate(shapes[width])
    )
    return tuple_of(parts)


@register_jitable
def weight_behind(reflection, of, j):
    """By how much the pressure of a still column, made as ``of`` is, is higher at the image than at j, Pa."""
    return of.rest_density * along(_way(reflection, j), reflection.gravity)


STEEPEST = 3.0
"""Most by which a stress at an image may exceed that of the particle, as at walls of particles."""

NO_PRESSURE = 1e-30
"""Keeps no pressure from dividing by zero, Pa."""


@register_jitable
def steeper_behind(reflection, of, j):
    """By what a stress grows from j to its image with the weight of a still column, where a plane sticks.

    (p′ + T)/(p + T) of pressures above 0, T the mean tension at which there is no strength left.
    """
    own = max(j.pressure, 0.0) + j.cone_tip
    seen = max(j.pressure + weight_behind(reflection, of, j), 0.0) + j.cone_tip
    return 1.0 + reflection.sticks * (min(seen / (own + NO_PRESSURE), STEEPEST) - 1.0)


def slope_behind(reflection, i):
    """The gradient of what the weight of a still column adds to the density of an image, kg/m^(d+1).

    ρ′(x′) = ρ(x) + ρ₀ g·(x′ − x)/c² with x = turn x′ + shift, so that ∂ρ′/∂x′ = turn ∂ρ/∂x +
    (1 − turn) ρ₀ g/c² along each axis.
    """
    steep = i.rest_density / (i.sound_speed * i.sound_speed)
    return tuple((1.0 - turn) * (g or 0.0) * steep for turn, g in zip(reflection.turn, reflection.gravity))


@overload(slope_behind)
def _typed_slope_behind(reflection, i):
    kinds = dict(zip(reflection.instance_class._fields, reflection.types))
    steep = "(i.rest_density / (i.sound_speed * i.sound_speed))"
    parts = (
        "0.0"
        if isinstance(kind, types.NoneType)
        else f"(1.0 - reflection.turn[{d}]) * reflection.gravity[{d}] * {steep}"
        for d, kind in enumerate(kinds["gravity"])
    )
    return unrolled("reflection, i", f"return {tuple_of(parts)}")


def _way(reflection, j):
    """From j to its image, m."""
    return tuple(reflection.turn[d] * x + reflection.shift[d] - x for d, x in enumerate(j.position))


@overload(_way)
def _typed_way(reflection, j):
    kinds = dict(zip(j.instance_class._fields, j.types))
    parts = (
        f"reflection.turn[{d}] * j.position[{d}] + reflection.shift[{d}] - j.position[{d}]"
        for d in range(len(kinds["position"]))
    )
    return unrolled("reflection, j", f"return {tuple_of(parts)}")
