"""Pictures of a run: a field at chosen times, the probes, the log, and an overview."""

import tomllib
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import EllipseCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from psph.fields import FLUID
from psph.output import charts, pictures, style
from psph.output.errors import OutputError
from psph.output.reader import Run

LARGEST = (7.6, 5.6)
"""Width and height that all panels together may take, inches."""
GAP, HEADING = 0.3, 0.3
"""Between two panels, and above each of several for its time, inches."""
CHART = charts.HEIGHT + 0.8
"""Of a chart with its title and what stands between it and the panels, inches."""
SIGNED = 0.1
"""Share of the smaller sign above which a field is drawn with both signs."""
OUTLIER = 0.25
"""Share of the range by which outliers may extend the colours."""
VELOCITY, SPEED = "velocity", "speed"
"""The field, and what is shown of it."""
TELLING = 4.0
"""Size in points (1/72 inch) above which single particles are visible."""


def plot(folder: Path, times: Sequence[float] | None = None, field: str = "pressure") -> list[Path]:
    """Draw ``field`` at ``times`` (s; four over the run), probes, log and overview as PNG files.

    They stand in ``folder``; their paths are returned.  Raises OutputError if there is nothing
    to draw or no such field.
    """
    show = Show(Run(folder), times, field)
    made = {pictures.name_of(show.field, k): show.picture([k]) for k in show.chosen}
    if column := charts.probe_charts(show.run, show.case):
        made[pictures.PROBES] = charts.picture(column, show.title, "probes")
    if column := charts.log_charts(show.run, show.view.dimensions):
        made[pictures.LOG] = charts.picture(column, show.title, "log")
    made[pictures.OVERVIEW] = show.overview()
    return [style.save(figure, show.run.folder / name) for name, figure in made.items()]


def overview(folder: Path, times: Sequence[float] | None = None, field: str = "pressure") -> Path:
    """Draw ``overview.png``: ``field`` at ``times`` side by side, below what probes read of it."""
    show = Show(Run(folder), times, field)
    return style.save(show.overview(), show.run.folder / pictures.OVERVIEW)


class View(NamedTuple):
    """What is looked at: the box from ``lower`` to ``upper`` along two axes.

    In 3D it is the slice one ``spacing`` thick at ``place`` along the axis ``cut``; in 1D the
    second axis is that of the numbers.
    """

    dimensions: int
    spacing: float
    across: int
    up: int
    cut: int | None
    place: float
    lower: np.ndarray
    upper: np.ndarray

    def of(self, frame: dict) -> dict:
        """The visible particles of ``frame``."""
        if self.cut is None:
            return frame
        seen = np.abs(frame["position"][:, self.cut] - self.place) < self.spacing / 2
        return {name: rows[seen] for name, rows in frame.items()}

    @property
    def aspect(self) -> float:
        """Width over height."""
        width, height = self.upper - self.lower
        return 2.0 if self.dimensions == 1 else width / height


class Scale(NamedTuple):
    """The colour scale; numbers are multiplied by ``factor``."""

    norm: Normalize
    colours: str
    extend: str
    factor: float
    unit: str


