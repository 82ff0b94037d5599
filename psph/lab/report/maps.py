"""The report of a map of ``stability``: growth by kernel and h/dx, under compression and under tension."""

from pathlib import Path

from psph.lab.maps.tables import CSV, PAGE, PICTURE, UNIT
from psph.lab.report.growth import cells, told_of
from psph.lab.report.sheet import Result
from psph.theory.stability import STATES

TITLE = "Which lattices are stable, and how fast instabilities grow on the others"
KIND = "A map of stability: linear theory of small waves on a lattice at rest, by kernel and h/dx."


def result_of(folder: Path) -> Result | None:
    """The map in a folder; None where it holds none."""
    return told_of(folder, CSV, PAGE, UNIT, TITLE, KIND, _figure, [PICTURE])


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
        panel = cells(smoothings, kernels, grid, UNIT, (0.03, 0.1, 0.3, 1.0, 3.0), keyed=k == 1)
        figure.add_traces(panel, rows=k, cols=1)
    figure.update_yaxes(autorange="reversed", automargin=True)
    figure.update_xaxes(title="h/dx", row=len(states), col=1)
    figure.update_layout(template="plotly_white", height=140 + 26 * len(kernels) * len(states))
    return figure
