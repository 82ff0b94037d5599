"""``report.html``: what was simulated and why, what came out, how far to trust it, what it cost."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from psph.case import CaseError
from psph.case.loader import load_to_read
from psph.errors import Refused
from psph.lab.report.results import report_of_results
from psph.lab.report.sheet import embedded, interactive, refuse_without_packages, written
from psph.lab.report.turning import turning
from psph.lab.study.beside import Beside, beside
from psph.output.checkpoint import COPY
from psph.output.pictures import names
from psph.output.pictures.names import REPORT
from psph.output.pictures.plot import plot
from psph.output.reader import Run
from psph.runs.explain import explain
from psph.runs.stability_forecast import stability_forecast
from psph.runs.summary import NO_SUMMARY, measured_lines, read_summary
from psph.scene import Scene, check
from psph.simulation.plan import make_plan
from psph.version import __version__

TEMPLATE = "page.html"
FILMS = {".mp4": "video/mp4", ".gif": "image/gif"}
LARGEST_FILM = 12 << 20
"""Bytes of a film that a report takes in."""


def report(folder: Path, field: str = "speed") -> Path:
    """Write the report of the run in ``folder``, whose pictures show ``field``; its path.

    The folder of a study, a battery or a map has one too, and so has a file of ``bench --json``: results.py.

    Pictures are drawn as ``plot`` draws them; a film that ``plot --film`` has made there is taken in.
    Raises Refused or NotThere where there is nothing to report, or nothing to make it with.
    """
    refuse_without_packages()
    if path := report_of_results(folder):
        return path
    run = Run(folder)
    measured, remarks = beside(folder), []
    try:
        drawn = plot(folder, None, field, experiments=measured)
    except Refused as error:
        drawn, remarks = [], [f"no pictures: {error}"]
    return written(
        TEMPLATE,
        run.folder / REPORT,
        title=run.attributes.get("title") or run.path.stem,
        run=run,
        summary=NO_SUMMARY | read_summary(run.folder),
        pictures=[(name, embedded(path, "image/png")) for name, path in _in_order(drawn)],
        films=[(path.name, embedded(path, FILMS[path.suffix])) for path in _films(run.folder)],
        turning=interactive(turning(run), "turning"),
        key_numbers=list(_key_numbers(run)),
        accuracy=list(_accuracy(run, measured)),
        psph_version=run.attributes.get("psph_version", __version__),
        **_of_case(run, remarks),
    )


def _of_case(run: Run, remarks: list[str]) -> dict:
    """What the case says, and what ``check`` and ``explain`` say of it; of a case that this psph or this
    process cannot load, why."""
    folder = run.folder
    try:
        case, left_out = load_to_read(folder / COPY)
        scene = Scene(case)
        plan = make_plan(scene)
        expected = list(stability_forecast(scene, plan))
        ranks = read_summary(folder).get("ranks", 1)
        return {
            "plan": "\n".join(explain(scene, ranks)),
            "numbers": "\n".join(measured_lines(scene, run)),
            "expected": expected,
            "warnings": [*remarks, *left_out, *check(scene)],
        }
    except CaseError as error:
        return {"plan": "", "numbers": "", "expected": [], "warnings": [*remarks, *error.lines]}


def _in_order(drawn: list[Path]) -> Iterator[tuple[str, Path]]:
    """The overview first, then what was measured, energies and limits of the run last."""
    by_name = {path.name: path for path in drawn}
    gauges = [name for name in by_name if name.startswith("gauge-")]
    for name in (names.OVERVIEW, names.PROBES, *gauges, names.LOG):
        if name in by_name:
            yield Path(name).stem.replace("-", " "), by_name[name]


def _films(folder: Path) -> list[Path]:
    found = sorted(path for path in folder.iterdir() if path.suffix in FILMS)
    return [path for path in found if path.stat().st_size <= LARGEST_FILM]


def _key_numbers(run: Run) -> Iterator[tuple[str, str]]:
    """What one looks at first: (what, value with its unit)."""
    log, times = run.log(), run.times
    yield "frames", f"{len(times)}, to {times[-1]:.4g} s" if len(times) else "none"
    if not log or not len(log["time"]):
        return
    per = ("/m²", "/m", "")[int(run.attributes["dimensions"]) - 1]
    yield "largest speed over the run", f"{np.nanmax(log['largest_speed']):.3g} m/s"
    yield "largest deviation of the density", f"{100 * np.nanmax(log['density_error']):.3g} %"
    for name in ("kinetic", "potential"):
        energy = log[f"{name}_energy"]
        yield f"{name} energy, first and last", f"{energy[0]:.4g} and {energy[-1]:.4g} J{per}"
    steps = log["dt"][log["dt"] > 0]
    if len(steps):
        yield "time step, least and largest", f"{steps.min():.3g} and {steps.max():.3g} s"


def _accuracy(run: Run, measured: list[Beside]) -> Iterator[str]:
    """Errors that are known, against an exact solution or experiments."""
    errors = run.errors()
    for name in errors:
        if name != "time" and len(errors[name]):
            last = f"{100 * errors[name][-1]:.3g} %"
            yield f"{name.replace('_', ' ')} against the exact solution at the end: {last}"
    for one in measured:
        yield one.in_words()
