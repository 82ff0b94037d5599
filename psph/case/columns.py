"""Columns of numbers from a CSV file of a case."""

import csv
from pathlib import Path

import numpy as np

from psph.case.files import Unfit
from psph.errors import LONGEST_QUOTE, UNPRINTABLE, shortened

MOST_ROWS = 1_000_000
"""Of a series: a day at 10 per second."""


def rows_of(path: Path, most: int) -> list[tuple[int, list[str]]]:
    """Numbers of lines and cells of a CSV file, without what is empty or begins with #; the first ``most``.

    Raises Unfit where it cannot be read, is no text, or no CSV.
    """
    rows: list[tuple[int, list[str]]] = []
    try:
        with open(path, encoding="utf-8-sig", newline="") as file:
            for n, line in enumerate(file, 1):
                if UNPRINTABLE.search(line.replace("\t", " ").rstrip("\r\n")):
                    raise Unfit(f"{path}: line {n} is no text; {GIVE}")
                if line.strip() and line[0] != "#":
                    rows.append((n, next(csv.reader([line], strict=True))))
                if len(rows) == most:
                    break
    except UnicodeDecodeError:
        raise Unfit(f"{path} is no text in UTF-8; {GIVE}") from None
    except OSError as error:
        raise Unfit(f"{path}: {error.strerror or error}; give a CSV file in the case's folder") from None
    except csv.Error as error:
        raise Unfit(f"{path}: line {n}: {error}; give numbers with commas between them") from None
    return rows


GIVE = "give a CSV file: a line of names, and rows of numbers"


def named(names: list[str]) -> str:
    """The columns that a file has, for a message."""
    return shortened(", ".join(names), LONGEST_QUOTE)


def cells_of(path: Path, most: int) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """The names of the columns of a CSV file, and the numbers of its lines with their cells.

    Raises Unfit where it has fewer than two rows, or more than ``most``.
    """
    lines = rows_of(path, most + 2)
    if not lines:
        raise Unfit(f"{path} is empty; {GIVE}")
    (_, head), *cells = lines
    if len(cells) < 2:
        raise Unfit(f"{path} has {len(cells)} row{'s' * (len(cells) != 1)}; give two at least")
    if len(cells) > most:
        raise Unfit(f"{path} has more than {most:,} rows; give fewer: they are interpolated")
    return [part.strip() for part in head], cells


def numbers_of(path: Path, columns: list[str], cells, names: list[str]) -> np.ndarray:
    """The numbers (n, len(names)) in some of the ``columns`` of the ``cells`` of a file.  Raises Unfit."""
    for name in names:
        if columns.count(name) != 1:
            how = "no column" if name not in columns else "more than one column"
            raise Unfit(f"{path} has {how} '{name}', only {named(columns)}; name one of its columns")
    places = [columns.index(name) for name in names]
    return np.array([_numbers(path, n, row, columns, places) for n, row in cells])


def read_columns(path: Path, names: list[str]) -> np.ndarray:
    """The columns ``names`` of a CSV file of numbers (n, len(names)), the first of them times that rise.

    Raises Unfit.
    """
    columns, cells = cells_of(path, MOST_ROWS)
    rows = numbers_of(path, columns, cells, names)
    for (n, _), before, now in zip(cells[1:], rows[:-1, 0], rows[1:, 0]):
        if not now > before:
            raise Unfit(f"{path}: line {n}: the time {now:g} s follows {before:g} s; let times rise")
    return rows


def _numbers(path: Path, line: int, row: list[str], names: list[str], places: list[int]) -> list[float]:
    if len(row) != len(names):
        raise Unfit(f"{path}: line {line} has {len(row)} values for {len(names)} names; fill the hole")
    values = []
    for place in places:
        try:
            values.append(float(row[place]))
        except ValueError:
            word = shortened(row[place].strip(), LONGEST_QUOTE) or "nothing"
            raise Unfit(f"{path}: line {line}: {names[place]} is {word}; give a number") from None
        if not abs(values[-1]) < 1e30:
            raise Unfit(
                f"{path}: line {line}: {names[place]} is {row[place].strip()}; give a number"
            ) from None
    return values
