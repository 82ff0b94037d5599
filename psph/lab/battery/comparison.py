"""Trials under one choice after another, such as each remedy alone: what is told of them."""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from psph.lab.battery import tables
from psph.lab.battery.trials import ALWAYS, Bound, Trial
from psph.lab.battery.verdicts import Row


class Comparison(NamedTuple):
    """``trials``, each under every one of several choices, which are ``kind``s.

    ``shown``: trials and the measures shown of each, the main one first.  ``name`` is that of its files.
    """

    name: str
    kind: str
    trials: tuple[Trial, ...]
    shown: Mapping[str, Sequence[str]]
    measures_down: bool = False
    """Whether each measure is a row of the table and each choice a column."""

    @property
    def csv(self) -> str:
        """The name of the table."""
        return f"{self.name}.csv"

    @property
    def page(self) -> str:
        """The name of the part of a page."""
        return f"{self.name}.md"


def judging(trial: Trial, name: str, changes: Mapping[str, tuple[str, ...]], **more) -> Trial:
    """A trial of the battery under these choices; a run continues in spite of its guards."""
    sets = (*more.pop("sets", trial.sets), "guards.on_trouble=warn")
    end = more.pop("end", trial.end)
    return trial._replace(
        name=name,
        end=end,
        other_end=end,
        schemes=tuple(changes),
        fails=(),
        sets=sets,
        changes=changes,
        **more,
    )


def matrix(of: Comparison, rows: Sequence[Row]) -> Iterator[str]:
    """Choices × measures of each trial, for a terminal."""
    yield from tables.columned(_table(of, rows, "{}"))


def markdown(of: Comparison, rows: Sequence[Row]) -> Iterator[str]:
    """The same for a page, with the meaning of its numbers and the bounds."""
    trials = of.trials
    head, *body = _table(of, rows, "`{}`")
    yield from tables.table(head, body)
    yield ""
    bounds = [bound for trial in trials for bound in (*ALWAYS, *trial.holds, *trial.goals)]
    shown = [name for trial in trials for name in of.shown[trial.name]]
    yield from tables.legend(dict.fromkeys((*shown, *(bound.measure for bound in bounds))))
    yield ""
    for trial in trials:
        good = f"; good: {_limits(trial.goals)}" if trial.goals else ""
        yield f"- {trial.name} holds: {_limits((*ALWAYS, *trial.holds))}{good}."


def _limits(bounds: Sequence[Bound]) -> str:
    return ", ".join(f"`{bound.measure}` {bound.limits}" for bound in bounds)


def _table(of: Comparison, rows: Sequence[Row], code: str) -> list[Sequence[str]]:
    table: list[Sequence[str]] = [[of.kind, *_heads(of, code)], *_body(of, rows, code)]
    return list(zip(*table)) if of.measures_down else table


def _heads(of: Comparison, code: str) -> Iterator[str]:
    for trial in of.trials:
        first, *others = map(code.format, of.shown[trial.name])
        yield from (f"{trial.name}: {first}", *others)


def _body(of: Comparison, rows: Sequence[Row], code: str) -> Iterator[list[str]]:
    found = {(row.trial, row.column): row for row in rows}
    for choice in of.trials[0].columns:
        results = [found[trial.name, choice] for trial in of.trials]
        yield [code.format(choice), *(cell for row in results for cell in _cells(of, row))]


def _cells(of: Comparison, row: Row) -> Iterator[str]:
    """The main measure with its mark, then the others; dashes for a run that ended early."""
    yield tables.cell(row)
    for name in of.shown[row.trial][1:]:
        value = row.seconds if name == tables.SECONDS else row.found.get(name)
        yield "–" if not row.complete else tables.number(value)
