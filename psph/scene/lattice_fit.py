"""Widths of a case against its spacing: a box whose width is not a whole number of spacings changes size."""

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from psph.case.keys import AXES
from psph.case.shapes import Shape
from psph.scene.forms.form import Form
from psph.scene.forms.joined import Less, Union
from psph.scene.forms.make import form_of
from psph.scene.forms.plain import Boxed
from psph.scene.lattice import TOLERANCE, sites_between
from psph.scene.scene import Scene

WIDEST_MISFIT = 1e-3
"""Part of a width that the lattice may change without a warning: far below the errors of a run."""

FARTHEST = 1.5
"""A spacing that fits is looked for up to this factor away."""


class Width(NamedTuple):
    """The width of a box, or a period, along an axis; ``key`` of the case, ends in m."""

    key: str
    axis: int
    lower: float
    upper: float

    @property
    def length(self) -> float:
        """In m."""
        return self.upper - self.lower


def widths(scene: Scene) -> list[Width]:
    """Of every box of a fluid, a solid or a body and every closed room in a wall, and the periods."""
    case = scene.case
    found = [
        Width("space.upper", d, low, low + period)
        for d, (low, period) in enumerate(zip(scene.layout.lower, scene.layout.periods))
        if period is not None
    ]
    for part in scene.layout.parts:
        if part.drawn and (part.moves_freely or part.moves_whole):
            found += (Width(part.key, *side) for box in _boxes(form_of(part.shape)) for side in _sides(box))
    for name, wall in case.walls.items():
        found += (Width(f"walls.{name}", *side) for side in _cavities(form_of(wall.shape)))
    return found


def misfits(scene: Scene, spacing: float | None = None) -> Iterator[str]:
    """A line for each fluid, wall and axis whose width the lattice changes noticeably.

    At a ``spacing`` in m, by default that of the scene.
    """
    every, dx = widths(scene), spacing or scene.spacing
    said = set()
    for width in every:
        number = width.length / dx
        low, end = sites_between(width.lower, width.upper, scene.case.space.origin[width.axis], dx)
        change = abs((end - low) * dx / width.length - 1.0)
        if change < WIDEST_MISFIT or (width.key, width.axis) in said:
            continue
        said.add((width.key, width.axis))
        nearest = nearest_fit(dx, [other.length for other in every])
        fits = f"{nearest:.6g} fits" if nearest else f"{width.length / max(1, round(number)):.6g} fits it"
        yield (
            f"{width.key} is {width.length:.6g} m wide along {AXES[width.axis]}, which is {number:.4g} "
            f"spacings of {dx:.6g} m: the lattice makes it {end - low}; space.spacing = {fits}"
        )


def fits(spacing: float, lengths: Sequence[float]) -> bool:
    """Whether every length is a whole number of spacings."""
    numbers = [length / spacing for length in lengths]
    return all(round(n) >= 1 and abs(n - round(n)) <= TOLERANCE * max(1.0, n) for n in numbers)


def nearest_fit(
    spacing: float, lengths: Sequence[float], least: float = 1.0 / FARTHEST, most: float = FARTHEST
) -> float | None:
    """The spacing in m nearest to ``spacing`` of which all lengths are whole multiples, or None.

    Between ``least`` and ``most`` times ``spacing``.
    """
    shortest = min(lengths)
    first = math.ceil(shortest / (most * spacing) - TOLERANCE)
    last = math.floor(shortest / (least * spacing) + TOLERANCE)
    tried = (shortest / n for n in range(max(first, 1), last + 1))
    return min((x for x in tried if fits(x, lengths)), key=lambda x: abs(math.log(x / spacing)), default=None)


def _boxes(form: Form) -> Iterator[Boxed]:
    """The boxes that a form is made of."""
    match form:
        case Union(parts=parts):
            for one in parts:
                yield from _boxes(one)
        case Less(base=base):
            yield from _boxes(base)
        case Boxed():
            yield form


def is_of_boxes(shape: Shape) -> bool:
    """Whether a shape is one box, or several."""
    return _is_of_boxes(form_of(shape))


def _is_of_boxes(form: Form) -> bool:
    return all(map(_is_of_boxes, form.parts)) if isinstance(form, Union) else isinstance(form, Boxed)


def _sides(box: Boxed) -> Iterator[tuple[int, float, float]]:
    for d, (low, up) in enumerate(zip(box.lower, box.upper)):
        yield d, low, up


def _cavities(form: Form) -> Iterator[tuple[int, float, float]]:
    """Axis and ends of the rooms that a form leaves; not along an axis where a room is open."""
    match form:
        case Union(parts=parts):
            for one in parts:
                yield from _cavities(one)
        case Less(base=base, minus=minus):
            yield from _cavities(base)
            lower, upper = base.bounds
            for box in (box for one in minus for box in _boxes(one)):
                yield from (
                    side for side in _sides(box) if lower[side[0]] < side[1] and side[2] < upper[side[0]]
                )
