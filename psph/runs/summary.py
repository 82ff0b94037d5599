"""summary.json: what a run cost, what its guards saw and what it was made with, for the report."""

import json
import platform
from collections.abc import Iterable
from contextlib import suppress
from importlib import metadata
from pathlib import Path

from psph.engine.jit import processor
from psph.kinds import count_of
from psph.output.numbers import extents, in_lines, numbers_in_lines
from psph.output.reader import Run
from psph.runs.cost import Spent
from psph.version import __version__

SUMMARY = "summary.json"

NO_SUMMARY: dict = {"header": "", "said": [], "parts": [], "versions": {}}
"""The summary of a run that has not come to its end."""

PACKAGES = ("numpy", "numba", "mpi4py", "h5py")
"""Those that results rest on."""


def write_summary(folder: Path, scene, simulation, cost: Spent, said: Iterable[str]) -> None:
    """Leave the summary of the last part of a run in its folder; on one rank.

    ``said``: what guards and probes told at the end.  Without it a run is as good: a disk that is full now
    does not make it fail.
    """
    told = {
        "header": header(Path(scene.case.file)),
        "ranks": simulation.comm.size,
        "particles": count_of(scene),
        "steps": cost.steps,
        "seconds": cost.seconds,
        "parts": cost.parts,
        "said": list(said),
        "versions": {"psph": __version__, "Python": platform.python_version()}
        | {name: metadata.version(name) for name in PACKAGES},
        "processor": processor(),
    }
    with suppress(OSError):
        (folder / SUMMARY).write_text(json.dumps(told, indent=1), encoding="utf-8")


def measured_lines(scene, run: Run) -> list[str]:
    """What the gauges of a run have read from its start to now: mean and extremes of each, and the numbers of
    the case; on one rank."""
    case, gauges = scene.case, run.gauges()
    own = [gauges[name] for name in case.gauges if name in gauges]
    lines = [*in_lines(extents(own, scene.dimensions))]
    if case.numbers:
        lines += numbers_in_lines(case.numbers, [run.probes(), *own], scene.dimensions)
    return lines


def read_summary(folder: Path) -> dict:
    """What stands there; empty where a run has not come to its end."""
    try:
        return json.loads((folder / SUMMARY).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}


def header(path: Path) -> str:
    """The comment at the top of a case file, without its marks; empty where there is none.

    Lines ``#:schema`` are for editors, and left out.
    """
    lines: list[str] = []
    with suppress(OSError, UnicodeDecodeError):
        for line in path.read_text(encoding="utf-8").splitlines():
            if not line.startswith("#"):
                break
            if not line.startswith("#:"):
                lines.append(line.removeprefix("#").removeprefix(" "))
    return "\n".join(lines)
