"""Cells of a map of growth: what is stable in one colour, the rest by the logarithm of its rate."""

import math
from collections.abc import Sequence
from typing import Any

STABLE, GROWS = "#56b4e9", [[0.0, "#fff3e0"], [0.4, "#f5b041"], [0.7, "#d55e00"], [1.0, "#5b1a00"]]


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
