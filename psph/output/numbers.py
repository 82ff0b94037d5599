"""The numbers of what a run has measured: those of every gauge, and those that its case asks for."""

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

import numpy as np

from psph.output.gauges.units import quantity_of, unit_of
from psph.theory.curves import moments
from psph.theory.curves.catalogue import SAME, TAKEN
from psph.theory.curves.number import Curve, CurveNumber, NoNumber

Columns = Mapping[str, np.ndarray]
"""A table: its columns by their names, ``time`` among them."""

HEAD = ("gauge", "mean", "least", "at (s)", "most", "at (s)", "unit")


class ColumnExtent(NamedTuple):
    """Mean, least and largest value of a ``column``, with the times of the latter, s, and its ``unit``."""

    column: str
    unit: str
    mean: CurveNumber
    least: CurveNumber
    most: CurveNumber

    @property
    def cells(self) -> tuple[str, ...]:
        """As in a table of the HEAD."""
        numbers = (
            self.mean.value,
            *(part for one in (self.least, self.most) for part in (one.value, one.time)),
        )
        return (self.column, *(f"{number:.4g}" for number in numbers), self.unit)


def extents(tables: Iterable[Columns], dimensions: int) -> Iterator[ColumnExtent]:
    """Those of each column that has a value, of gauges."""
    for table in tables:
        for column in table:
            if column != "time" and np.isfinite(table[column]).any():
                curve = Curve.of(table["time"], table[column])
                unit = unit_of(quantity_of(column)[0], dimensions)
                yield ColumnExtent(
                    column, unit, moments.mean(curve), moments.minimum(curve), moments.maximum(curve)
                )


def in_lines(found: Iterable[ColumnExtent]) -> Iterator[str]:
    """A table for a terminal; nothing of nothing."""
    rows = [one.cells for one in found]
    widths = [max(map(len, column)) for column in zip(HEAD, *rows)]
    for cells in (HEAD, *rows) if rows else ():
        first, *rest, unit = (cell.rjust(w) for cell, w in zip(cells, widths))
        yield "  ".join([first.strip().ljust(widths[0]), *rest, unit.strip()])


def taken(asked, tables: Iterable[Columns]) -> CurveNumber:
    """The number that a table ``asked`` of a case (psph.case.numbers.NumberOf) says, of these tables.
    NoNumber where they have none."""
    tables = list(tables)
    curves = {name: _curve(asked, name, tables) for name in asked.columns}
    parameters = {
        "level": asked.level,
        "wave": curves.get(asked.wave),
        "period": asked.period,
        "rest": asked.rest,
    }
    return TAKEN[asked.take].of(curves[asked.of], **parameters)


def unit_taken(asked, dimensions: int) -> str:
    """The unit of that number."""
    return TAKEN[asked.take].unit.replace(SAME, unit_of(quantity_of(asked.of)[0], dimensions))


def in_words(name: str, asked, found: CurveNumber, dimensions: int) -> str:
    """One line: ``peak: maximum of gate.force_x: 12.3 ± 0.4 N/m, at 0.52 s``."""
    reach = "" if math.isnan(found.reach) else f" ± {found.reach:.2g}"
    when = "" if math.isnan(found.time) or found.time == found.value else f", at {found.time:.4g} s"
    return (
        f"{name}: {asked.take} of {asked.of}: {found.value:.6g}{reach} {unit_taken(asked, dimensions)}{when}"
    )


def numbers_in_lines(numbers: Mapping, tables: Iterable[Columns], dimensions: int) -> Iterator[str]:
    """A line for each number of a case, or why there is no answer."""
    tables = list(tables)
    for name, asked in numbers.items():
        try:
            yield in_words(name, asked, taken(asked, tables), dimensions)
        except NoNumber as error:
            yield f"{name}: {asked.take} of {asked.of}: no answer: {error}"


def _curve(asked, column: str, tables: Iterable[Columns]) -> Curve:
    """A column between the times that count."""
    table = next((one for one in tables if column in one), None)
    if table is None:
        raise NoNumber(f"{column} was not measured")
    last = math.inf if asked.until is None else asked.until
    within = (table["time"] >= asked.after) & (table["time"] <= last)
    return Curve.of(table["time"][within], table[column][within])
