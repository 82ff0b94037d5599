"""The look of all pictures: fonts, colours, margins in inches, and how numbers get their units."""

import math
from pathlib import Path

import matplotlib
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from psph.output.errors import OutputError, cause

INK, PALE, WALLS, WHOLE = "#22262b", "#6b7280", "#c3c8cf", "#a0623d"
LINES = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")
"""Okabe and Ito (2008): colours that colour-blind readers can distinguish."""
LEFT, RIGHT, TOP, BOTTOM = 0.8, 1.1, 0.8, 0.6
"""Margins, inches."""
DPI = 160
"""Pixels of a picture per inch."""
ACROSS, DOWN = 0.5, 0.18
"""Inches that a number of a scale needs along a level axis, and along an upright one."""
_LOOK = {
    "font.size": 9,
    "text.color": INK,
    "axes.edgecolor": PALE,
    "axes.labelcolor": INK,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.color": PALE,
    "ytick.color": PALE,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.major.size": 3,
    "ytick.major.size": 3,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "lines.linewidth": 1.1,
    "legend.frameon": False,
    "legend.fontsize": 9,
    "legend.handlelength": 1.6,
    "legend.borderaxespad": 0,
}


def look():
    """The context in which everything is drawn."""
    return matplotlib.rc_context(_LOOK)


def of_line(tension: float) -> str:
    """The colour of a line of bodies; pale where it is slack."""
    return INK if tension else PALE


def sheet(width: float, height: float, title: str, subtitle: str, dpi: int = DPI) -> Figure:
    """An empty page, inches, with its title at the top left; wide enough for that."""
    width = max(width, LEFT + 0.105 * len(title) + 0.3)
    figure = Figure(figsize=(width, height), facecolor="white", dpi=dpi)
    FigureCanvasAgg(figure)
    place = {"x": LEFT / width, "ha": "left", "va": "baseline"}
    figure.text(y=1 - 0.36 / height, s=title, fontsize=12, fontweight="bold", **place)
    figure.text(y=1 - 0.57 / height, s=subtitle, color=PALE, **place)
    return figure


def panel(figure: Figure, left: float, top: float, width: float, height: float) -> Axes:
    """Axes whose upper left corner lies ``left`` and ``top`` inches from that of the page."""
    across, down = figure.get_size_inches()
    return figure.add_axes((left / across, 1 - (top + height) / down, width / across, height / down))


def width(axes: Axes) -> float:
    """Width of the axes on the page, inches."""
    return axes.get_position().width * axes.figure.get_figwidth()


def height(axes: Axes) -> float:
    """Height of the axes on the page, inches."""
    return axes.get_position().height * axes.figure.get_figheight()


def ticks(axis, count: int, factor: float = 1.0) -> None:
    """At most ``count`` steps between round numbers, as many as fit, written short and times ``factor``."""
    fit = width(axis.axes) / ACROSS if axis.axis_name == "x" else height(axis.axes) / DOWN
    count = max(1, min(count, int(fit)))
    axis.set_major_locator(MaxNLocator(count, steps=[1, 2, 2.5, 5, 10], min_n_ticks=1))
    axis.set_major_formatter(lambda value, _: number(factor * value))


def number(value: float) -> str:
    """A number of a scale, written short."""
    return f"{value:.6g}".replace("-", "−")


def save(figure: Figure, path: Path) -> Path:
    """Write the PNG file and return its path.  OutputError where that fails."""
    try:
        figure.savefig(path)
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {cause(error)}; check the folder") from None
    return path


_PREFIXES = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}


def readable(unit: str, largest: float) -> tuple[float, str]:
    """Factor and unit that give numbers up to ``largest`` few digits: 25000 Pa -> 0.001, 'kPa'; '1' -> ''."""
    text = "" if unit == "1" else unit.replace("m3", "m³").replace("m2", "m²").replace("/(m³ s)", "/(m³ s)")
    if not math.isfinite(largest) or largest == 0 or 0.01 <= largest < 20_000:
        return 1.0, text
    power = 3 * math.floor(math.log10(largest) / 3 + 1e-9)
    if unit[0] in "PJ" and power in _PREFIXES:
        return 10.0**-power, _PREFIXES[power] + text
    power = math.floor(math.log10(largest) + 1e-9)
    return 10.0**-power, f"$10^{{{power}}}$ {text}".strip()


def length(largest: float) -> tuple[float, str]:
    """Factor and unit for places up to ``largest`` m from the origin."""
    for size, factor, unit in ((0.1, 1.0, "m"), (1e-4, 1e3, "mm"), (0.0, 1e6, "µm")):
        if largest >= size:
            return factor, unit
    return 1.0, "m"


def clock(end: float) -> tuple[float, str]:
    """Factor and unit for times up to ``end`` seconds."""
    for size, factor, unit in ((0.1, 1.0, "s"), (2e-4, 1e3, "ms"), (0.0, 1e6, "µs")):
        if end >= size:
            return factor, unit
    return 1.0, "s"


def moment(time: float, end: float) -> str:
    """A time of a run that lasts to ``end``: 't = 0.50 s'."""
    factor, unit = clock(end)
    digits = max(0, 2 - math.floor(math.log10(max(end * factor, 1e-9))))
    return f"t = {time * factor:.{digits}f} {unit}"
