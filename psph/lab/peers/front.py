"""The front: what error each code had for what seconds, drawn from the tables of the page."""

import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.text import Annotation
from matplotlib.ticker import LogLocator, NullFormatter
from matplotlib.transforms import Bbox

from psph.lab.peers.benchmarks import BENCHMARKS, Benchmark, numbers
from psph.lab.peers.page import Cells, part, rows_of
from psph.output.pictures import style

WIDTH, HEIGHT, GAP = 3.4, 2.9, 0.85
"""Of a panel, and between two, inches."""

ACROSS, LEGEND = 2, 1.3
"""Panels in a row, and inches for the names beside them."""

SIZE = re.compile(r", (\d+²|dx [\d.]+)$")
"""The end of a label that says how fine a run is: those that differ by it alone are joined."""


CORNERS = (
    ("left", "bottom", 4, 2),
    ("right", "top", -4, -2),
    ("left", "top", 4, -2),
    ("right", "bottom", -4, 2),
    ("center", "top", 0, -6),
    ("center", "bottom", 0, 6),
)
"""Where a label may stand beside its point: its near side, and how far away, points."""

ROOM, POINT = 2.5, 72.0
"""Half the room that a point takes, points; points of an inch."""

DECADE = 10.0
"""The largest error of a panel over the smallest, at least: near errors shall look near."""


class Dot(NamedTuple):
    """A run: CPU ``seconds``, its ``error`` in %, and how fine it is in words."""

    seconds: float
    error: float
    size: str


def curves_of(benchmark: Benchmark, rows: Mapping[str, Cells]) -> dict[str, list[Dot]]:
    """The runs of a table by what they are of, from the cheapest on; rows without an error are left out."""
    found: dict[str, list[Dot]] = {}
    for label, cells in rows.items():
        seconds = [number for cell in cells[-3:-1] for number in numbers(cell)[:1]]
        error = benchmark.error(cells)
        if seconds and error:  # a logarithm shows no 0
            size = SIZE.search(label)
            point = Dot(seconds[0], error, size[1] if size else "")
            found.setdefault(SIZE.sub("", label), []).append(point)
    return {name: sorted(points) for name, points in found.items()}


def draw(page: Path, path: Path) -> Path:
    """Write the picture of a page's tables: a panel for each flow, a colour for each code and scheme."""
    tables = {name: curves_of(of, rows_of(part(page, name))) for name, of in BENCHMARKS.items()}
    kinds = list(dict.fromkeys(kind(name)[0] for curves in tables.values() for name in curves))
    colours = dict(zip(kinds, (*style.LINES, style.INK, style.WHOLE)))
    rows = -(-len(tables) // ACROSS)
    with style.look():
        figure = style.sheet(
            style.LEFT + ACROSS * (WIDTH + GAP) + LEGEND,
            style.TOP + rows * (HEIGHT + GAP),
            "Error and seconds of psph and of other codes",
            "each point is a run, nearer to the lower left corner is better; a line joins spacings",
        )
        for k, (name, curves) in enumerate(tables.items()):
            down, across = divmod(k, ACROSS)
            left, top = style.LEFT + across * (WIDTH + GAP), style.TOP + 0.2 + down * (HEIGHT + GAP)
            _panel(style.panel(figure, left, top, WIDTH, HEIGHT), BENCHMARKS[name].axis, curves, colours)
        lines = [Line2D([], [], color=colour, marker="o", ms=4, label=one) for one, colour in colours.items()]
        figure.legend(handles=lines, loc="upper right", bbox_to_anchor=(0.99, 0.9))
    path.parent.mkdir(parents=True, exist_ok=True)
    return style.save(figure, path)


def kind(name: str) -> tuple[str, str]:
    """What shares a colour, a code and of psph a scheme, and what else is told of a run."""
    code, _, more = name.partition(", ")
    if code != "psph":
        first, _, rest = code.partition(" `")
        return first, ", ".join(word for word in (rest.strip("`"), more) if word)
    scheme, _, more = more.partition(", ")
    return (f"{code}, as set up for it", "") if scheme.startswith("`") else (f"{code}, {scheme}", more)


def _panel(axes: Axes, title: str, curves: Mapping[str, list[Dot]], colours: Mapping[str, str]) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    said: dict[Dot, str] = {}
    for name, points in curves.items():
        of, more = kind(name)
        axes.plot(*zip(*((p.seconds, p.error) for p in points)), "o-", color=colours[of], ms=4)
        said |= {point: ", ".join(word for word in (more, point.size) if word) for point in points}
    axes.margins(0.25, 0.15)
    low, high = axes.get_ylim()
    wider = max(math.sqrt(DECADE * low / high), 1.0)
    axes.set_ylim(low / wider, high * wider)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(lambda number, _: f"{number:g}")
        axis.set_minor_formatter(NullFormatter())
    axes.grid(color=style.WALLS, lw=0.4)
    axes.set_xlabel("CPU seconds of the run, one thread")
    axes.set_title(title, loc="left", size=9, weight="bold")
    _name(axes, {point: words for point, words in said.items() if words})


def _name(axes: Axes, said: Mapping[Dot, str]) -> None:
    """Write beside each point what it is, at the first corner where nothing stands yet."""
    pixels = axes.figure.dpi / POINT
    taken = [
        Bbox.from_bounds(x - ROOM * pixels, y - ROOM * pixels, 2.0 * ROOM * pixels, 2.0 * ROOM * pixels)
        for line in axes.lines
        for x, y in axes.transData.transform(line.get_xydata())
    ]
    for point, words in said.items():
        tried = [_beside(axes, point, words, corner) for corner in CORNERS]
        boxes = [text.get_window_extent() for text in tried]
        free = (k for k, box in enumerate(boxes) if not box.count_overlaps(taken))
        best = next(free, 0)
        taken.append(boxes[best])
        for text in tried[:best] + tried[best + 1 :]:
            text.remove()


def _beside(axes: Axes, point: Dot, words: str, corner: tuple[str, str, int, int]) -> Annotation:
    across, down, x, y = corner
    return axes.annotate(
        words,
        (point.seconds, point.error),
        xytext=(x, y),
        textcoords="offset points",
        ha=across,
        va=down,
        size=7,
        color=style.PALE,
    )
