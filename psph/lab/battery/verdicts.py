"""From a run's measures to a verdict."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from psph.lab.battery.trials import ALWAYS, OURS, Bound, Trial
from psph.lab.study.runs import DONE, LOST

GOOD, HOLDS, FAILS, BLEW_UP, REFUSED = "good", "holds", "fails", "blew up", "refused"
VERDICTS = (GOOD, HOLDS, FAILS, BLEW_UP, REFUSED)
"""From all goals met, over all bounds met, to not run."""

HELD = (GOOD, HOLDS)


class Broken(NamedTuple):
    """A bound that a run does not meet, and the measured value; ``None``: not measured."""

    bound: Bound
    value: float | None
    goal: bool
    """Whether it is one of the goals: then the trial is held all the same."""

    def __str__(self) -> str:
        """As ``kinetic 0.9 (≥ 0.93)``."""
        value = "not measured" if self.value is None else f"{self.value:.3g}"
        return f"{self.bound.measure} {value} ({self.bound.limits})"


class Row(NamedTuple):
    """A run of the battery: its trial, status, measures and broken bounds."""

    trial: str
    column: str
    control: bool
    verdict: str
    shown: str
    status: str
    found: dict[str, float]
    broken: tuple[Broken, ...]
    reached: float
    """Simulated time in s."""
    seconds: float | None

    @property
    def complete(self) -> bool:
        """Whether the run came to its end."""
        return self.status == DONE


def judged(trial: Trial, column: str, result: dict, found: dict[str, float], reached: float) -> Row:
    """The row of a run that ended as ``result`` says."""

    def row(verdict: str, broken: tuple[Broken, ...] = ()) -> Row:
        return Row(
            trial.name,
            column,
            column in trial.fails,
            verdict,
            trial.shown,
            result["status"],
            found,
            broken,
            reached,
            result.get("seconds"),
        )

    if result["status"].startswith(REFUSED):
        return row(REFUSED)
    if result.get(LOST):
        found[LOST] = max(found.get(LOST, 0.0), 1.0)
    elif result["status"] != DONE:
        return row(BLEW_UP, tuple(_broken(trial.holds, found)))
    fatal = tuple(_broken((*ALWAYS, *trial.holds), found))
    missed = tuple(_broken(trial.goals, found, goal=True))
    return row(FAILS if fatal else HOLDS if missed else GOOD, fatal + missed)


def _broken(bounds: tuple[Bound, ...], found: dict[str, float], goal=False) -> Iterator[Broken]:
    for bound in bounds:
        if not bound.holds(found):
            yield Broken(bound, found.get(bound.measure), goal)


def without_effect(rows: Sequence[Row]) -> Iterator[Row]:
    """Controls that reached their end and missed no bound but those that the default scheme misses too."""
    ours = {row.trial: set(_fatal(row)) for row in rows if row.column == OURS}
    for row in rows:
        if row.control and row.verdict in (GOOD, HOLDS, FAILS):
            if not set(_fatal(row)) - ours.get(row.trial, set()):
                yield row


def _fatal(row: Row) -> Iterator[Bound]:
    return (broken.bound for broken in row.broken if not broken.goal)
