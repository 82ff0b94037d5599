"""The battery as text: for the terminal, as Markdown, as CSV."""

import csv
import io
from collections.abc import Iterable, Iterator, Sequence

from psph.case.schemes import OF_FLUIDS
from psph.lab.battery.measures import MEASURES
from psph.lab.battery.trials import CONTROLS, OURS, Trial
from psph.lab.battery.verdicts import BLEW_UP, FAILS, GOOD, HELD, HOLDS, REFUSED, Row, without_effect

CSV, PAGE = "battery.csv", "battery.md"

DETAILS = f"All that was measured of `{OURS}`:"
"""Where the part of a page ends."""

SECONDS = "seconds"
"""What a run took, shown like a measure of it."""

MEANINGS = MEASURES | {SECONDS: "what the run took, s"}

MARKS = {GOOD: "+", HOLDS: "~", FAILS: "−", BLEW_UP: "×", REFUSED: "?"}
"""A verdict in one character."""


def line(row: Row) -> str:
    """A line for a finished run."""
    remark = "" if not row.broken else "; " + ", ".join(map(str, row.broken))
    if row.verdict == REFUSED:
        remark = f"; {row.status}"
    seconds = "" if row.seconds is None else f" in {row.seconds:.1f} s"
    return f"{row.trial}, {row.column}: {row.verdict} at t = {row.reached:g} s{seconds}{remark}"


def columns_of(trials: Sequence[Trial]) -> list[str]:
    """Schemes, then the controls that occur, in the order of the table."""
    used = {column for trial in trials for column in trial.columns}
    return [column for column in (*OF_FLUIDS, *CONTROLS) if column in used]


def cell(row: Row | None) -> str:
    """The value of a trial's measure with the mark of the verdict."""
    if row is None:
        return ""
    if row.verdict == REFUSED:
        return MARKS[REFUSED]
    if row.verdict == BLEW_UP:
        return f"{MARKS[BLEW_UP]} {row.reached:.2g} s"
    if not row.complete:
        return f"{MARKS[FAILS]} lost at {row.reached:.2g} s"
    return f"{MARKS[row.verdict]} {number(row.found.get(row.shown))}"


def number(value: float | None) -> str:
    """Three digits, or as many as it has before the point, or a dash."""
    if value is None or value != value:
        return "–"
    return f"{value:.0f}" if 1e3 <= abs(value) < 1e6 else f"{value:.3g}"


def _body(trials: Sequence[Trial], rows: Sequence[Row]) -> Iterator[list[str]]:
    columns, found = columns_of(trials), {(row.trial, row.column): row for row in rows}
    yield ["", "what", *columns]
    for trial in trials:
        yield [trial.name, trial.shown, *(cell(found.get((trial.name, c))) for c in columns)]


def matrix(trials: Sequence[Trial], rows: Sequence[Row]) -> Iterator[str]:
    """Trials × schemes for a terminal."""
    yield from columned(list(_body(trials, rows)))


def columned(body: Sequence[Sequence[str]]) -> Iterator[str]:
    """Rows of cells for a terminal, and the meaning of the marks."""
    widths = [max(map(len, column)) for column in zip(*body)]
    for cells in body:
        yield "  ".join(text.ljust(w) for text, w in zip(cells, widths)).rstrip()
    yield "  ".join(f"{mark} {verdict}" for verdict, mark in MARKS.items())


def markdown(trials: Sequence[Trial], rows: Sequence[Row]) -> Iterator[str]:
    """The matrix, the meaning of its numbers, broken bounds, and more measures of the default scheme."""
    head, *body = _body(trials, rows)
    yield from table(["trial", *head[1:]], body)
    yield ""
    shown = list(dict.fromkeys(trial.shown for trial in trials))
    yield from legend(shown)
    yield ""
    yield from sentences(rows)
    yield ""
    names = (
        "growth",
        "speed",
        "energy",
        "momentum",
        "angular",
        "near_least",
        "near_5",
        "pieces",
        "voids",
        "noise",
        "lost",
    )
    yield DETAILS
    yield ""
    yield from table(
        ["trial", *(f"`{name}`" for name in names), "seconds"],
        [
            [row.trial, *(number(row.found.get(n)) for n in names), number(row.seconds)]
            for row in rows
            if row.column == OURS
        ],
    )
    yield ""
    yield _in_words(name for name in names if name not in shown)


def legend(shown: Iterable[str]) -> Iterator[str]:
    """The meaning of the marks of a page, and of the measures."""
    marks = "; ".join(f"{mark} {verdict}" for verdict, mark in MARKS.items())
    yield f"{marks}; after ×: the simulated time until then; lost: fluid left the walls, which ended the run."
    yield _in_words(shown)


def _in_words(measures: Iterable[str]) -> str:
    return "; ".join(f"`{name}`: {MEANINGS[name]}" for name in measures) + "."


def table(head: Sequence[str], body: Iterable[Sequence[str]]) -> Iterator[str]:
    """A table of Markdown."""
    yield f"| {' | '.join(head)} |"
    yield "|---" * len(head) + "|"
    for cells in body:
        yield f"| {' | '.join(cells)} |"


def sentences(rows: Sequence[Row]) -> Iterator[str]:
    """Trials held by each scheme, bounds missed by the default scheme, controls that did not fail."""
    for column in OF_FLUIDS:
        runs = [row for row in rows if row.column == column and row.verdict != REFUSED]
        if runs:
            held = sum(row.verdict in HELD for row in runs)
            good = sum(row.verdict == GOOD for row in runs)
            yield f"- `{column}` holds in {held} of {len(runs)} trials, {good} with all goals."
    for row in rows:
        if row.column == OURS and row.verdict != GOOD:
            missed = ", ".join(map(str, row.broken)) or row.status
            yield f"- `{OURS}` {row.verdict} in {row.trial}: {missed}."
    for row in without_effect(rows):
        yield f"- The control {row.column} misses no bound in {row.trial} that `{OURS}` keeps."


def as_csv(rows: Sequence[Row]) -> str:
    """Every run with all measures; a measure that a run lacks is empty."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(
        [
            "trial",
            "scheme",
            "control",
            "verdict",
            "status",
            "reached",
            "seconds",
            *MEASURES,
            "broken",
        ]
    )
    for row in rows:
        writer.writerow(
            [
                row.trial,
                row.column,
                row.control,
                row.verdict,
                row.status,
                row.reached,
                row.seconds,
                *(row.found.get(name) for name in MEASURES),
                "; ".join(map(str, row.broken)),
            ]
        )
    return out.getvalue()
