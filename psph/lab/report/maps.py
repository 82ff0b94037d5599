"""The report of a map of ``stability``: growth by kernel and h/dx, under compression and under tension."""

import csv
import math
from pathlib import Path

from psph.lab.maps.tables import CSV, PAGE, PICTURE, UNIT
from psph.lab.report.sheet import REPORT, Told
from psph.theory.stability import STATES

TITLE = "Which lattices are stable, and how fast instabilities grow on the others"
STABLE, GROWS = "#56b4e9", [[0.0, "#fff3e0"], [0.4, "#f5b041"], [0.7, "#d55e00"], [1.0, "#5b1a00"]]


def told(folder: Path) -> Told | None:
    """The map in a folder; None where it holds none."""
    if not ((folder / CSV).is_file() and (folder / PAGE).is_file()):
        return None
    with open(folder / CSV, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return Told(
        title=TITLE,
        kind="A map of stability: linear theory of small waves on a lattice at rest, by kernel and h/dx.",
        text=(folder / PAGE).read_text(encoding="utf-8"),
        figure=_figure(rows),
        caption=f"Fastest growth in {UNIT}; blue is stable. The mouse shows the rate and its wave vector.",
        pictures=[folder / PICTURE],
        run=None,
        out=folder / REPORT,
    )


def _figure(rows: list[dict[str, str]]):
    from plotly.subplots import make_subplots

    states = [state for state in STATES if any(row["state"] == state for row in rows)]
    kernels = list(dict.fromkeys(row["kernel"] for row in rows))
    smoothings = sorted({float(row["smoothing"]) for row in rows})
    titles = [f"under {state}" for state in states]
    figure = make_subplots(len(states), 1, shared_xaxes=True, vertical_spacing=0.08, subplot_titles=titles)
    for k, state in enumerate(states, 1):
        of = {(row["kernel"], float(row["smoothing"])): row for row in rows if row["state"] == state}
        grid = [[of[kernel, h] for h in smoothings] for kernel in kernels]
        figure.add_traces(_panel(kernels, smoothings, grid, first=k == 1), rows=k, cols=1)
    figure.update_yaxes(autorange="reversed", automargin=True)
    figure.update_xaxes(title="h/dx", row=len(states), col=1)
    figure.update_layout(template="plotly_white", height=140 + 26 * len(kernels) * len(states))
    return figure


def _panel(kernels: list[str], smoothings: list[float], grid: list[list[dict[str, str]]], first: bool):
    """Cells that are stable in one colour, below those that grow, coloured by the logarithm of the rate."""
    import plotly.graph_objects as go

    holds = [[row["stable"] == "True" for row in line] for line in grid]
    common = {"x": smoothings, "y": kernels, "text": [[_words(row) for row in line] for line in grid]}
    common |= {"hovertemplate": "%{y}, h/dx %{x}: %{text}<extra></extra>", "xgap": 1, "ygap": 1}
    ticks = (0.03, 0.1, 0.3, 1.0, 3.0)
    stable = [[1.0 if held else None for held in line] for line in holds]
    rates = [
        [None if held else math.log10(max(float(row["growth_rate"]), ticks[0])) for held, row in zip(*both)]
        for both in zip(holds, grid)
    ]
    bar = {
        "title": UNIT,
        "tickvals": [math.log10(tick) for tick in ticks],
        "ticktext": [f"{t:g}" for t in ticks],
    }
    return [
        go.Heatmap(z=stable, colorscale=[[0.0, STABLE], [1.0, STABLE]], showscale=False, **common),
        go.Heatmap(
            z=rates,
            zmin=math.log10(ticks[0]),
            zmax=math.log10(ticks[-1]),
            colorscale=GROWS,
            showscale=first,
            colorbar=bar,
            **common,
        ),
    ]


def _words(row: dict[str, str]) -> str:
    if row["stable"] == "True":
        return "stable"
    wave = ", ".join(f"{float(row[name]):.3g}" for name in row if name.startswith("wave_"))
    return f"grows by {float(row['growth_rate']):.3g} {UNIT}, wave vector ({wave}) rad/dx"