class Show:
    """A field of a run in some of its frames, with one scale and one view."""

    def __init__(self, run: Run, times: Sequence[float] | None, field: str):
        self.run, self.times = run, run.times
        self.field = VELOCITY if field == SPEED else field
        if not len(self.times):
            raise OutputError(f"{run.path}: no frame yet; wait for the first one")
        if times is None:
            times = np.linspace(self.times[0], self.times[-1], 4)
        self._refuse_unreached(times)
        self.chosen = sorted({int(np.abs(self.times - time).argmin()) for time in times})
        self.case = tomllib.loads(run.case_text)
        self.title = self.case.get("title") or run.path.stem
        frames = {k: run.frame(k, "position", "kind", self.field) for k in self.chosen}
        self.view = _view(self.case, run.frame(0, "position"), frames.values())
        self.frames = {k: self.view.of(frame) for k, frame in frames.items()}
        self.scale = self._scale()

    def overview(self) -> Figure:
        """All chosen frames and the chart of the probes that read the field."""
        below = charts.probe_charts(self.run, self.case)
        return self.picture(self.chosen, [chart for chart in below if chart.title == self.field])

    def picture(self, chosen: list[int], below: Sequence[charts.Chart] = ()) -> Figure:
        """The frames ``chosen`` in panels of one size, and charts over the full width below."""
        columns, width, height = _grid(len(chosen), self.view.aspect)
        heading = HEADING if len(chosen) > 1 else 0.0
        pitch = heading + height + GAP
        top = style.TOP - heading / 2
        full = columns * (width + GAP) - GAP
        bottom = top + -(-len(chosen) // columns) * pitch - GAP
        right = style.RIGHT if self.view.dimensions > 1 else 0.3
        page = style.LEFT + full + right, bottom + style.BOTTOM + len(below) * CHART
        with style.look():
            figure = style.sheet(*page, self.title, self._subtitle(chosen))
            for n, k in enumerate(chosen):
                row, column = divmod(n, columns)
                place = style.LEFT + column * (width + GAP), top + row * pitch + heading
                axes = style.panel(figure, *place, width, height)
                self._draw(axes, k, first=column == 0, last=n + columns >= len(chosen))
                if heading:
                    axes.set_title(self._moment(k), loc="left", size=9)
            if self.view.dimensions > 1:
                place = style.LEFT + full + 0.15, top + heading
                self._bar(figure, style.panel(figure, *place, 0.13, bottom - top - heading))
            for n, chart in enumerate(below, 1):
                place = style.LEFT, bottom + n * CHART - charts.HEIGHT
                charts.draw(style.panel(figure, *place, full, charts.HEIGHT), chart)
        return figure

    def _moment(self, k: int) -> str:
        return style.moment(self.times[k], self.case["time"]["end"])

    def _subtitle(self, chosen: list[int]) -> str:
        parts = [self._name()]
        if self.view.cut is not None:
            parts.append(f"slice at {'xyz'[self.view.cut]} = {self.view.place:.3g} m")
        if len(chosen) == 1:
            parts.append(self._moment(chosen[0]))
        return ", ".join(parts)

    def _name(self) -> str:
        return SPEED if self.field == VELOCITY else self.field.replace("_", " ")

    def _values(self, frame: dict) -> np.ndarray:
        """The field as one number per particle; the length of a vector."""
        values = frame[self.field].astype(float)
        return np.linalg.norm(values, axis=1) if values.ndim == 2 else values

    def _refuse_unreached(self, times: Sequence[float]) -> None:
        """OutputError for a time, s, before the first frame or beyond the last."""
        first, last = float(self.times[0]), float(self.times[-1])
        half = 0.5 * (last - first) / max(len(self.times) - 1, 1)
        for time in times:
            if not first - half <= time <= last + half:
                raise OutputError(
                    f"{self.run.path}: --times {time:g}: there are frames from {first:g} to {last:g} s; "
                    "give times between these"
                )

    def _scale(self) -> Scale:
        """Colours for the fluid of all frames, from zero if that is near.

        The outermost half per cent on either side may lie beyond them.
        """
        values = [self._values(frame)[frame["kind"] == FLUID] for frame in self.frames.values()]
        values = np.concatenate(values)
        values = values[np.isfinite(values)]
        values = values if len(values) else np.zeros(1)
        low = np.percentile(values, 0.5, method="higher")
        high = np.percentile(values, 99.5, method="lower")
        stretch = OUTLIER * (high - low)
        low = max(low - stretch, values.min())
        high = min(high + stretch, values.max())
        colours, largest = "viridis", max(-low, high)
        if min(-low, high) > SIGNED * largest:
            colours, low, high = "coolwarm", -largest, largest
        elif abs(low) < SIGNED * high:
            low = 0.0
        if high - low <= 1e-9 * abs(largest):  # uniform
            low, high = low - 0.01 * abs(low) - 1e-30, high + 0.01 * abs(high) + 1e-30
        beyond = (values.min() < low, values.max() > high)
        extend = {(0, 0): "neither", (1, 0): "min", (0, 1): "max", (1, 1): "both"}[beyond]
        factor, unit = style.readable(self.run.unit(self.field), largest)
        return Scale(Normalize(low * factor, high * factor), colours, extend, factor, unit)

    def _draw(self, axes: Axes, k: int, first: bool, last: bool) -> None:
        """One frame; the ``first`` panel of a row and the ``last`` of a column have labels."""
        frame, view, scale = self.frames[k], self.view, self.scale
        values = self._values(frame) * scale.factor
        fluid = frame["kind"] == FLUID
        axes.set_xlim(view.lower[0], view.upper[0])
        if view.dimensions == 1:
            _dots(axes, frame["position"][:, 0], values, fluid)
            axes.set_ylim(*_padded(scale.norm.vmin, scale.norm.vmax))
            label = f"{self._name()} ({scale.unit})"
        else:
            places = frame["position"][:, [view.across, view.up]]
            circles(axes, places[~fluid], view.spacing, facecolors=style.WALLS)
            drawn = circles(axes, places[fluid], view.spacing, norm=scale.norm, cmap=scale.colours)
            drawn.set_array(values[fluid])
            axes.set_ylim(view.lower[1], view.upper[1])
            label = f"{'xyz'[view.up]} (m)"
        style.ticks(axes.xaxis, 5)
        style.ticks(axes.yaxis, 5)
        axes.spines[["bottom", "left"]].set_position(("outward", 4))
        axes.tick_params(labelleft=first, labelbottom=last)
        if first:
            axes.set_ylabel(label)
        if last:
            axes.set_xlabel(f"{'xyz'[view.across]} (m)")

    def _bar(self, figure: Figure, axes: Axes) -> None:
        scale = self.scale
        colours = ScalarMappable(scale.norm, scale.colours)
        bar = figure.colorbar(colours, cax=axes, extend=scale.extend, extendfrac=0.03)
        bar.outline.set_visible(False)
        style.ticks(axes.yaxis, 6)
        bar.set_label(f"{self._name()} ({scale.unit})")


def _view(case: dict, start: dict, frames: Iterable[dict]) -> View:
    """Gravity points down, but for a periodic axis; in 3D the shortest level axis is cut in the middle."""
    dimensions, spacing = case["space"]["dimensions"], case["space"]["spacing"]
    corners = np.array([_corners(frame) for frame in (start, *frames)])
    room = corners[0, 1] - corners[0, 0] + spacing
    # What a run that blows up throws far away must not make the rest small.
    lower = np.maximum(corners[:, 0].min(axis=0), corners[0, 0] - room) - spacing / 2
    upper = np.minimum(corners[:, 1].max(axis=0), corners[0, 1] + room) + spacing / 2
    if dimensions == 1:
        return View(1, spacing, 0, 0, None, 0.0, lower[[0, 0]], upper[[0, 0]])
    gravity = case.get("physics", {}).get("gravity", {}).get("acceleration", [0.0] * dimensions)
    # Along a periodic axis gravity drives a channel: there is no height.
    pull = [0.0 if "xyz"[d] in case["space"].get("periodic", ()) else abs(g) for d, g in enumerate(gravity)]
    up = int(np.argmax(pull)) if any(pull) else dimensions - 1
    level = sorted(set(range(dimensions)) - {up}, key=lambda axis: (-room[axis], axis))
    across, cut = level[0], level[1] if dimensions == 3 else None
    axes = [across, up]
    return View(dimensions, spacing, across, up, cut, _middle(start, cut), lower[axes], upper[axes])


def _corners(frame: dict) -> tuple[np.ndarray, np.ndarray]:
    """The smallest box around all particles with finite positions."""
    places = frame["position"][np.isfinite(frame["position"]).all(axis=1)]
    return places.min(axis=0, initial=np.inf), places.max(axis=0, initial=-np.inf)


def _middle(frame: dict, axis: int | None) -> float:
    """Where a particle is that is nearest to the middle: on a plane of the lattice."""
    if axis is None:
        return 0.0
    along = frame["position"][:, axis]
    return along[np.abs(along - (along.min() + along.max()) / 2).argmin()]


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


def circles(axes: Axes, places: np.ndarray, spacing: float, **colours) -> EllipseCollection:
    """Particles as circles that touch, or that leave no gap where they are too small to tell."""
    lower, upper = axes.get_xlim()
    points = 72 * style.width(axes) / (upper - lower) * spacing
    size = np.full(len(places), spacing * (1.05 if points > TELLING else 1.42))
    shape = {"units": "xy", "offsets": places, "offset_transform": axes.transData, "lw": 0}
    smooth = points > 1.0  # circles of about a pixel would make a pattern of their own
    drawn = EllipseCollection(size, size, 0 * size, antialiaseds=smooth, **shape, **colours)
    return axes.add_collection(drawn, autolim=False)


def _dots(axes: Axes, places: np.ndarray, values: np.ndarray, fluid: np.ndarray) -> None:
    for chosen, colour in ((~fluid, style.WALLS), (fluid, style.LINES[0])):
        axes.plot(places[chosen], values[chosen], ".", ms=4, mew=0, color=colour)


def _padded(low: float, high: float) -> tuple[float, float]:
    return low - 0.06 * (high - low), high + 0.06 * (high - low)
