"""Numbers of what a run measures over time: ``[numbers.NAME]``."""

from collections.abc import Iterator
from typing import Literal

from psph.case.findings import Finding
from psph.case.keys import Table, Text, key
from psph.theory.curves.catalogue import TAKEN

PARAMETERS = {name for one in TAKEN.values() for name in one.reads}
"""Keys that some numbers take, and others do not."""


class NumberOf(Table):
    """A number of a column of probes.csv or of a gauge."""

    of: Text = key("the column, such as wave.level")
    take: Literal[tuple(TAKEN)] = key("; ".join(f"{name}: {one.says}" for name, one in TAKEN.items()))
    after: float = key("rows count from this time on", 0.0, unit="s", ge=0)
    until: float | None = key("rows count up to this time", None, unit="s", otherwise="the end", gt=0)
    level: float | None = key(
        "of arrival, crossings and crests the level, in the unit of the column",
        None,
        otherwise="half of the way of an arrival, else the mean",
    )
    wave: Text | None = key("of response the column with the level of the wave", None)
    period: float | None = key(
        "of response the period of the wave", None, unit="s", otherwise="that of its column", gt=0
    )
    rest: float | None = key(
        "of largest_wave and waves the time without overtopping that tells two waves apart; of crests the "
        "least from one wave to the next",
        None,
        unit="s",
        gt=0,
    )
    theory: float | None = key("what it should be, in its unit, for a study", None)

    @property
    def columns(self) -> tuple[str, ...]:
        """All columns that it is taken of."""
        return (self.of,) if self.wave is None else (self.of, self.wave)


def numbered(case) -> Iterator[Finding]:
    """Keys that a number does not read, or lacks, and times between which nothing is."""
    for name, asked in case.numbers.items():
        taking = TAKEN[asked.take]
        for one in sorted(PARAMETERS):
            given = getattr(asked, one) is not None
            if given and one not in taking.reads:
                yield ("numbers", name, one), getattr(asked, one), f"take = {asked.take} has no use for it"
            if not given and one in taking.needs:
                yield ("numbers", name), ..., f"take = {asked.take} needs {one}; add it"
        if asked.after >= (case.time.end if asked.until is None else asked.until):
            yield (
                ("numbers", name, "after"),
                asked.after,
                "no time is left until the end; give an earlier one",
            )
