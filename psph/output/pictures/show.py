"""A quantity of a run on pages: one scale and one view for all of its frames."""

import tomllib
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from psph.fields import FLUID, WALL
from psph.output.errors import NotThere
from psph.output.pictures import charts, style
from psph.output.pictures.flat import Flat, Slice
from psph.output.pictures.groups import first_whole, wholes_of
from psph.output.pictures.mirrors import mirrors_of, with_mirrors
from psph.output.pictures.once import once, reads_of
from psph.output.pictures.quantities import FEW_SAMPLES, quantity, usual
from psph.output.pictures.raster import DENSITY, column_density, filled
from psph.output.pictures.scale import Scale, scale_of
from psph.output.pictures.sight import Sight
from psph.output.pictures.view import Panel, around_most, box_around, room_of, spread
from psph.output.progress import with_progress
from psph.output.reader import Run
from psph.output.sizes import LENGTH

LARGEST = (7.6, 5.6)
"""Width and height that all panels together may take, inches."""
GAP, HEADING = 0.3, 0.3
"""Between two panels, and above each of several for its time, inches."""
EDGE = 0.3
"""To the right of panels without a key, inches."""
CHART = charts.HEIGHT + 0.8
"""Of a chart with its title and what stands between it and the panels, inches."""
VALUES = 100_000
"""Of a frame, at most, that the limits of the colours are taken from."""


class Glance(NamedTuple):
    """What a sample of a run's frames says: the ``box`` (2, dim) around its particles, m, that around
    ``most`` of them, those around each group in 3D, and ``values`` of the fluid."""

    box: np.ndarray
    most: np.ndarray
    groups: dict[int, np.ndarray]
    values: np.ndarray


