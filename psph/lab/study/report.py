"""A study's files: study.csv, study.md, study.json, and the table for the terminal."""

import csv
import io
import json
import math
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from psph.lab.study.ladder import SPACING, name_of, toml
from psph.output.errors import OutputError
from psph.output.progress import duration

SHOWN = (
    ("error_l2", "error L2"),
    ("error_linf", "error L∞"),
    ("seconds", "seconds"),
    ("particle_steps", "particle-steps"),
    ("bytes", "memory"),
    ("status", "status"),
)
"""The main columns of a row, shown in tables."""

MOST_KEYS = 4
"""Keys that vary up to which each has a column; with more a run has its name."""

FINEST_SPACING = "finest_spacing"
"""Column of a row: the smallest spacing of any of its regions, m; shown where some are finer."""


def write_csv(path: Path, rows: Sequence[dict]) -> None:
    """Every row with all measured values; a column that a row lacks is empty."""
    columns = list(dict.fromkeys(name for row in rows for name in row))
    out = io.StringIO()
    writer = csv.DictWriter(out, columns, lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    write(path, out.getvalue())


def write(path: Path, text: str) -> None:
    """Write the text to the file in one step.  Raises OutputError."""
    try:
        beside = path.with_name(f"{path.name}.part")
        beside.write_text(text, encoding="utf-8")
        beside.replace(path)
    except OSError as error:
        raise OutputError(f"{path}: {error.strerror}; choose another folder with --out") from None


def write_json(path: Path, study: dict) -> None:
    """The file that ``explain --study`` reads."""
    write(path, json.dumps(study, indent=1))


def table(rows: Sequence[dict], keys: Sequence[str]) -> tuple[list[str], list[list[str]]]:
    """Head and body in words: the keys that vary, or the name of a run, then the main columns."""
    finer = any(FINEST_SPACING in row and row[FINEST_SPACING] < row[SPACING] for row in rows)
    shown = (*(((FINEST_SPACING, "finest (m)"),) if finer else ()), *SHOWN)
    given = [{key: row[key] for key in keys if key in row} for row in rows]
    if many := len(keys) > MOST_KEYS:
        own = [[name_of(settings, keys)] for settings in given]
    else:
        own = [[toml(settings[key]) if key in settings else "" for key in keys] for settings in given]
    head = [*(["run"] if many else keys), *(title for _, title in shown)]
    return head, [
        [*cells, *(_cell(name, row.get(name), row) for name, _ in shown)] for cells, row in zip(own, rows)
    ]


def markdown(rows: Sequence[dict], keys: Sequence[str]) -> Iterator[str]:
    """The table as Markdown."""
    head, body = table(rows, keys)
    yield f"| {' | '.join(head)} |"
    yield "|---" * len(head) + "|"
    for cells in body:
        yield f"| {' | '.join(cells)} |"


def plain(rows: Sequence[dict], keys: Sequence[str]) -> Iterator[str]:
    """The table for a terminal."""
    head, body = table(rows, keys)
    widths = [max(map(len, column)) for column in zip(head, *body)]
    for cells in (head, *body):
        yield "  ".join(cell.rjust(w) for cell, w in zip(cells[:-1], widths)) + f"  {cells[-1]}"


def _cell(name: str, value, row: dict) -> str:
    if value is None or isinstance(value, float) and math.isnan(value):
        return "–"
    if name.startswith("error"):
        return percent(value)
    if name == "seconds":
        spread = row.get("seconds_spread")
        return f"{value:.3g}" + (f" ± {50 * spread:.0f} %" if spread else "")
    if name in ("particle_steps", FINEST_SPACING):
        return f"{value:.3g}"
    if name == "bytes":
        return f"{value / 2**20:.3g} MiB"
    return "; ".join(str(value).splitlines())


def percent(value: float) -> str:
    """0.0123 → 1.23 %."""
    return f"{100 * value:.3g} %"


def seconds(value: float) -> str:
    """42.3 → 42 s; longer ones in minutes and hours."""
    return f"{value:.2g} s" if value < 60 else duration(value)


def joined(parts: Iterable[str]) -> str:
    """One, two and three."""
    *some, last = parts
    return f"{', '.join(some)} and {last}" if some else last
