"""What a case has beside matter: ends, gauges, joints, lines, zones, and the sides of the domain."""

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from psph.case.consistency import walk
from psph.case.errors import dotted
from psph.case.keys import AXES, Table
from psph.case.sketches import edges, rectangle
from psph.lab.draw.start import AtStart
from psph.scene.forms.make import form_of
from psph.scene.layout import Layout


class Mark(NamedTuple):
    """Lines through points (n, dim), m, each, a single one a dot, and what they are: a key of the case, and
    more in words; ``matter``: the key of a part."""

    key: str
    says: str
    lines: list[np.ndarray]
    matter: bool = False

    @property
    def label(self) -> str:
        """What stands beside it."""
        return f"{self.key} {self.says}".strip()

    @property
    def table(self) -> str:
        """The table of the case that it is of."""
        return self.key.partition(".")[0]

    @property
    def middle(self) -> np.ndarray:
        """Where its label stands (dim,), m."""
        points = np.concatenate(self.lines)
        return 0.5 * (points.min(axis=0) + points.max(axis=0))


def marks_of(layout: Layout, hung: Mapping[str, np.ndarray] = MappingProxyType({})) -> list[Mark]:
    """All that a picture of the scene shows beside its particles; ``hung``: points (n, dim), m, of lines
    that hang otherwise than straight, by their keys."""
    sketched = (
        mark._replace(lines=[hung[mark.key]]) if mark.key in hung else mark for mark in _sketched(layout)
    )
    return [
        *_domain(layout),
        *_ends(layout),
        *_zones(layout),
        *_refined(layout),
        *sketched,
        *_counted(layout),
    ]


def _mark(key: str, says: str, lines) -> Mark:
    return Mark(key, says, [np.array(line, float).reshape(-1, len(line[0])) for line in lines])


def names_of(start: AtStart) -> list[Mark]:
    """A mark on each part, at its particle nearest to the middle of all."""
    found = []
    for number, part in enumerate(start.parts):
        places = start.frame["position"][start.frame["group"] == number]
        if len(places):
            away = ((places - places.mean(axis=0)) ** 2).sum(axis=1)
            found.append(Mark(part.key, f"({len(places):,})", [places[[away.argmin()]]], True))
    return found


def _sketched(layout: Layout) -> Iterator[Mark]:
    """What tables of the case say of themselves."""
    for loc, value in walk(layout.case):
        if isinstance(value, Table) and (lines := [*value.sketch()]):
            yield _mark(dotted(loc), "", lines)


def _domain(layout: Layout) -> Iterator[Mark]:
    space, ends = layout.case.space, (layout.lower, layout.upper)
    if space.lower or space.upper:
        periodic = f"(repeats along {', '.join(space.periodic)})" if space.periodic else ""
        yield _mark("space", periodic, edges(*ends))
    for plane in layout.mirror_planes:
        yield _mark("mirror", f"{AXES[plane.axis]} = {plane.at:g} m", [_across(plane.axis, plane.at, ends)])


def _ends(layout: Layout) -> Iterator[Mark]:
    """The plane of each end, and a line inwards as deep as its rows."""
    seen = set()
    for number in layout.parts.ends:
        part = layout.parts[number]
        if part.key in seen:
            continue
        seen.add(part.key)
        end, box = part.table.end, form_of(part.shape).bounds
        deep = end.sign * (box[1][end.axis] - box[0][end.axis])
        yield _mark(part.key, f"({end.given}, {end.inward})", _passed(end.axis, end.at, box, deep))


def _zones(layout: Layout) -> Iterator[Mark]:
    """Effects that act between two places along an axis."""
    ends = layout.lower, layout.upper
    for name, zone in layout.case.physics:
        if all(hasattr(zone, key) for key in ("begin", "end", "axis")):
            axis = AXES.index(zone.axis)
            planes = [_across(axis, at, ends) for at in (zone.begin, zone.end)]
            yield _mark(f"physics.{name}", "", [*planes, *zip(*(plane[:-1] for plane in planes))])


def _refined(layout: Layout) -> Iterator[Mark]:
    """Regions with finer particles: in 2D their outlines, in 3D the boxes around them."""
    for one in layout.case.space.refine:
        form, times = form_of(one.shape), f"({one.factor} times finer"
        box = np.clip(form.bounds, layout.lower, layout.upper)
        if layout.dimensions == 2:
            outline = [np.clip(line, *box) for line in form.outline(layout.spacing)]
            lines = [np.concatenate([line, line[:1]]) for line in outline]
            yield Mark(one.where, f"{times})", lines)
        else:
            yield _mark(one.where, f"{times}, the box around it)", edges(*map(tuple, box)))


def _counted(layout: Layout) -> Iterator[Mark]:
    """Where gauges count fluid: the box around a shape, all of the domain, or what is beyond a crest."""
    for name, gauge in layout.case.gauges.items():
        asked, domain = getattr(gauge, gauge.kind), (layout.lower, layout.upper)
        if not hasattr(asked, "shape"):
            continue
        box = domain if asked.shape is None else np.clip(form_of(asked.shape).bounds, *domain)
        lines, says = edges(*map(tuple, box)), "" if asked.shape is None else "(the box around it)"
        if hasattr(asked, "towards"):
            axis = AXES.index(asked.towards[1])
            beyond = box[1][axis] - asked.at if asked.towards[0] == "+" else box[0][axis] - asked.at
            crest = _passed(axis, asked.at, box, beyond)
            lines, says = crest if asked.shape is None else [*crest, *lines], f"({asked.towards})"
        yield _mark(f"gauges.{name}.{gauge.kind}", says, lines)


def _passed(axis: int, at: float, box, far: float) -> list:
    """The plane across an axis in a box, and a line from its middle so far, m, along the axis."""
    face = _across(axis, at, box)
    middle = np.mean([np.array(face).min(axis=0), np.array(face).max(axis=0)], axis=0)
    return [face, (middle, middle + far * (np.arange(len(middle)) == axis))]


def _across(axis: int, at: float, ends) -> tuple:
    """The rectangle across an axis in a box; in 2D a line, in 1D a point."""
    lower, upper = (tuple(at if d == axis else x for d, x in enumerate(end)) for end in ends)
    return rectangle(lower, upper) if len(lower) > 1 else (lower,)
