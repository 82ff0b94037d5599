"""The report of a study: error against run time, with the settings of each run at the mouse."""

import json
from pathlib import Path

from psph.lab.report.sheet import Result, first_run
from psph.lab.study.conclusions import ladders_of
from psph.lab.study.ladder import name_of
from psph.lab.study.report import percent
from psph.lab.study.study import KEPT, PAGE, PICTURE, PICTURE_OF
from psph.output.pictures.names import REPORT


def result_of(folder: Path) -> Result | None:
    """What a study has found; None where the folder holds none."""
    if not (folder / KEPT).is_file() or not (folder / PAGE).is_file():
        return None
    kept = json.loads((folder / KEPT).read_text(encoding="utf-8"))
    head, _, text = (folder / PAGE).read_text(encoding="utf-8").partition("\n")
    return Result(
        title=head.removeprefix("# "),
        kind="A study: the same case with several settings; the error and the run time of each.",
        text=text,
        figure=_figure(kept),
        caption="Error against run time; the mouse shows the settings of a run. Lower left is better.",
        pictures=[folder / PICTURE, *sorted(folder.glob(PICTURE_OF.format("*")))],
        run=first_run(folder),
        out=folder / REPORT,
    )


def _figure(kept: dict):
    import plotly.graph_objects as go

    figure = go.Figure()
    for shared, rows, _ in ladders_of(kept["rows"], kept["vary"], kept["dimensions"]):
        shown = [row for row in rows if (row.get("error_l2") or 0.0) > 0.0]
        figure.add_scatter(
            x=[row["seconds"] for row in shown],
            y=[100.0 * row["error_l2"] for row in shown],
            text=[f"{_settings(row, kept['vary'])}: {percent(row['error_l2'])}" for row in shown],
            mode="lines+markers",
            name=name_of(shared) if shared else "as it is",
        )
    figure.update_xaxes(type="log", title="run time (s)")
    figure.update_yaxes(type="log", title="error (%)")
    figure.update_layout(template="plotly_white", height=480, showlegend=True)
    return figure


def _settings(row: dict, vary: list[str]) -> str:
    return name_of({key: row[key] for key in vary if key in row})
