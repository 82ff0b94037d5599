"""Particles as circles in a plane: a flow in 2D, a slice of one in 3D; in 1D a curve."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection

from psph.case.keys import AXES
from psph.errors import Refused, one_line
from psph.fields import WALL
from psph.output.errors import NotThere
from psph.output.pictures import style
from psph.output.pictures.scale import Scale
from psph.output.pictures.view import Room

THICK = 0.6
"""Spacings from a slice within which particles are in it: half-way between two layers both are, also where
they have moved apart a little."""

TELLING = 4.0
"""Size in points (1/72 inch) above which single particles are visible."""

SMALLEST_DOT, LARGEST_DOT = 2.0, 6.0
"""Points of a dot in 1D, whose height is a value."""


class Slice(NamedTuple):
    """The plane across ``axis`` at ``place`` m."""

    axis: int
    place: float


def slice_of(text: str, option: str = "plot --slice") -> Slice:
    """What ``y=0.5`` asks for.  Refused if it is not an axis and a number."""
    name, _, place = text.partition("=")
    try:
        if name in AXES and math.isfinite(float(place)):
            return Slice(AXES.index(name), float(place))
    except ValueError:
        pass
    raise Refused(one_line(f"{option} {text}: not a plane; write an axis and a place in m, such as y=0.5"))


class Flat:
    """The particles of a room in a plane; of a room in 3D those at ``cut``.

    ``mirrors`` (axis and place, m) are lines.  Particles of the group ``first_whole`` and later are of rigid
    bodies; None: there are none.  Raises NotThere if the room does not reach there.
    """

    def __init__(
        self,
        room: Room,
        cut: Slice | None = None,
        mirrors: Sequence[tuple[int, float]] = (),
        first_whole: int | None = None,
    ):
        self.room, self.cut, self.mirrors, self.first_whole = room, cut, mirrors, first_whole
        self.variant, self.remark = "", ""
        if cut is not None:
            if not room.lower[cut.axis] <= cut.place <= room.upper[cut.axis]:
                low, high = room.lower[cut.axis], room.upper[cut.axis]
                raise NotThere(
                    f"plot --slice {AXES[cut.axis]}={cut.place:g}: there are particles from {low:.4g} to "
                    f"{high:.4g} m; give a place between these"
                )
            self.variant, self.remark = "slice", f"slice at {AXES[cut.axis]} = {cut.place:.3g} m"
        self.look(None if cut is None else cut.axis)
        self.keyed = room.dimensions > 1  # in 1D the height carries the values

    def look(self, along: int | None) -> None:
        """Lay out the page for who looks ``along`` an axis of a room in 3D."""
        room, level = self.room, tuple(axis for axis in self.room.level if axis != along)
        up = room.up if room.up != along else level[-1]
        self.up, self.across = (0, 0) if room.dimensions == 1 else (up, level[0])
        axes = [self.across, self.up]
        self.lower, self.upper = room.lower[axes], room.upper[axes]

    @property
    def aspect(self) -> float:
        """Width over height."""
        width, height = self.upper - self.lower
        return 2.0 if self.room.dimensions == 1 else width / height

    def of(self, frame: dict) -> dict:
        """The visible particles of ``frame``."""
        if self.cut is None:
            return frame
        seen = np.abs(frame["position"][:, self.cut.axis] - self.cut.place) < THICK * frame["width"]
        return {name: rows[seen] for name, rows in frame.items()}

    def draw(self, axes: Axes, frame: dict, scale: Scale, first: bool, last: bool) -> None:
        """One frame; the ``first`` panel of a row and the ``last`` of a column have labels."""
        axes.set_xlim(self.lower[0], self.upper[0])
        if self.room.dimensions == 1:
            values, fluid = frame["values"] * scale.factor, frame["kind"] != WALL
            _dots(axes, frame["position"][:, 0], values, fluid, frame["width"])
            axes.set_ylim(*_padded(scale.norm.vmin, scale.norm.vmax))
        else:
            axes.set_ylim(self.lower[1], self.upper[1])
            self.fill(axes, frame, scale)
            for axis, at in self.mirrors:
                line = axes.axvline if axis == self.across else axes.axhline
                line(at, color=style.INK, lw=0.8)
            for points, tension in frame["lines"].values() if self.cut is None else ():
                axes.plot(points[:, self.across], points[:, self.up], color=style.of_line(tension), lw=0.8)
        length = self.room.length[0]
        style.ticks(axes.xaxis, 5, length)
        style.ticks(axes.yaxis, 5, 1.0 if self.room.dimensions == 1 else length)
        axes.spines[["bottom", "left"]].set_position(("outward", 4))
        axes.tick_params(labelleft=first, labelbottom=last)
        if first:
            axes.set_ylabel(scale.label if self.room.dimensions == 1 else self.room.on_page(self.up))
        if last:
            axes.set_xlabel(self.room.on_page(self.across))

    def fill(self, axes: Axes, frame: dict, scale: Scale) -> None:
        """What fills the page of a scene in a plane: particles."""
        if scale.on_dark:
            axes.set_facecolor(matplotlib.colormaps[scale.colours](0))
        fluid, width = frame["kind"] != WALL, frame["width"]
        places = frame["position"][:, [self.across, self.up]]
        whole = np.zeros(len(fluid), bool)
        if self.first_whole is not None:
            whole = ~fluid & (frame["group"] >= self.first_whole)
            circles(axes, places[whole], width[whole], facecolors=style.WHOLE)
        still = ~fluid & ~whole
        circles(axes, places[still], width[still], facecolors=style.WALLS)
        over = np.argsort(-width[fluid], kind="stable")  # small ones lie on large ones
        places, width, values = places[fluid][over], width[fluid][over], frame["values"][fluid][over]
        drawn = circles(axes, places, width, norm=scale.norm, cmap=scale.colours)
        drawn.set_array(values * scale.factor)


def circles(axes: Axes, places: np.ndarray, wide: np.ndarray | float, **colours) -> EllipseCollection:
    """Particles ``wide`` m as circles that touch, or that leave no gap where they are too small to tell."""
    lower, upper = axes.get_xlim()
    wide = np.broadcast_to(wide, len(places))
    points = 72 * style.width(axes) / (upper - lower) * wide
    size = wide * np.where(points > TELLING, 1.05, 1.42)
    shape = {"units": "xy", "offsets": places, "offset_transform": axes.transData, "lw": 0}
    smooth = bool(points.max(initial=0.0) > 1.0)  # circles of about a pixel would make a pattern of their own
    drawn = EllipseCollection(size, size, 0 * size, antialiaseds=smooth, **shape, **colours)
    return axes.add_collection(drawn, autolim=False)


def _dots(axes: Axes, places: np.ndarray, values: np.ndarray, fluid: np.ndarray, wide: np.ndarray) -> None:
    """Values over places in 1D, as dots half as wide as their particles, within what the eye can tell."""
    lower, upper = axes.get_xlim()
    size = np.clip(36 * style.width(axes) / (upper - lower) * wide, SMALLEST_DOT, LARGEST_DOT)
    for chosen, colour in ((~fluid, style.WALLS), (fluid, style.LINES[0])):
        axes.scatter(places[chosen], values[chosen], size[chosen] ** 2, color=colour, lw=0)


def _padded(low: float, high: float) -> tuple[float, float]:
    return low - 0.06 * (high - low), high + 0.06 * (high - low)
