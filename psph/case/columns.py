"""Columns of numbers from a CSV file of a case."""

import csv
from pathlib import Path

import numpy as np

from psph.case.files import Unfit

MOST_ROWS = 1_000_000
"""Of a series: a day at 10 per second."""


def read_columns(path: Path, names: list[str]) -> np.ndarray:
    """The columns ``names`` of a CSV file of numbers (n, len(names)), the first of them times that rise.

    Raises Unfit.
    """
    try:
        with open(path, encoding="utf-8-sig", newline="") as file:
            lines = ((n, line) for n, line in enumerate(file, 1) if line.strip() and line[0] != "#")
            (first, head), *body = lines
            found = [part.strip() for part in next(csv.reader([head], strict=True))]
            cells = [(n, next(csv.reader([line], strict=True))) for n, line in body[: MOST_ROWS + 1]]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise Unfit(f"{path}: {error}; give a CSV file of numbers") from None
    except ValueError:
        raise Unfit(f"{path} is empty; give a line of names, and rows of numbers") from None
    for name in names:
        if found.count(name) != 1:
            how = "no column" if name not in found else "more than one column"
            raise Unfit(f"{path} has {how} '{name}', only {', '.join(found)}; name one of its columns")
    if len(cells) < 2:
        raise Unfit(f"{path} has {len(cells)} row{'s' * (len(cells) != 1)}; give two at least")
    if len(cells) > MOST_ROWS:
        raise Unfit(f"{path} has more than {MOST_ROWS:,} rows; give fewer: they are interpolated")
    places = [found.index(name) for name in names]
    rows = np.array([_numbers(path, n, row, found, places) for n, row in cells])
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
            word = row[place].strip() or "nothing"
            raise Unfit(f"{path}: line {line}: {names[place]} is {word}; give a number") from None
        if not abs(values[-1]) < 1e30:
            raise Unfit(
                f"{path}: line {line}: {names[place]} is {row[place].strip()}; give a number"
            ) from None
    return values
