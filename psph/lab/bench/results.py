"""Results of ``bench --json``, read from a file."""

import json
from pathlib import Path

from psph.lab.errors import BenchError

KEYS = {
    "machine",
    "problem",
    "dimensions",
    "particles",
    "neighbours",
    "neighbours_in_bulk",
    "ranks",
    "threads",
    "precision",
    "particle_steps_per_second",
    "pairs_per_second",
    "per_core",
    "spread",
    "share",
    "roofline",
}
"""Keys that every result has."""


def read_runs(path: Path) -> list[dict]:
    """The runs in a file whose last line is what ``bench --json`` printed last.

    Raises BenchError with the file and what to do.
    """
    advice = "give a file that holds what `bench --json` printed"
    try:
        lines = path.read_text(encoding="utf-8").strip().splitlines()
    except OSError as error:
        raise BenchError(f"{path}: {error.strerror}; {advice}") from None
    except UnicodeDecodeError:
        raise BenchError(f"{path}: not a text; {advice}") from None
    try:
        found = json.loads(lines[-1]) if lines else None
    except json.JSONDecodeError:
        raise BenchError(f"{path}: its last line is not JSON; {advice}") from None
    runs = found.get("runs", [found]) if isinstance(found, dict) else None
    if not runs or not all(isinstance(run, dict) and KEYS <= run.keys() for run in runs):
        raise BenchError(f"{path}: its last line is no result of bench; {advice}")
    return runs
