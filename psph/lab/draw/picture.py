"""The picture of a scene before it runs: particles and surfaces by their names, and all that is marked."""

import tomllib
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from psph.lab.draw.marks import Mark
from psph.lab.draw.start import AtStart
from psph.output.pictures import spatial, style
from psph.output.pictures.flat import Flat
from psph.output.pictures.groups import first_whole, wholes_of
from psph.output.pictures.quantities import quantity
from psph.output.pictures.scale import Scale, scale_of
from psph.output.pictures.view import Room, box_around, room_of
from psph.scene.layout import Layout

WIDEST, HIGHEST = 8.0, 5.6
"""Of the panel, inches."""

COLOURS = {"space": style.PALE, "mirror": style.INK, "ends": style.LINES[2], "physics": style.LINES[3]}
"""Of marks by their table."""

LINE, BESIDE, LETTER = 0.17, 0.07, 0.063
"""Inches from a label to the next, from a mark to its label, and of a letter."""


def colour_of(mark: Mark) -> str:
    """Its colour."""
    return style.INK if mark.matter else COLOURS.get(mark.table, style.LINES[1])


def picture(layout: Layout, start: AtStart, marks: list[Mark]) -> Figure:
    """A page with the scene.  Raises Refused where 3D cannot be drawn."""
    case, points = tomllib.loads(layout.case.to_toml()), [line for mark in marks for line in mark.lines]
    box = box_around(np.concatenate([start.frame["position"], *points]))
    room = room_of(case, [box], [box])
    panel, scale = _panel(layout, case, start, room, points), _scale(case, start)
    width = min(WIDEST, HIGHEST * panel.aspect)
    height = max(min(width / panel.aspect, HIGHEST), 1.2)
    page = style.LEFT + width + scale.width, style.TOP + height + style.BOTTOM
    with style.look():
        title = layout.case.title or layout.case.name
        count = f"{start.count:,} particles at the start, {start.apart} m apart"
        figure = style.sheet(*page, title, count)
        axes = style.panel(figure, style.LEFT, style.TOP, width, height)
        panel.draw(axes, start.frame | {"lines": {}}, scale, True, True)
        seen = _seen(panel, axes)
        _draw_marks(axes, marks, lambda points: seen(np.clip(points, room.lower, room.upper)))
        scale.draw_key(figure, style.panel(figure, style.LEFT + width + 0.15, style.TOP, 0.13, height))
    return figure


def _panel(layout: Layout, case: dict, start: AtStart, room: Room, points: list[np.ndarray]):
    whole = first_whole(case) if wholes_of(case) else None
    if layout.dimensions < 3:
        return Flat(room, None, (), whole)
    boxes = [
        {
            int(group): box_around(start.frame["position"][start.frame["group"] == group])
            for group in np.unique(start.frame["group"])
        }
    ]
    panel = spatial.scene(case, Path(layout.case.file).parent, start.frame, room, boxes, False)
    panel.see(np.clip(np.concatenate([start.frame["position"], *points]), room.lower, room.upper))
    return panel


def _scale(case: dict, start: AtStart) -> Scale:
    scale = scale_of(quantity(None, case, "group"), [])
    walls = () if len(start.parts) == len(scale.names) else (("walls", style.WALLS),)
    return scale._replace(others=(*scale.others, *walls))


def _seen(panel, axes: Axes):
    """How points (n, dim), m, come to lie on the axes."""
    if isinstance(panel, Flat):
        picked = [panel.across, panel.up]
        flat = panel.room.dimensions == 1
        return lambda points: points[:, [0, 0]] * [1.0, 0.0] if flat else points[:, picked]
    pixels = axes.figure.get_size_inches() * axes.get_position().size
    return panel.camera(pixels[0] / pixels[1]).seen


def _free(wanted: float, taken: list[float], highest: float) -> float:
    """The place nearest to one wanted, from 0 to the highest, a line from those that are taken; inches."""
    places = [wanted, *(y + way * LINE for y in taken for way in (-1.0, 1.0))]
    free = [y for y in places if all(abs(y - other) > 0.99 * LINE for other in taken)]
    within = [y for y in free if 0.0 <= y <= highest]
    return min(within or free, key=lambda y: abs(y - wanted))


def _draw_marks(axes: Axes, marks: list[Mark], seen) -> None:
    """Lines, dots and labels; a label gives way to those before it."""
    taken: list[tuple[float, float, float]] = []
    inch = axes.get_window_extent().size / axes.figure.dpi
    for mark in marks:
        colour, wide = colour_of(mark), LETTER * len(mark.label)
        for line in mark.lines:
            how = {"marker": "o", "ms": 4} if len(line) == 1 else {"lw": 1.0}
            axes.plot(*seen(line).T, color=colour, clip_on=False, **how)
        across, up = axes.transLimits.transform(seen(mark.middle[None])[0]) * inch + BESIDE
        across = float(np.clip(across, 0.0, max(inch[0] - wide, 0.0)))
        beside = [y for begin, y, end in taken if across < end and begin < across + wide]
        up = _free(float(np.clip(up, 0.0, inch[1] - LINE)), beside, inch[1] - LINE)
        taken.append((across, up, across + wide))
        box = {"facecolor": "white", "alpha": 0.75, "lw": 0, "pad": 0.6}
        place = {"x": across / inch[0], "y": up / inch[1], "transform": axes.transAxes, "va": "bottom"}
        axes.text(s=mark.label, color=colour, size=7.5, bbox=box, **place)
