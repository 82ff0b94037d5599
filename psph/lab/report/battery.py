"""The report of a battery, or of remedies or walls compared: a map of verdicts, with the bounds missed."""

import csv
from pathlib import Path

from psph.lab.battery.picture import COLOURS, PICTURE
from psph.lab.battery.tables import CSV, PAGE
from psph.lab.battery.verdicts import VERDICTS
from psph.lab.report.sheet import Result, first_run
from psph.output.pictures.names import REPORT

KINDS = {
    CSV: (PAGE, "Hard cases under every scheme", "what each scheme does in cases in which plain SPH fails"),
    "remedies.csv": ("remedies.md", "Each remedy alone", "what one remedy does where plain SPH fails"),
    "solids.csv": (
        "solids.md",
        "Total or updated Lagrangian",
        "what each description of elastic solids does",
    ),
    "walls.csv": ("walls.md", "Walls side by side", "what walls of each condition do in the same cases"),
}
"""Of each kind of table: its page, its title, and what it tells."""


def result_of(folder: Path) -> Result | None:
    """The verdicts in a folder; None where it holds none."""
    found = [
        table
        for table, (page, *_) in KINDS.items()
        if (folder / table).is_file() and (folder / page).is_file()
    ]
    if not found:
        return None
    page, title, tells = KINDS[found[0]]
    with open(folder / found[0], encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return Result(
        title=title,
        kind=f"A battery: {tells}. Each run has bounds that it must keep, and a verdict.",
        text=(folder / page).read_text(encoding="utf-8"),
        figure=_figure(rows),
        caption="The verdict of every run; the mouse shows which bounds it missed.",
        pictures=[folder / PICTURE],
        run=first_run(folder),
        out=folder / REPORT,
    )


def _figure(rows: list[dict]):
    import plotly.graph_objects as go

    trials = list(dict.fromkeys(row["trial"] for row in rows))
    columns = list(dict.fromkeys(row["scheme"] for row in rows))
    of = {(row["trial"], row["scheme"]): row for row in rows}
    grid = [[of.get((trial, column)) for column in columns] for trial in trials]
    step = 1.0 / len(VERDICTS)
    figure = go.Figure(
        go.Heatmap(
            x=columns,
            y=trials,
            z=[[row and VERDICTS.index(row["verdict"]) for row in line] for line in grid],
            text=[[_words(row) for row in line] for line in grid],
            hovertemplate="%{y}, %{x}: %{text}<extra></extra>",
            colorscale=[
                [at, COLOURS[verdict]]
                for k, verdict in enumerate(VERDICTS)
                for at in (k * step, (k + 1) * step)
            ],
            zmin=-0.5,
            zmax=len(VERDICTS) - 0.5,
            xgap=2,
            ygap=2,
            colorbar={"tickvals": list(range(len(VERDICTS))), "ticktext": list(VERDICTS)},
        )
    )
    figure.update_yaxes(autorange="reversed", automargin=True)
    figure.update_xaxes(side="top", automargin=True)
    figure.update_layout(template="plotly_white", height=120 + 26 * len(trials))
    return figure


def _words(row: dict | None) -> str:
    if row is None:
        return ""
    return f"{row['verdict']} at t = {float(row['reached']):.3g} s; {row['broken'] or row['status']}"
