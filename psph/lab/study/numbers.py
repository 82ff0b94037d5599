"""The numbers of a case in the runs of a study, and where they go at zero spacing."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from psph.lab.study import fit, words
from psph.lab.study.ladder import SPACING
from psph.output.numbers import Columns, taken, unit_taken
from psph.output.reader import Run
from psph.theory.curves.number import CurveNumber, NoNumber

NUMBER, REACH = "number ", "reach "
"""Columns of a row: a number of the case, and half of its interval."""


class NumberLadder(NamedTuple):
    """A number ``name``, what it is ``of``, over spacings, m, the coarsest first, with its ``values``,
    ``reaches``, its ``unit``, the ``theory`` of it if any, and the ``limit`` at zero spacing; None: there is
    no answer, and ``why``."""

    name: str
    of: str
    unit: str
    spacings: tuple[float, ...]
    values: tuple[float, ...]
    reaches: tuple[float, ...]
    theory: float | None
    limit: fit.Extrapolated | None
    why: str


def value_of(asked, run: Run) -> float:
    """A number of a run; NaN where it has none."""
    return value_in(asked, _tables(run))


def value_in(asked, tables: Iterable[Columns]) -> float:
    """A number of some tables; NaN where they have none."""
    return _found(asked, tables).value


def columns_of_numbers(run: Run, case) -> dict[str, float]:
    """The columns of a row of a study: every number of the case, and its reach."""
    tables = _tables(run)
    found = {name: _found(asked, tables) for name, asked in case.numbers.items()}
    return {f"{NUMBER}{name}": one.value for name, one in found.items()} | {
        f"{REACH}{name}": one.reach for name, one in found.items()
    }


def _tables(run: Run) -> list[Columns]:
    return [run.probes(), *run.gauges().values()]


def _found(asked, tables: Iterable[Columns]) -> CurveNumber:
    try:
        return taken(asked, tables)
    except NoNumber:
        return CurveNumber(math.nan)


def ladders_of_numbers(case, rows: Sequence[Mapping]) -> Iterator[NumberLadder]:
    """Each number of the case over the ``rows`` of runs that differ in the spacing alone."""
    rows = sorted(rows, key=lambda row: -row[SPACING])
    for name, asked in case.numbers.items():
        known = [row for row in rows if not math.isnan(row[NUMBER + name])]
        spacings, values, reaches = (
            tuple(row[key] for row in known) for key in (SPACING, NUMBER + name, REACH + name)
        )
        limit, why = _limit(spacings, values, len(rows) - len(known))
        unit = unit_taken(asked, case.space.dimensions)
        of = f"{asked.take} of {asked.of}"
        yield NumberLadder(name, of, unit, spacings, values, reaches, asked.theory, limit, why)


def _limit(spacings, values, without: int) -> tuple[fit.Extrapolated | None, str]:
    """Where a number goes, or why there is no answer."""
    if without:
        return None, f"{without} of the runs have no such number"
    if len(values) < fit.LAST:
        return None, f"{len(values)} runs are too few, three tell an order"
    if max(values) == min(values):
        return None, "all runs have the same"
    found = fit.richardson(spacings, values)
    if found is None:
        return None, "the values do not go one way ever more slowly"
    if found.order.low <= 0.0:
        return None, f"the order is not known, {found.order.value:.2f} ± {_half(found.order):.1g}"
    return found, ""


def _half(estimate: fit.Estimate) -> float:
    return estimate.high - estimate.value


def sentences_of_numbers(ladders: Iterable[NumberLadder]) -> Iterator[str]:
    """The conclusions, one for each number."""
    for one in ladders:
        if one.limit is None:
            shown = ", ".join(f"{value:.4g}" for value in one.values)
            yield f"{one.name}: no answer at zero spacing: {one.why} ({shown or 'none'} {one.unit})."
        else:
            yield words.limit_words(one.name, one.limit, one.values[-1], len(one.values), one.unit)
