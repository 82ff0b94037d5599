"""Curves over time: probes and log."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from psph.output.gauges.units import quantity_of, unit_of
from psph.output.pictures import style
from psph.output.probes import FRONT, MEASURED
from psph.output.reader import Run

WIDTH, HEIGHT, GAP = 7.0, 1.6, 0.5
"""Of a chart, and between two of them, inches."""
NARROWEST = 1e-3
"""Height of a chart over its largest value, at least: the numbers beside it have six digits."""

STEEP = 1e3
"""Ratio of the largest to the smallest number from which on the axis is logarithmic."""

HEAT, DEVIATION = "thermal_energy", "largest deviation of the density"
"""The column of log.csv that runs of gases have, J, and a chart that says nothing of them."""

PLACES = ("centre",)
"""Quantities whose values along different axes have nothing in common but their unit."""
SEEN = 0.2
"""Part of a chart's height that a curve of a place must fill."""

_THEORY = {"color": style.INK, "lw": 0.9, "ls": (0, (5, 3))}


class Chart(NamedTuple):
    """Curves that share an axis; ``theory`` holds a constant for some of them, ``measured`` times and values
    of experiments by their names."""

    title: str
    unit: str
    time: np.ndarray
    curves: dict[str, np.ndarray]
    theory: dict[str, float] = {}
    measured: dict[str, tuple[np.ndarray, np.ndarray]] = {}
    grows: bool = False
    """Whether its growth is of interest: then a steep curve alone gets a logarithmic axis."""


def probe_charts(run: Run, case: dict) -> list[Chart]:
    """One chart for each field that any probe reads."""
    table = run.probes()
    charts: dict[str, Chart] = {}
    for column, values in table.items():
        probe, _, quantity = column.rpartition(".")
        if not probe:  # the time
            continue
        field, _, axis = quantity.partition("_")
        unit = "m" if field == FRONT else MEASURED[field].unit
        chart = charts.setdefault(field, Chart(field, unit, table["time"], {}, {}))
        name = f"{probe} {axis}".strip()
        chart.curves[name] = values
        theory = case.get("probes", {}).get(probe, {}).get("theory", {}).get(field)
        if isinstance(theory, list):
            theory = theory["xyz".index(axis)]
        if theory is not None:
            chart.theory[name] = theory
    return [chart for chart in charts.values() if len(chart.time)]


def gauge_charts(run: Run, dimensions: int) -> dict[str, list[Chart]]:
    """For each gauge one chart for each quantity that it measures."""
    charts_of = {}
    for gauge, table in run.gauges().items():
        charts: dict[str, Chart] = {}
        for column, values in table.items():
            if column == "time" or not len(values):
                continue
            field, part = quantity_of(column)
            unit = unit_of(field, dimensions)
            charts.setdefault(field, Chart(field, unit, table["time"], {}, {})).curves[part or field] = values
        charts_of[gauge] = [one for chart in charts.values() for one in apart(chart)]
    return {gauge: charts for gauge, charts in charts_of.items() if charts}


def apart(chart: Chart) -> Iterator[Chart]:
    """A chart of places, or one for each axis where along one of them hardly anything would be seen."""
    ranges = [np.ptp(curve) for curve in chart.curves.values()]
    together = np.ptp(np.concatenate(list(chart.curves.values())))
    if chart.title not in PLACES or min(ranges) >= SEEN * together:
        yield chart
        return
    for axis, curve in chart.curves.items():
        yield chart._replace(title=f"{chart.title} {axis}", curves={axis: curve})


def with_measured(charts: list[Chart], of: str, experiments: Iterable) -> list[Chart]:
    """The charts of what is named ``of``, with the experiments (name, column, time, value) of its columns."""
    return [
        chart._replace(
            measured={
                f"{one.name}, measured": (one.time, one.value)
                for one in experiments
                if len(one.time)
                and one.column.startswith(f"{of}.")
                and chart.title in (quantity_of(one.column)[0], " ".join(quantity_of(one.column)))
            }
        )
        for chart in charts
    ]


