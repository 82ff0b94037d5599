"""The report of ``stability --elastic``: growth by description of an elastic lattice and by its stretch."""

from pathlib import Path

from psph.lab.maps.elastic import CSV, PAGE, UNIT
from psph.lab.report.growth import cells, told_of
from psph.lab.report.sheet import Result

TITLE = "Which descriptions of elastic solids are stable"
KIND = "Linear theory of small waves on an elastic lattice, at rest and evenly stretched."


def result_of(folder: Path) -> Result | None:
    """The table in a folder; None where it holds none."""
    return told_of(folder, CSV, PAGE, UNIT, TITLE, KIND, _figure)


def _figure(rows: list[dict[str, str]]):
    import plotly.graph_objects as go

    states = list(dict.fromkeys(row["state"] for row in rows))
    names = list(dict.fromkeys(row["description"] for row in rows))
    of = {(row["description"], row["state"]): row for row in rows}
    grid = [[of[name, state] for state in states] for name in names]
    figure = go.Figure(cells(states, names, grid, UNIT, (0.03, 0.1, 0.3, 1.0), keyed=True))
    figure.update_yaxes(autorange="reversed", automargin=True)
    figure.update_xaxes(side="top", automargin=True)
    figure.update_layout(template="plotly_white", height=140 + 30 * len(names))
    return figure