class Show:
    """A field of a run, in the frames nearest to ``times`` in s, or in four over the run.

    ``cut``: in 3D, a slice; ``along`` an axis: what lines of sight meet; else the whole scene, ``smooth``
    with the surface of its fluid.  Raises NotThere where a frame, the field or the place is not there.
    """

    def __init__(
        self,
        run: Run,
        times: Sequence[float] | None,
        field: str | None,
        cut: Slice | None = None,
        smooth: bool = False,
        along: str | None = None,
    ):
        self.run, self.times = run, run.times
        if not len(self.times):
            raise NotThere(f"{run.path}: no frame yet; wait for the first one")
        self.case = tomllib.loads(run.case_text)
        self.title = self.case.get("title") or run.path.stem
        asked, dimensions = Sight(cut, smooth, along), self.case["space"]["dimensions"]
        sized = LENGTH in run.fields
        self._spatial = asked.in_space(dimensions, sized)
        self._filled = along is not None or cut is not None and sized
        if along is not None and field in (None, DENSITY):
            self.quantity = column_density(dimensions)
        else:
            self.quantity = quantity(run, self.case, field or usual(run, self.case))
        self.chosen = self._chosen(times)
        self.frame = lru_cache(maxsize=1)(self._frame)
        self.panel, self.scale = self._panel_and_scale(asked)

    def _frame(self, k: int) -> dict:
        """The visible particles of a frame, with their ``values``, and its ``lines``."""
        return self.panel.of(self._whole(k)) | {"lines": self.run.lines(k)}

    def _whole(self, k: int) -> dict:
        reads = {"position", *self.quantity.reads, *self._told_apart, *reads_of(self.case, self.run.fields)}
        frame = once(self.run.frame(k, *reads), self.case)
        return frame | {"values": self.quantity.values(frame)}

    @property
    def _told_apart(self) -> tuple[str, ...]:
        """Fields that tell which wall or body a particle is of, where that is drawn."""
        if self._spatial:
            return ("group", "id")
        if self._filled:
            return ("group", "density")
        return ("group",) if wholes_of(self.case) else ()

    def _panel_and_scale(self, asked: Sight) -> tuple[Panel, Scale]:
        if self._spatial:
            from psph.output.pictures import spatial

            spatial.pyvista()  # missing, it is missed before any work
        sample = spread(len(self.times), self.quantity.samples)
        glances = [self._glance(k) for k in with_progress(sample, "looking at the run", "frames")]
        mirrors = mirrors_of(self.case, self.run.folder)
        boxes = [with_mirrors(glance.box, mirrors) for glance in glances]
        room = room_of(self.case, boxes, [glance.most for glance in glances])
        if self._filled:
            panel = filled(room, asked.cut, asked.along, self.run.folder, self.quantity)
            some = with_progress(spread(len(self.times), FEW_SAMPLES), "looking at the run", "frames")
            return panel, scale_of(self.quantity, [panel.pixels(self._whole(k)).ravel() for k in some])
        scale = scale_of(self.quantity, [glance.values for glance in glances])
        if not self._spatial:
            whole = first_whole(self.case) if wholes_of(self.case) else None
            return Flat(room, asked.cut, mirrors, whole), scale
        groups = [glance.groups for glance in glances]
        return spatial.scene(self.case, self.run.folder, self._whole(0), room, groups, asked.smooth), scale

    def _glance(self, k: int) -> Glance:
        frame = self._whole(k)
        places, values = frame["position"], frame["values"][self._counts(frame["kind"])]
        groups = np.unique(frame["group"]).tolist() if self._spatial else []
        boxes = {group: box_around(places[frame["group"] == group]) for group in groups}
        return Glance(box_around(places), around_most(places), boxes, values[:: len(values) // VALUES + 1])

    def _counts(self, kind: np.ndarray) -> np.ndarray:
        """Which particles of a ``kind`` (n,) each the limits of the colours are taken from: (n,)."""
        fluid = kind == FLUID
        return fluid if self.quantity.of_flow and fluid.any() else kind != WALL

    def _chosen(self, times: Sequence[float] | None) -> list[int]:
        """The frames nearest to ``times`` s, or to four over the run."""
        if times is None:
            times = np.linspace(float(self.times[0]), float(self.times[-1]), 4).tolist()
        return self.run.nearest(times)

    def overview(self) -> Figure:
        """All chosen frames and the chart of the probes that read the field."""
        below = charts.probe_charts(self.run, self.case)
        return self.picture(self.chosen, [chart for chart in below if chart.title == self.quantity.name])

    def picture(
        self, chosen: Sequence[int], below: Sequence[charts.Chart] = (), dpi: int = style.DPI
    ) -> Figure:
        """The frames ``chosen`` in panels of one size, and charts over the full width below."""
        panel = self.panel
        columns, width, height = _grid(len(chosen), panel.aspect)
        heading = HEADING if len(chosen) > 1 else 0.0
        pitch = heading + height + GAP
        top = style.TOP - heading / 2
        full = columns * (width + GAP) - GAP
        bottom = top + -(-len(chosen) // columns) * pitch - GAP
        right = self.scale.width if panel.keyed else EDGE
        page = style.LEFT + full + right, bottom + style.BOTTOM + len(below) * CHART
        with style.look():
            figure = style.sheet(*page, self.title, self._subtitle(chosen), dpi)
            for n, k in enumerate(chosen):
                row, column = divmod(n, columns)
                place = style.LEFT + column * (width + GAP), top + row * pitch + heading
                axes = style.panel(figure, *place, width, height)
                last = n + columns >= len(chosen)
                panel.draw(axes, self.frame(k), self.scale, column == 0, last)
                if heading:
                    axes.set_title(self._moment(k), loc="left", size=9)
            if panel.keyed:
                place = style.LEFT + full + 0.15, top + heading
                self.scale.draw_key(figure, style.panel(figure, *place, 0.13, bottom - top - heading))
            for n, chart in enumerate(below, 1):
                place = style.LEFT, bottom + n * CHART - charts.HEIGHT
                charts.draw(style.panel(figure, *place, full, charts.HEIGHT), chart)
        return figure

    def _moment(self, k: int) -> str:
        return style.moment(self.times[k], self.case["time"]["end"])

    def _subtitle(self, chosen: Sequence[int]) -> str:
        parts = [self.quantity.title]
        if self.panel.remark:
            parts.append(self.panel.remark)
        if len(chosen) == 1:
            parts.append(self._moment(chosen[0]))
        return ", ".join(parts)


def _grid(count: int, aspect: float) -> tuple[int, float, float]:
    """Columns, and width and height of a panel, so that ``count`` panels are as large as can be."""
    best = (0, 0.0, 0.0)
    for columns in range(1, count + 1):
        rows = -(-count // columns)
        width = (LARGEST[0] - (columns - 1) * GAP) / columns
        height = (LARGEST[1] - (rows - 1) * (GAP + HEADING)) / rows
        width = min(width, height * aspect)
        if width > best[1] * 1.02:
            best = (columns, width, width / aspect)
    return best
