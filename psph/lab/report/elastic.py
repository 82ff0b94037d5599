"""The report of ``stability --elastic``: growth by description of an elastic lattice and by its stretch."""

import csv
from pathlib import Path

from psph.lab.maps.elastic import CSV, PAGE, UNIT
from psph.lab.report.growth import cells
from psph.lab.report.sheet import REPORT, Told

TITLE = "Which descriptions of elastic solids are stable"


def told(folder: Path) -> Told | None:
    """The table in a folder; None where it holds none."""
    if not ((folder / CSV).is_file() and (folder / PAGE).is_file()):
        return None
    with open(folder / CSV, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return Told(
        title=TITLE,
        kind="Linear theory of small waves on an elastic lattice, at rest and evenly stretched.",
        text=(folder / PAGE).read_text(encoding="utf-8"),
        figure=_figure(rows),
        caption=f"Fastest growth in {UNIT}; blue is stable. The mouse shows the rate and its wave vector.",
        pictures=[],
        run=None,
        out=folder / REPORT,
    )


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
