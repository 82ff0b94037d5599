"""Reports of growth by linear theory: what is stable in one colour, the rest by the logarithm of its rate."""

import csv
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from psph.lab.report.sheet import Result
from psph.output.pictures.names import REPORT

STABLE, GROWS = "#56b4e9", [[0.0, "#fff3e0"], [0.4, "#f5b041"], [0.7, "#d55e00"], [1.0, "#5b1a00"]]


def told_of(
    folder: Path,
    table: str,
    page: str,
    unit: str,
    title: str,
    kind: str,
    figure: Callable[[list[dict[str, str]]], Any],
    pictures: Sequence[str] = (),
) -> Result | None:
    """What a report says of the ``table`` (CSV) and the ``page`` in a folder; None without them."""
    if not ((folder / table).is_file() and (folder / page).is_file()):
        return None
    with open(folder / table, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return Result(
        title=title,
        kind=kind,
        text=(folder / page).read_text(encoding="utf-8"),
        figure=figure(rows),
        caption=f"Fastest growth in {unit}; blue is stable. The mouse shows the rate and its wave vector.",
        pictures=[folder / name for name in pictures],
        run=None,
        out=folder / REPORT,
    )


def cells(
    across: Sequence,
    down: Sequence[str],
    grid: Sequence[Sequence[dict[str, str]]],
    unit: str,
    ticks: Sequence[float],
    keyed: bool,
) -> list:
    """Two heatmaps of plotly: the stable of a ``grid`` of rows of a CSV file, and those that grow.

    ``growth_rate`` is in ``unit``, the colours reach from the first of ``ticks`` to the last; ``keyed``:
    with their key.
    """
    import plotly.graph_objects as go

    holds = [[row["stable"] == "True" for row in line] for line in grid]
    common: dict[str, Any] = {
        "x": across,
        "y": down,
        "text": [[_words(row, unit) for row in line] for line in grid],
    }
    common |= {"hovertemplate": "%{y}, %{x}: %{text}<extra></extra>", "xgap": 1, "ygap": 1}
    stable = [[1.0 if held else None for held in line] for line in holds]
    rates = [
        [None if held else math.log10(max(float(row["growth_rate"]), ticks[0])) for held, row in zip(*both)]
        for both in zip(holds, grid)
    ]
    places = [math.log10(tick) for tick in ticks]
    bar = {"title": unit, "tickvals": places, "ticktext": [f"{tick:g}" for tick in ticks]}
    colours = {"zmin": places[0], "zmax": places[-1], "colorscale": GROWS}
    return [
        go.Heatmap(z=stable, colorscale=[[0.0, STABLE], [1.0, STABLE]], showscale=False, **common),
        go.Heatmap(z=rates, **colours, showscale=keyed, colorbar=bar, **common),
    ]


def _words(row: dict[str, str], unit: str) -> str:
    if row["stable"] == "True":
        return "stable"
    wave = ", ".join(f"{float(row[name]):.3g}" for name in row if name.startswith("wave_"))
    return f"grows by {float(row['growth_rate']):.3g} {unit}, wave vector ({wave}) rad/dx"
