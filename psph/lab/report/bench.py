"""The report of what ``bench --json`` printed: speed of each problem, and where a step's time goes."""

from pathlib import Path

from psph.lab.bench import PROBLEMS
from psph.lab.bench.report import tables
from psph.lab.bench.results import read_runs
from psph.lab.report.sheet import Result

PHASES = ("pairs", "rebuild", "halo", "limits")
"""Phases with a bar of their own; the rest goes together."""


def result_of(path: Path) -> Result | None:
    """What was measured; None where ``path`` is no file.  Raises BenchError for another file."""
    if not path.is_file():
        return None
    runs = read_runs(path)
    return Result(
        title=f"Speed of psph on {runs[0]['machine']}",
        kind="A bench: standard problems, timed on this machine, beside the rates that it can reach at all.",
        text=tables([path]),
        figure=_figure(runs),
        caption="Time of a particle-step of one core by phase of the step; shorter is faster.",
        pictures=[],
        run=None,
        out=path.with_suffix(".html"),
    )


def _figure(runs: list[dict]):
    import plotly.graph_objects as go

    named = [
        f"{k + 1}. {PROBLEMS.get(run['problem'], run['problem'])}, {run['dimensions']}D, "
        f"{run['particles']:,} particles, {run['ranks']} × {run['threads']}"
        for k, run in enumerate(runs)
    ]
    whole = [1e6 / run["per_core"]["particle_steps_per_second"] for run in runs]
    shares = {phase: [run["share"].get(phase, 0.0) for run in runs] for phase in PHASES}
    shares["the rest"] = [1.0 - sum(parts) for parts in zip(*shares.values())]
    figure = go.Figure(
        [
            go.Bar(y=named, x=[share * t for share, t in zip(part, whole)], name=phase, orientation="h")
            for phase, part in shares.items()
        ]
    )
    figure.update_yaxes(autorange="reversed", automargin=True)
    figure.update_xaxes(title="µs for a step of a particle")
    figure.update_layout(template="plotly_white", barmode="stack", height=240 + 40 * len(runs))
    return figure
