"""From a run's measures to a verdict."""

from collections.abc import Iterator
from typing import NamedTuple

from psph.battery.trials import ALWAYS, Bound, Trial
from psph.study.runs import DONE

GOOD, HOLDS, FAILS, BLEW_UP, REFUSED = "good", "holds", "fails", "blew up", "refused"
VERDICTS = (GOOD, HOLDS, FAILS, BLEW_UP, REFUSED)
"""From all goals met, by all bounds met, to none looked at."""

HELD = (GOOD, HOLDS)


class Row(NamedTuple):
    """A run of the battery: what was asked, how it ended, what was measured, what it broke."""

    trial: str
    column: str
    control: bool
    verdict: str
    shown: str
    status: str
    found: dict[str, float]
    broken: tuple[str, ...]
    reached: float
    """Simulated time in s."""
    seconds: float | None

    @property
    def as_meant(self) -> bool:
        """Whether a control fails; true of all that is no control."""
        return not self.control or self.verdict not in HELD


def judged(
    trial: Trial, column: str, result: dict, found: dict[str, float], reached: float
) -> Row:
    """The row of a run that ended as ``result`` says."""
    def row(verdict: str, broken: tuple[str, ...] = ()) -> Row:
        return Row(
            trial.name, column, column in trial.fails, verdict, trial.shown, result["status"],
            found, broken, reached, result.get("seconds"),
        )

    if result["status"].startswith(REFUSED):
        return row(REFUSED)
    if result["status"] != DONE:
        return row(BLEW_UP, tuple(_broken(trial.holds, found)))
    fatal = tuple(_broken((*ALWAYS, *trial.holds), found))
    missed = tuple(_broken(trial.goals, found))
    return row(FAILS if fatal else HOLDS if missed else GOOD, fatal + missed)


def _broken(bounds: tuple[Bound, ...], found: dict[str, float]) -> Iterator[str]:
    """Each bound that is not met, as ``kinetic 0.9 (≥ 0.93)``."""
    for bound in bounds:
        if not bound.holds(found):
            value = found.get(bound.measure)
            told = "not measured" if value is None else f"{value:.3g}"
            yield f"{bound.measure} {told} ({bound.limits})"
