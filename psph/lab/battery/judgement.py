"""The table of remedies as text: for the terminal and as Markdown."""

from collections.abc import Iterator, Sequence

from psph.lab.battery import tables
from psph.lab.battery.remedies import SHOWN
from psph.lab.battery.trials import ALWAYS, Bound, Trial
from psph.lab.battery.verdicts import BLEW_UP, REFUSED, Row

CSV, PAGE = "remedies.csv", "remedies.md"


def matrix(trials: Sequence[Trial], rows: Sequence[Row]) -> Iterator[str]:
    """Remedies × measures of each trial, for a terminal."""
    yield from tables.columned([["", *_heads(trials, "{}")], *_body(trials, rows, "{}")])


def markdown(trials: Sequence[Trial], rows: Sequence[Row]) -> Iterator[str]:
    """The same for a page, with the meaning of its numbers and the bounds."""
    yield from tables.table(["remedy", *_heads(trials, "`{}`")], _body(trials, rows, "`{}`"))
    yield ""
    bounds = [bound for trial in trials for bound in (*ALWAYS, *trial.holds, *trial.goals)]
    shown = [name for trial in trials for name in SHOWN[trial.name]]
    yield from tables.legend(dict.fromkeys((*shown, *(bound.measure for bound in bounds))))
    yield ""
    for trial in trials:
        good = f"; good: {_limits(trial.goals)}" if trial.goals else ""
        yield f"- {trial.name} holds: {_limits((*ALWAYS, *trial.holds))}{good}."


def _limits(bounds: Sequence[Bound]) -> str:
    return ", ".join(f"`{bound.measure}` {bound.limits}" for bound in bounds)


def _heads(trials: Sequence[Trial], code: str) -> Iterator[str]:
    for trial in trials:
        first, *others = map(code.format, SHOWN[trial.name])
        yield from (f"{trial.name}: {first}", *others)


def _body(trials: Sequence[Trial], rows: Sequence[Row], code: str) -> Iterator[list[str]]:
    found = {(row.trial, row.column): row for row in rows}
    for remedy in trials[0].columns:
        results = [found[trial.name, remedy] for trial in trials]
        yield [code.format(remedy), *(cell for row in results for cell in _cells(row))]


def _cells(row: Row) -> Iterator[str]:
    """The main measure with its mark, then the others; dashes for a run that ended early."""
    yield tables.cell(row)
    for name in SHOWN[row.trial][1:]:
        yield "–" if row.verdict in (BLEW_UP, REFUSED) else tables.number(row.found.get(name))