def log_charts(run: Run, dimensions: int) -> list[Chart]:
    """Energies, largest speed, deviation of the density where there is one, time step."""
    log = run.log()
    if not log or not len(log["time"]):
        return []
    time, kinetic = log["time"], log["kinetic_energy"]
    potential = log["potential_energy"] - log["potential_energy"][0]
    energies = {"kinetic": kinetic}
    if potential.any():
        energies["potential, change"] = potential
    if HEAT in log:
        energies["heat, change"] = log[HEAT] - log[HEAT][0]
    charts = [
        Chart("energy", ("J/m²", "J/m", "J")[dimensions - 1], time, energies, grows=True),
        Chart("largest speed", "m/s", time, {"": log["largest_speed"]}, grows=True),
        Chart(DEVIATION, "%", time, {"": 100 * log["density_error"]}, grows=True),
        Chart("time step", "s", time, {"": np.where(log["dt"] > 0, log["dt"], np.nan)}, grows=True),
    ]
    return [chart for chart in charts if chart.title != DEVIATION or log["density_error"].any()]


def picture(charts: list[Chart], title: str, subtitle: str) -> Figure:
    """The charts one below the other."""
    above = style.TOP + 0.2
    height = above + len(charts) * (HEIGHT + GAP) - GAP + style.BOTTOM
    with style.look():
        figure = style.sheet(style.LEFT + WIDTH + 0.3, height, title, subtitle)
        for k, chart in enumerate(charts):
            top = above + k * (HEIGHT + GAP)
            axes = style.panel(figure, style.LEFT, top, WIDTH, HEIGHT)
            draw(axes, chart, last=k == len(charts) - 1)
    return figure


def draw(axes: Axes, chart: Chart, last: bool = True) -> None:
    """Draw ``chart``; the ``last`` one of a column has the time axis."""
    measured = [value for _, value in chart.measured.values()]
    values = np.abs([*chart.theory.values(), *np.concatenate([*chart.curves.values(), *measured])])
    values = values[np.isfinite(values)]
    largest = values.max(initial=0.0)
    steep = chart.grows and len(chart.curves) == 1 and 0 < values.min(initial=np.inf) * STEEP < largest
    factor, unit = style.readable(chart.unit, 1.0 if steep else largest)
    seconds, second = style.clock(chart.time[-1])
    for k, (name, curve) in enumerate(chart.curves.items()):
        colour = style.LINES[k % len(style.LINES)]
        axes.plot(chart.time * seconds, curve * factor, color=colour, label=name)
        if name in chart.theory:
            axes.axhline(chart.theory[name] * factor, **_THEORY)
    for name, (time, value) in chart.measured.items():
        axes.plot(time * seconds, value * factor, ".", ms=3, color=style.INK, label=name)
    if steep:
        axes.set_yscale("log")
    else:
        style.ticks(axes.yaxis, 4)
        axes.margins(y=0.12)
        _widen(axes)
    axes.grid(axis="y", color=style.WALLS, lw=0.4)
    axes.set_title(f"{chart.title} ({unit})" if unit else chart.title, loc="left", size=9, weight="bold")
    _legend(axes, chart)
    axes.set_xlim(chart.time[0] * seconds, chart.time[-1] * seconds)
    style.ticks(axes.xaxis, 6)
    axes.tick_params(labelbottom=last)
    if last:
        axes.set_xlabel(f"time ({second})")


def _widen(axes: Axes) -> None:
    """Let a curve that hardly changes lie level, rather than show its rounding between equal numbers."""
    low, high = axes.get_ylim()
    least = NARROWEST * max(abs(low), abs(high))
    if high - low < least:
        middle = (low + high) / 2
        axes.set_ylim(middle - least / 2, middle + least / 2)


def _legend(axes: Axes, chart: Chart) -> None:
    handles, names = axes.get_legend_handles_labels()
    if chart.theory:
        handles.append(Line2D([], [], **_THEORY))
        names.append("theory")
    if names:
        place = {"loc": "lower right", "bbox_to_anchor": (1, 1.05), "borderpad": 0}
        axes.legend(handles, names, ncols=len(names), columnspacing=1.4, **place)
